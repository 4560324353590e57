// Obstacles from OBJ files: what is read, what a run keeps of it, and what is refused.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "scene/messages.hpp"
#include "wunderlich/contact/triangle_mesh.hpp"
#include "wunderlich/scene/run.hpp"

namespace wunderlich::scene {
namespace {

const char* const kTetrahedron =
    "# corners of a cube\n"
    "o tetrahedron\n"
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
    "vn 0 0 1\n"
    "f 1 3 2\nf 1//1 2//1 4//1\nf -3 -2 -1\nf 1 4 3\n";

/// A folder of its own that goes with the test.
struct Folder {
  std::filesystem::path path =
      std::filesystem::path(::testing::TempDir()) / ("wunderlich-mesh-obstacle-" + std::to_string(::getpid()));
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path / name).parent_path());
    std::ofstream(path / name, std::ios::binary) << text;
    return (path / name).string();
  }
};

const std::string kStrip = "ribbon: {length: 3, width: 0.6, segments: 30}\n";

const contact::TriangleMesh& mesh_of(const Scene& scene, std::size_t i = 0) {
  return *std::get<contact::Polyhedron>(scene.surroundings.obstacles[i].shape).mesh;
}

std::string indented(const std::string& text) {
  std::string out = "      ";
  for (const char c : text) {
    out += c;
    if (c == '\n') out.append(6, ' ');
  }
  return out;
}

std::string with_obj(const std::string& obj) {
  return kStrip + "obstacles:\n  - shape: mesh\n    position: [1, 0, -2]\n    obj: |\n" + indented(obj) + "\n";
}

TEST(MeshObstacle, IsReadFromAFileBesideTheScene) {
  const Folder folder;
  folder.write("shapes/thing.obj", kTetrahedron);
  const std::string text = kStrip + "obstacles: [{shape: mesh, file: shapes/thing.obj, scale: 0.01, turn: 1}]\n";
  const Scene scene = read_scene(folder.write("scene.yaml", text));
  const contact::TriangleMesh& mesh = mesh_of(scene);
  ASSERT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.vertices[3], Vec3(0, 0, 0.01));
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_EQ(mesh.triangles[2], (std::array<int, 3>{1, 2, 3}));
  EXPECT_EQ(mesh.ridges.size(), 6u);
}

TEST(MeshObstacle, ARunNeedsTheFileNoMore) {
  const Folder folder;
  const std::string file = folder.write("thing.obj", kTetrahedron);
  const std::string path = folder.write("scene.yaml", kStrip + "obstacles: [{shape: mesh, file: thing.obj}]\n");
  const Scene first = read_scene(path);
  folder.write("thing.obj", std::string(kTetrahedron) + "# changed\n");
  EXPECT_NE(read_scene(path).written, first.written);
  std::filesystem::remove(file);
  const Scene again = read_scene_text(first.resolved, "checkpoint");
  EXPECT_EQ(again.resolved, first.resolved);
  EXPECT_EQ(mesh_of(again).vertices, mesh_of(first).vertices);
  const Scene added = read_scene_text(first.resolved, "checkpoint", {"obstacles.0.scale=2"});
  EXPECT_EQ(mesh_of(added).vertices[1], Vec3(2, 0, 0));
}

TEST(MeshObstacle, MayBeWrittenIntoTheScene) {
  const Scene scene = read_scene_text(with_obj(kTetrahedron), "inline.yaml");
  EXPECT_EQ(mesh_of(scene).vertices.size(), 4u);
  EXPECT_EQ(read_scene_text(scene.resolved, "again").resolved, scene.resolved);
}

TEST(MeshObstacle, FacesOfMoreCornersAreCutIntoTriangles) {
  const std::string cube =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
      "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  const Scene scene = read_scene_text(with_obj(cube), "cube.yaml");
  EXPECT_EQ(mesh_of(scene).triangles.size(), 12u);
  EXPECT_EQ(mesh_of(scene).ridges.size(), 12u);
}

std::string refused(const std::string& obj) { return message_of(with_obj(obj)); }

const std::string kCorners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

TEST(BadMesh, LinesAreNamed) {
  expect_all(refused("v 0 0\n"), {"bad.yaml:5:10: obstacles.0.obj:1: a vertex has three coordinates"});
  expect_all(refused("v 0 0 0\n\nv 0 x 0\n"), {"obstacles.0.obj:3: `x` is not a coordinate"});
  expect_all(refused("v 0 0 1e999\n"), {"obj:1: `1e999` is not a coordinate"});
  expect_all(refused("v 0 0 nan\n"), {"obj:1: `nan` is not a coordinate"});
  expect_all(refused(kCorners + "f 1 2\n"), {"obj:5: a face has three corners or more"});
  expect_all(refused(kCorners + "f 1 2 5\n"), {"obj:5: `5` is not a vertex; there are 4 above this line, from 1"});
  expect_all(refused(kCorners + "f 1 2 0\n"), {"obj:5: `0` is not a vertex"});
  expect_all(refused(kCorners + "f 1 2 -5\n"), {"obj:5: `-5` is not a vertex"});
  expect_all(refused(kCorners + "f 1 2 99999999999999999999\n"), {"is not a vertex"});
  expect_all(refused(kCorners + "f a b c\n"), {"obj:5: `a` is not a vertex"});
  expect_all(refused(kCorners + "curv 1 2\n"), {"obj:5: `curv` is not understood"});
  expect_all(refused(kCorners), {"there are no faces"});
}

TEST(BadMesh, SurfacesThatAreNotASolids) {
  expect_all(refused(kCorners + "f 1 3 2\nf 1 2 4\nf 2 3 4\n"), {"obj:", "the surface is open"});
  expect_all(refused(kCorners + "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\nf 1 4 3\n"), {"more than two faces meet"});
  expect_all(refused(kCorners + "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 3 4\n"), {"turned differently"});
  expect_all(refused(kCorners + "f 1 2 3\nf 1 4 2\nf 2 4 3\nf 1 3 4\n"), {"obj:5: the surface is inside out"});
  expect_all(refused(kCorners + "f 1 1 2\n"), {"obj:5: a face without area"});
}

TEST(BadMesh, TooLarge) {
  std::string fan = kCorners + "f";
  for (int i = 0; i < 20003; ++i) fan.append(" ").append(std::to_string(1 + i % 4));
  expect_all(refused(fan + "\n"), {"obj:5: more than 20000 triangles"});
}

TEST(BadMesh, KeysAndFiles) {
  const auto refuse = [](const std::string& keys) { return message_of(kStrip + "obstacles:\n  - {" + keys + "}\n"); };
  expect_all(refuse("shape: mesh"), {"bad.yaml:3:5: obstacles.0.file: is missing", "`obj`"});
  expect_all(refuse("shape: mesh, file: nowhere.obj"), {"bad.yaml:3:25: obstacles.0.file: nowhere.obj: no such file"});
  expect_all(refuse("shape: mesh, file: ."), {"obstacles.0.file", "is a folder"});
  expect_all(refuse("shape: mesh, file: []"), {"obstacles.0.file: a list of 0"});
  expect_all(refuse("shape: mesh, file: a.obj, obj: v"), {"obstacles.0.file: not with `obj`"});
  expect_all(refuse("shape: mesh, obj: v, radius: 1"), {"obstacles.0.radius: has no effect with `shape: mesh`"});
  expect_all(refuse("shape: sphere, radius: 1, file: a.obj"), {"obstacles.0.file: has no effect with `shape: sphere`"});
  expect_all(refuse("shape: mesh, obj: v, scale: 0"), {"obstacles.0.scale: `0`"});
  const Folder folder;
  const std::string scene = folder.write("scene.yaml", kStrip + "obstacles: [{shape: mesh, file: bad.obj}]\n");
  folder.write("bad.obj", "v 0 0 0\nv 1 2\n");
  try {
    read_scene(scene);
    FAIL();
  } catch (const InputError& error) {
    expect_all(error.what(), {"scene.yaml:2:33: obstacles.0.file: ", "bad.obj:2: a vertex has three coordinates"});
  }
}

TEST(BadMesh, AStripThatStartsInsideIsRefused) {
  const std::string motion = "solver: {method: implicit}\nobstacles: [{shape: box, size: ";
  const auto start = [&](const std::string& rest) -> std::string {
    try {
      check_start(read_scene_text(kStrip + motion + rest + "}]\n", "bad.yaml"));
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  expect_all(start("[9, 9, 9]"), {"bad.yaml:3:13: obstacles.0: the strip starts inside"});    // wholly
  expect_all(start("[0.1, 0.1, 1], position: [1.55, 0.1, 0]"), {"the strip starts inside"});  // within a facet
  EXPECT_EQ(start("[9, 9, 9], position: [0, 0, -4.6]"), "accepted");
}

}  // namespace
}  // namespace wunderlich::scene
