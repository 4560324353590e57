#include "wunderlich/io/file.hpp"

#include "io/sample.hpp"
#include "wunderlich/io/bytes.hpp"
#include "wunderlich/io/formats.hpp"

namespace wunderlich::io {
namespace {

using testing::input_error;
using FileTest = testing::Folder;

TEST_F(FileTest, ReplacesAFileAndLeavesNothingElse) {
  write_file(root / "a", "old content");
  write_file(root / "a", std::string("new\0", 4));
  EXPECT_EQ(read_file(root / "a"), std::string("new\0", 4));
  EXPECT_EQ(entries(root), 1u);
}

TEST_F(FileTest, NamesThePathThatCannotBeWritten) {
  write_file(root / "file", "x");
  const auto path = root / "file" / "below";
  EXPECT_NE(input_error([&] { write_file(path, "y"); }).find(path.string()), std::string::npos);
  EXPECT_NE(input_error([&] { write_file(root / "no" / "such", "y"); }).find("No such file"), std::string::npos);
  EXPECT_EQ(entries(root), 1u);
}

TEST_F(FileTest, ReportsAFullDisk) {
  const std::string message = input_error([] { write_in_place("/dev/full", std::string(100, 'x')); });
  EXPECT_NE(message.find("/dev/full"), std::string::npos);
  EXPECT_NE(message.find("No space left"), std::string::npos);
}

TEST_F(FileTest, RefusesToReadWhatIsNoFileOrTooLarge) {
  EXPECT_NE(input_error([&] { read_file(root); }).find("Is a directory"), std::string::npos);
  EXPECT_NE(input_error([&] { read_file(root / "none"); }).find("No such file"), std::string::npos);
  write_file(root / "big", std::string(1000, 'x'));
  EXPECT_NE(input_error([&] { read_file(root / "big", 999); }).find("999 bytes"), std::string::npos);
  EXPECT_EQ(read_file(root / "big", 1000).size(), 1000u);
}

TEST(Base64, MatchesTheRfcExamples) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(Checksum, IsFnv1a) { EXPECT_EQ(checksum("foobar"), 0x85944171f73967e8u); }

TEST(Formats, AreParsedFromAList) {
  EXPECT_EQ(parse_formats("svg, html,svg"), (std::vector<Format>{Format::svg, Format::html}));
  EXPECT_EQ(parse_formats("svg-pattern"), std::vector<Format>{Format::svg});
  EXPECT_TRUE(parse_formats("none").empty());
  EXPECT_EQ(parse_formats("vtp,glb,pc2,obj,stl,3mf,svg,html,png,mp4").size(), 10u);
  for (const Format format : parse_formats("vtp,glb,pc2,obj,stl,3mf,svg,html,png,mp4"))
    EXPECT_EQ(parse_format(name(format)), format);
  for (const char* bad : {"", "vtp,", "VTP", "step", "none,vtp"}) {
    EXPECT_NE(
        input_error([&] { parse_formats(bad); }).find("allowed are vtp, glb, pc2, obj, stl, 3mf, svg, html, png, mp4"),
        std::string::npos)
        << bad;
  }
}

}  // namespace
}  // namespace wunderlich::io
