#include "wunderlich/io/run_folder.hpp"

#include <algorithm>
#include <fstream>
#include <set>

#include "io/sample.hpp"
#include "wunderlich/io/file.hpp"
#include "wunderlich/io/summary_json.hpp"

namespace wunderlich::io {
namespace {

namespace fs = std::filesystem;
using testing::input_error;
using testing::sample_run;

class RunFolderTest : public testing::Folder {
 protected:
  static std::set<std::string> listing(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file()) names.insert(fs::relative(entry.path(), folder).string());
    }
    return names;
  }
};

TEST_F(RunFolderTest, HoldsTheAgreedFiles) {
  const fs::path folder = root / "deep" / "er" / "coil";
  write_run_folder(folder, sample_run(), parse_formats("vtp,glb,pc2,obj,svg,html"));
  EXPECT_EQ(listing(folder), (std::set<std::string>{"summary.json", "centerline.csv", "history.csv", "checkpoint",
                                                    "ribbon.pvd", "frames/frame_0000.vtp", "frames/frame_0001.vtp",
                                                    "frames/frame_0002.vtp", "ribbon.glb", "ribbon_rest.obj",
                                                    "ribbon.pc2", "ribbon.obj", "pattern.svg", "report.html"}));
  EXPECT_EQ(entries(folder.parent_path()), 1u) << "no temporary folder stays";
  EXPECT_EQ(parse_summary(read_file(folder / "summary.json"), "s").scene, "coil");
  EXPECT_EQ(read_checkpoint(folder / "checkpoint").arrays, sample_run().checkpoint.arrays);
  EXPECT_TRUE(is_run_folder(folder));
}

TEST_F(RunFolderTest, ReplacesARunWhole) {
  const fs::path folder = root / "coil";
  write_run_folder(folder, sample_run(), parse_formats("vtp,glb,svg,html"));
  std::ofstream(folder / "stale") << "x";
  write_run_folder(fs::path(folder.string() + "/"), sample_run(), {});
  EXPECT_EQ(listing(folder), (std::set<std::string>{"summary.json", "centerline.csv", "history.csv", "checkpoint"}));
  EXPECT_EQ(entries(root), 1u);
}

TEST_F(RunFolderTest, FillsAnEmptyFolderAndFollowsALink) {
  fs::create_directory(root / "empty");
  fs::create_directory_symlink(root / "empty", root / "link");
  write_run_folder(root / "link", sample_run(), {});
  EXPECT_TRUE(fs::is_symlink(root / "link"));
  EXPECT_TRUE(is_run_folder(root / "empty"));
}

TEST_F(RunFolderTest, RefusesAnyOtherFolder) {
  const fs::path folder = root / "thesis";
  fs::create_directory(folder);
  std::ofstream(folder / "summary.json") << "{}";
  const std::string message = input_error([&] { write_run_folder(folder, sample_run(), {}); });
  EXPECT_NE(message.find(folder.string()), std::string::npos);
  EXPECT_NE(message.find("was not written by wunderlich"), std::string::npos);
  EXPECT_EQ(listing(folder), (std::set<std::string>{"summary.json"}));
  EXPECT_EQ(entries(root), 1u);
}

TEST_F(RunFolderTest, RefusesPlacesThatCannotBeWritten) {
  std::ofstream(root / "file") << "x";
  for (const fs::path& folder :
       {root / "file", root / "file" / "below", fs::path("/proc/none/run"), fs::path("/"), fs::path("")}) {
    const std::string message = input_error([&] { require_writable(folder); });
    EXPECT_EQ(message.find(folder.string() + ": "), 0u) << message;
    EXPECT_THROW(write_run_folder(folder, sample_run(), {}), InputError);
  }
  EXPECT_EQ(entries(root), 1u);
}

TEST_F(RunFolderTest, KeepsTheOldRunWhenTheNewOneIsNotFinite) {
  const fs::path folder = root / "coil";
  write_run_folder(folder, sample_run(), {});
  RunOutput broken = sample_run();
  broken.summary.area_error = std::nan("");
  EXPECT_THROW(write_run_folder(folder, broken, {}), std::domain_error);
  broken = sample_run();
  broken.frames[1].surface.points[4].x() = std::nan("");
  EXPECT_THROW(write_run_folder(folder, broken, {}), std::domain_error);
  EXPECT_EQ(parse_summary(read_file(folder / "summary.json"), "s").area_error, 0);
  EXPECT_EQ(entries(root), 1u);
}

TEST_F(RunFolderTest, SolidsAreACollectionOfTheirOwn) {
  RunOutput run = sample_run();
  Body body;
  body.mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  body.mesh.normals.assign(3, Vec3::UnitZ());
  body.mesh.triangles = {{0, 1, 2}};
  body.poses.assign(3, {Vec3(0, 0, 1), Quat::Identity()});
  run.bodies = {body, body};
  const auto count = [](const std::string& text, const std::string& what) {
    std::size_t found = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
    return found;
  };
  write_format(root / "still.pvd", Format::vtp, run);
  EXPECT_EQ(count(read_file(root / "still_solids.pvd"), "<DataSet"), 1u);
  EXPECT_EQ(count(read_file(root / "still_solids" / "frame_0000.vtp"), "NumberOfPoints=\"6\""), 1u);
  run.bodies[1].poses[2].position.x() = 0.5;
  write_format(root / "moving.pvd", Format::vtp, run);
  EXPECT_EQ(count(read_file(root / "moving_solids.pvd"), "<DataSet"), 3u);
  EXPECT_EQ(count(read_file(root / "moving.pvd"), "solids"), 0u);
}

TEST_F(RunFolderTest, AnExportDoesNotReplaceThePartsOfARun) {
  const fs::path run = root / "run";
  write_run_folder(run, sample_run(), {});
  for (const char* own : {"summary.json", "checkpoint", "centerline.csv", "history.csv"}) {
    const std::string before = read_file(run / own);
    EXPECT_THROW(write_format(run / own, Format::obj, sample_run()), InputError) << own;
    EXPECT_EQ(read_file(run / own), before) << own;
  }
  write_format(root / "history.csv", Format::obj, sample_run());  // elsewhere it is a name as any other
}

TEST_F(RunFolderTest, ExportsOneFormatUnderAnyName) {
  const RunOutput run = sample_run();
  for (const char* file : {"a.glb", "b.pvd", "c.pc2", "d.obj", "sub/e.svg", "f.html"}) {
    const fs::path path = root / file;
    const std::string extension = path.extension().string().substr(1);
    write_format(path, parse_format(extension == "pvd" ? "vtp" : extension), run);
    EXPECT_TRUE(fs::is_regular_file(path)) << file;
  }
  EXPECT_TRUE(fs::exists(root / "b_frames" / "frame_0002.vtp"));
  EXPECT_NE(read_file(root / "b.pvd").find("b_frames/frame_0002.vtp"), std::string::npos);
  EXPECT_TRUE(fs::exists(root / "c_rest.obj"));
  EXPECT_THROW(write_format(root / "a.glb" / "x.glb", Format::glb, run), InputError);
}

}  // namespace
}  // namespace wunderlich::io
