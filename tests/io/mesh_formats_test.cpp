#include <cstring>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "io/sample.hpp"
#include "wunderlich/io/glb.hpp"
#include "wunderlich/io/obj.hpp"
#include "wunderlich/io/pc2.hpp"
#include "wunderlich/io/report.hpp"
#include "wunderlich/io/svg.hpp"
#include "wunderlich/io/vtp.hpp"

namespace wunderlich::io {
namespace {

using testing::sample_run;

template <class T>
T load(const std::string& bytes, std::size_t offset) {
  T value;
  EXPECT_LE(offset + sizeof value, bytes.size());
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

Vec3 load_point(const std::string& bytes, std::size_t offset) {
  return {load<float>(bytes, offset), load<float>(bytes, offset + 4), load<float>(bytes, offset + 8)};
}

/// Offset of the block of the named array behind the underscore, past its length.
std::size_t block(const std::string& file, const std::string& array, std::size_t bytes) {
  std::smatch match;
  EXPECT_TRUE(std::regex_search(file, match, std::regex("Name=\"" + array + "\"[^>]*offset=\"([0-9]+)\"")));
  const std::size_t start = file.find("<AppendedData encoding=\"raw\">\n_") + 31 + std::stoul(match[1]);
  EXPECT_EQ(load<std::uint32_t>(file, start), bytes);
  return start + 4;
}

TEST(Vtp, HoldsPointsFieldsAndPolygons) {
  const Mesh mesh = sample_run().frames.back().surface;
  const std::string file = vtp(mesh, 1.5);
  const std::size_t n = mesh.points.size(), m = mesh.triangles.size();
  EXPECT_NE(file.find("NumberOfPoints=\"" + std::to_string(n) + "\""), std::string::npos);
  EXPECT_NE(file.find("NumberOfPolys=\"" + std::to_string(m) + "\""), std::string::npos);
  EXPECT_NE(file.find("format=\"ascii\">1.5</DataArray>"), std::string::npos);
  const std::size_t points = block(file, "points", 12 * n), normals = block(file, "normals", 12 * n);
  const std::size_t kappa = block(file, "kappa", 4 * n), eta = block(file, "eta", 4 * n);
  block(file, "tau", 4 * n);
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_LT((load_point(file, points + 12 * i) - mesh.points[i]).norm(), 1e-6);
    EXPECT_LT((load_point(file, normals + 12 * i) - mesh.normals[i]).norm(), 1e-6);
    EXPECT_NEAR(load<float>(file, kappa + 4 * i), mesh.fields[2].values[i], 1e-6);
    EXPECT_NEAR(load<float>(file, eta + 4 * i), mesh.fields[4].values[i], 1e-6);
  }
  const std::size_t connectivity = block(file, "connectivity", 12 * m), offsets = block(file, "offsets", 4 * m);
  for (std::size_t t = 0; t < m; ++t) {
    EXPECT_EQ(load<std::int32_t>(file, connectivity + 12 * t + 4), mesh.triangles[t][1]);
    EXPECT_EQ(load<std::int32_t>(file, offsets + 4 * t), static_cast<std::int32_t>(3 * t + 3));
  }
}

TEST(Pvd, ListsTimesAndFiles) {
  const std::string file = pvd({0, 0.25}, {"frames/a.vtp", "frames/b.vtp"});
  EXPECT_NE(file.find("timestep=\"0.25\" group=\"\" part=\"0\" file=\"frames/b.vtp\""), std::string::npos);
}

struct Gltf {
  nlohmann::json json;
  std::string bin;
  std::size_t offset(int accessor) const {
    return json["bufferViews"][json["accessors"][accessor]["bufferView"].get<std::size_t>()]["byteOffset"];
  }
};

Gltf open(const std::string& file) {
  EXPECT_EQ(file.substr(0, 4), "glTF");
  EXPECT_EQ(load<std::uint32_t>(file, 8), file.size());
  const auto json_size = load<std::uint32_t>(file, 12);
  EXPECT_EQ(json_size % 4, 0u);
  EXPECT_EQ(file.substr(16, 4), "JSON");
  EXPECT_EQ(file.substr(24 + json_size, 4), std::string("BIN\0", 4));
  EXPECT_EQ(load<std::uint32_t>(file, 20 + json_size), file.size() - 28 - json_size);
  return {nlohmann::json::parse(file.substr(20, json_size)), file.substr(28 + json_size)};
}

TEST(Glb, MorphTargetsAddUpToTheFrames) {
  const RunOutput run = sample_run();
  const Gltf gltf = open(glb(run.frames, run.bodies, "coil"));
  const auto& primitive = gltf.json["meshes"][0]["primitives"][0];
  ASSERT_EQ(primitive["targets"].size(), 2u);
  const std::size_t base = gltf.offset(primitive["attributes"]["POSITION"]);
  const std::size_t normal = gltf.offset(primitive["attributes"]["NORMAL"]);
  for (std::size_t f = 1; f < 3; ++f) {
    const std::size_t delta = gltf.offset(primitive["targets"][f - 1]["POSITION"]);
    const std::size_t tilt = gltf.offset(primitive["targets"][f - 1]["NORMAL"]);
    const Mesh& mesh = run.frames[f].surface;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
      const Vec3 sum = load_point(gltf.bin, base + 12 * i) + load_point(gltf.bin, delta + 12 * i);
      EXPECT_LT((sum - mesh.points[i]).norm(), 1e-6);
      const Vec3 turned = load_point(gltf.bin, normal + 12 * i) + load_point(gltf.bin, tilt + 12 * i);
      EXPECT_LT((turned - mesh.normals[i]).norm(), 1e-6);
    }
  }
  const auto& sampler = gltf.json["animations"][0]["samplers"][0];
  const std::size_t keys = gltf.offset(sampler["input"]), weights = gltf.offset(sampler["output"]);
  EXPECT_EQ(load<float>(gltf.bin, keys + 4), 0.5f);
  const float expected[6] = {0, 0, 1, 0, 0, 1};
  for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(load<float>(gltf.bin, weights + 4 * k), expected[k]);
}

TEST(Glb, DescribesItsData) {
  const RunOutput run = sample_run();
  const Gltf gltf = open(glb(run.frames, run.bodies, "coil"));
  EXPECT_EQ(gltf.json["asset"]["version"], "2.0");
  EXPECT_EQ(gltf.json["materials"][0]["doubleSided"], true);
  std::size_t end = 0;
  for (const auto& view : gltf.json["bufferViews"]) {
    EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0u);
    EXPECT_EQ(view["byteOffset"].get<std::size_t>(), end);
    end += view["byteLength"].get<std::size_t>();
  }
  EXPECT_EQ(gltf.json["buffers"][0]["byteLength"].get<std::size_t>(), end);
  const auto& position =
      gltf.json["accessors"][gltf.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"].get<int>()];
  double low = 1e9;
  for (const Vec3& p : run.frames[0].surface.points) low = std::min(low, p.y());
  EXPECT_NEAR(position["min"][1].get<double>(), low, 1e-6);
}

TEST(Glb, StandsStillWithOneFrameAndKeepsTimesIncreasing) {
  RunOutput run = sample_run();
  run.frames[2].time = run.frames[1].time;
  const Gltf moving = open(glb(run.frames, run.bodies, "coil"));
  const std::size_t keys = moving.offset(moving.json["animations"][0]["samplers"][0]["input"]);
  EXPECT_GT(load<float>(moving.bin, keys + 8), load<float>(moving.bin, keys + 4));
  run.frames.resize(1);
  const Gltf still = open(glb(run.frames, run.bodies, "coil"));
  EXPECT_FALSE(still.json.contains("animations"));
  EXPECT_FALSE(still.json["meshes"][0]["primitives"][0].contains("targets"));
}

/// Where a node is at key k of its animation, and how it is turned there.
Pose animated(const Gltf& gltf, int node, std::size_t k) {
  Pose pose;
  for (const auto& channel : gltf.json["animations"][0]["channels"]) {
    if (channel["target"]["node"] != node) continue;
    const std::size_t data =
        gltf.offset(gltf.json["animations"][0]["samplers"][channel["sampler"].get<int>()]["output"]);
    if (channel["target"]["path"] == "translation") pose.position = load_point(gltf.bin, data + 12 * k);
    if (channel["target"]["path"] == "rotation") {
      for (std::size_t c = 0; c < 4; ++c) pose.frame.coeffs()[c] = load<float>(gltf.bin, data + 16 * k + 4 * c);
    }
  }
  return pose;
}

TEST(Glb, SolidsStandAndMoveBesideTheRibbon) {
  RunOutput run = sample_run();
  const Mesh block{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, std::vector<Vec3>(3, Vec3::UnitZ()), {{0, 1, 2}}, {}};
  const Pose still{Vec3(1, 2, 3), Quat(Eigen::AngleAxisd(0.4, Vec3::UnitX()))};
  std::vector<Pose> turning;
  for (int k = 0; k < 3; ++k) turning.push_back({Vec3(0, k, 0), Quat(Eigen::AngleAxisd(2.5 * k, Vec3::UnitZ()))});
  run.bodies = {{block, {still, still, still}}, {block, turning}};
  const Gltf gltf = open(glb(run.frames, run.bodies, "coil"));
  ASSERT_EQ(gltf.json["scenes"][0]["nodes"], (std::vector<int>{0, 1, 2}));
  const auto& node = gltf.json["nodes"][1];
  const Quat upright(node["rotation"][3].get<double>(), node["rotation"][0], node["rotation"][1], node["rotation"][2]);
  // y up: (x, y, z) of the scene is (x, z, -y).
  const Vec3 place(node["translation"][0].get<double>(), node["translation"][1], node["translation"][2]);
  EXPECT_LT((place - Vec3(1, 3, -2)).norm(), 1e-12);
  const Vec3 corner = still.frame * Vec3(0, 1, 0);
  EXPECT_LT((upright * Vec3(0, 1, 0) - Vec3(corner.x(), corner.z(), -corner.y())).norm(), 1e-12);
  EXPECT_EQ(gltf.json["animations"][0]["channels"].size(), 3u) << "weights, and two of the solid that moves";
  for (std::size_t k = 0; k < 3; ++k) {
    const Pose pose = animated(gltf, 2, k);
    const Vec3 at = turning[k].frame * Vec3(1, 0, 0) + turning[k].position,
               found = pose.frame * Vec3(1, 0, 0) + pose.position;
    EXPECT_LT((found - Vec3(at.x(), at.z(), -at.y())).norm(), 1e-6);
    EXPECT_GE(pose.frame.dot(animated(gltf, 2, k > 0 ? k - 1 : 0).frame), 0) << "turns the short way";
  }
}

TEST(Pc2, HoldsEveryFrameInTheOrderOfTheObj) {
  const RunOutput run = sample_run();
  const std::string file = pc2(run.frames);
  const std::size_t n = run.frames[0].surface.points.size();
  EXPECT_EQ(file.substr(0, 12), std::string("POINTCACHE2\0", 12));
  EXPECT_EQ(load<std::int32_t>(file, 12), 1);
  EXPECT_EQ(load<std::int32_t>(file, 16), static_cast<std::int32_t>(n));
  EXPECT_EQ(load<std::int32_t>(file, 28), 3);
  ASSERT_EQ(file.size(), 32 + 3 * 12 * n);
  EXPECT_LT((load_point(file, 32 + 2 * 12 * n + 12 * 5) - run.frames[2].surface.points[5]).norm(), 1e-6);
}

TEST(Obj, ListsPointsAndFacesFromOne) {
  const Mesh mesh = sample_run().frames.back().surface;
  std::istringstream lines(obj(mesh, "ribbon"));
  std::size_t points = 0, normals = 0, faces = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      Vec3 p;
      words >> p.x() >> p.y() >> p.z();
      EXPECT_EQ(p, mesh.points[points++]);
    } else if (kind == "vn") {
      ++normals;
    } else if (kind == "f") {
      int a, b;
      char slash;
      words >> a >> slash >> slash >> b;
      EXPECT_EQ(a, mesh.triangles[faces++][0] + 1);
      EXPECT_EQ(b, a);
    }
  }
  EXPECT_EQ(points, mesh.points.size());
  EXPECT_EQ(normals, mesh.points.size());
  EXPECT_EQ(faces, mesh.triangles.size());
}

TEST(PatternSvg, IsTrueToScaleAndSortsTheFolds) {
  FlatPattern pattern;
  pattern.length = 0.3;
  pattern.width = 0.04;
  for (int i = 0; i <= 3; ++i) {
    const double slant = i == 1 ? 0.01 : 0.0;
    pattern.rulings.push_back({Vec2(0.1 * i - slant, 0.02), Vec2(0.1 * i + slant, -0.02)});
  }
  pattern.fold_angle = {0, 0.5, -0.25, 0};
  const std::string file = pattern_svg(pattern, "a < b & c");
  EXPECT_NE(file.find("width=\"310.0000mm\""), std::string::npos);
  EXPECT_NE(file.find("viewBox=\"-5.0000 -25.0000 310.0000"), std::string::npos);
  EXPECT_NE(file.find("<title>a &lt; b &amp; c</title>"), std::string::npos);
  EXPECT_NE(file.find("points=\"0.0000,-20.0000 300.0000,-20.0000 300.0000,20.0000 0.0000,20.0000 \""),
            std::string::npos);
  const std::size_t valley = file.find("<g id=\"valley\""), mountain = file.find("<g id=\"mountain\"");
  const std::size_t first =
      file.find("x1=\"90.0000\" y1=\"-20.0000\" x2=\"110.0000\" y2=\"20.0000\" opacity=\"1.000\"");
  const std::size_t second =
      file.find("x1=\"200.0000\" y1=\"-20.0000\" x2=\"200.0000\" y2=\"20.0000\" opacity=\"0.600\"");
  ASSERT_NE(first, std::string::npos);
  ASSERT_NE(second, std::string::npos);
  EXPECT_TRUE(valley < first && first < mountain && mountain < second);
  EXPECT_NE(file.find("node 1: 28.648 degrees"), std::string::npos);
}

std::string unbase64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  unsigned word = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    word = word << 6 | static_cast<unsigned>(digits.find(c));
    if ((bits += 6) >= 8) out += static_cast<char>(word >> (bits -= 8) & 255);
  }
  return out;
}

nlohmann::json page_data(const std::string& page) {
  const std::size_t start = page.find("application/json\">") + 18;
  return nlohmann::json::parse(page.substr(start, page.find("</script>") - start));
}

TEST(Report, HoldsTheRunToTheLastPoint) {
  const RunOutput run = sample_run();
  const std::string page = report_page(run);
  EXPECT_EQ(page.find("__WUNDERLICH_DATA__"), std::string::npos);
  EXPECT_EQ(page.substr(page.size() - 10), "<p>end</p>");
  const nlohmann::json data = page_data(page);
  EXPECT_EQ(data["title"], run.title) << "a </script> in a text must not end the element";
  EXPECT_EQ(data["summary"]["scene"], "coil");
  ASSERT_EQ(data["frames"].size(), 3u);
  const Mesh& mesh = run.frames[2].surface;
  const std::string points = unbase64(data["frames"][2]["points"]);
  ASSERT_EQ(points.size(), 6 * mesh.points.size());
  const double scale = data["scale"];
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const double value = data["low"][static_cast<std::size_t>(k)].get<double>() +
                           scale * load<std::uint16_t>(points, 6 * i + 2 * static_cast<std::size_t>(k));
      EXPECT_NEAR(value, mesh.points[i][k], 0.51 * scale);
    }
  }
  const std::string kappa = unbase64(data["frames"][2]["kappa"]);
  ASSERT_EQ(kappa.size(), 4 * run.frames[2].centerline.size());
  EXPECT_EQ(load<float>(kappa, 4 * 3), static_cast<float>(run.frames[2].centerline[3].kappa));
  EXPECT_LT(scale, 5e-5);
}

TEST(Report, NormalsSurviveTheirPacking) {
  const RunOutput run = sample_run();
  const std::string normals = unbase64(page_data(report_page(run))["frames"][1]["normals"]);
  const Mesh& mesh = run.frames[1].surface;
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    const double x = load<std::int16_t>(normals, 4 * i) / 32767.0, y = load<std::int16_t>(normals, 4 * i + 2) / 32767.0;
    Vec3 n(x, y, 1 - std::abs(x) - std::abs(y));
    if (n.z() < 0) n = Vec3((1 - std::abs(y)) * std::copysign(1, x), (1 - std::abs(x)) * std::copysign(1, y), n.z());
    EXPECT_LT((n.normalized() - mesh.normals[i]).norm(), 2e-4);
  }
}

TEST(Report, HoldsBodiesWithTheirPosesInTheChosenFrames) {
  RunOutput run = sample_run(4000);
  while (run.frames.size() < 40) run.frames.insert(run.frames.begin() + 1, run.frames[1]);
  Body body;
  body.mesh.points = {Vec3(1, 0, 0), Vec3(0, 2, 0), Vec3(0, 0, 3)};
  body.mesh.normals = std::vector<Vec3>(3, Vec3::UnitZ());
  body.mesh.triangles = {{0, 2, 1}};
  for (int k = 0; k < 40; ++k) body.poses.push_back({Vec3(k, 0, 0), Quat(0.6, 0, 0.8, 0)});
  run.bodies = {body};
  const nlohmann::json data = page_data(report_page(run));
  const std::size_t frames = data["frames"].size();
  ASSERT_LT(frames, 40u);
  const nlohmann::json stored = data["bodies"].at(0);
  EXPECT_EQ(load<float>(unbase64(stored["points"]), 4 * 4), 2.0f);
  EXPECT_EQ(load<float>(unbase64(stored["normals"]), 4 * 8), 1.0f);
  EXPECT_EQ(load<std::uint32_t>(unbase64(stored["triangles"]), 4), 2u);
  const std::string poses = unbase64(stored["poses"]);
  ASSERT_EQ(poses.size(), 28 * frames);
  EXPECT_EQ(load<float>(poses, 0), 0.0f);
  EXPECT_EQ(load<float>(poses, 28 * (frames - 1)), 39.0f) << "the pose of the last frame";
  EXPECT_EQ(load<float>(poses, 4 * 4), 0.8f);
  EXPECT_EQ(load<float>(poses, 4 * 6), 0.6f);
}

TEST(Report, DropsFramesOfAHeavyRunButNeverTheEnds) {
  RunOutput run = sample_run(4000);
  while (run.frames.size() < 40) run.frames.insert(run.frames.begin() + 1, run.frames[1]);
  run.frames.back().time = 99;
  const std::string page = report_page(run);
  const nlohmann::json data = page_data(page);
  EXPECT_GE(data["frames"].size(), 2u);
  EXPECT_LT(data["frames"].size(), 40u);
  EXPECT_EQ(data["frames"].front()["time"], 0.0);
  EXPECT_EQ(data["frames"].back()["time"], 99.0);
  EXPECT_EQ(data["recorded_frames"], 40);
  EXPECT_LT(page.size(), 12u << 20);
}

}  // namespace
}  // namespace wunderlich::io
