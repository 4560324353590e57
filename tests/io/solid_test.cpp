#include "wunderlich/io/solid.hpp"

#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <sstream>

#include "io/sample.hpp"
#include "wunderlich/io/formats.hpp"
#include "wunderlich/io/run_folder.hpp"
#include "wunderlich/io/stl.hpp"
#include "wunderlich/io/three_mf.hpp"
#include "wunderlich/io/zip.hpp"

namespace wunderlich::io {
namespace {

using testing::sample_run;

constexpr double pi = std::numbers::pi;
constexpr int rows = 97, columns = 5;
constexpr double radius = 1, width = 0.3, thickness = 0.02;

/// A band of unit radius whose rulings turn by `half_twists` half turns on the way round an arc; points, normals and
/// triangles in the order of geometry::render_mesh. `finer` parts where others have one.
Mesh band(double arc, int half_twists, int finer = 1) {
  const int along = finer * (rows - 1), across = finer * (columns - 1);
  Mesh mesh;
  for (int a = 0; a <= along; ++a) {
    const double phi = arc * a / along, turn = 0.5 * half_twists * phi;
    const Vec3 out(std::cos(phi), std::sin(phi), 0), tangent(-std::sin(phi), std::cos(phi), 0), up(0, 0, 1);
    const Vec3 ruling = std::cos(turn) * up + std::sin(turn) * out;
    const Vec3 turned = 0.5 * half_twists * (std::cos(turn) * out - std::sin(turn) * up);
    for (int b = 0; b <= across; ++b) {
      const double v = width * (static_cast<double>(b) / across - 0.5);
      mesh.points.push_back(radius * out + v * ruling);
      mesh.normals.push_back(ruling.cross((radius + v * std::sin(turn)) * tangent + v * turned).normalized());
    }
  }
  const int row = across + 1;
  for (int p = 0; p < along * row; ++p) {
    if (p % row == across) continue;
    mesh.triangles.push_back({p, p + 1, p + row});
    mesh.triangles.push_back({p + 1, p + row + 1, p + row});
  }
  return mesh;
}

double area(const Mesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const auto at = [&](std::size_t k) { return mesh.points[static_cast<std::size_t>(t[k])]; };
    sum += 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
  }
  return sum;
}

/// By the divergence theorem; positive when triangles are counter-clockwise from outside.
double volume(const Solid& solid) {
  double sum = 0;
  for (const auto& t : solid.triangles) {
    const auto at = [&](std::size_t k) { return solid.points[static_cast<std::size_t>(t[k])]; };
    sum += at(0).dot(at(1).cross(at(2))) / 6;
  }
  return sum;
}

/// Edges that are not run through once each way.
int bad_edges(const Solid& solid) {
  std::map<std::pair<int, int>, int> directed;
  for (const auto& t : solid.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++directed[{t[k], t[(k + 1) % 3]}];
  }
  int bad = 0;
  for (const auto& [edge, count] : directed) {
    const auto back = directed.find({edge.second, edge.first});
    if (count != 1 || back == directed.end() || back->second != 1) ++bad;
  }
  return bad;
}

/// Points - edges + triangles of a closed surface.
int euler(const Solid& solid) {
  const auto points = static_cast<int>(solid.points.size()), triangles = static_cast<int>(solid.triangles.size());
  return points - 3 * triangles / 2 + triangles;
}

/// Triangles that can be reached from the first over shared points.
std::size_t connected(const Solid& solid) {
  std::vector<bool> reached(solid.points.size(), false);
  for (const int p : solid.triangles[0]) reached[static_cast<std::size_t>(p)] = true;
  std::size_t count = 0, before;
  do {
    before = count;
    count = 0;
    for (const auto& t : solid.triangles) {
      bool any = false;
      for (const int p : t) any = any || reached[static_cast<std::size_t>(p)];
      if (!any) continue;
      ++count;
      for (const int p : t) reached[static_cast<std::size_t>(p)] = true;
    }
  } while (count > before);
  return count;
}

TEST(Solid, OpenStripIsABall) {
  const Mesh mesh = band(1.5 * pi, 0);
  const Solid solid = thicken(mesh, {0, rows, columns, false}, thickness);
  EXPECT_EQ(bad_edges(solid), 0);
  EXPECT_EQ(euler(solid), 2);
  EXPECT_EQ(connected(solid), solid.triangles.size());
  EXPECT_NEAR(volume(solid), area(mesh) * thickness, 1e-3 * area(mesh) * thickness);
}

class Loops : public ::testing::TestWithParam<int> {};

TEST_P(Loops, AreOneTorusHoweverOftenTurned) {
  const Mesh mesh = band(2 * pi, GetParam());
  const Solid solid = thicken(mesh, {0, rows, columns, true}, thickness);
  EXPECT_EQ(solid.points.size(), 2u * (rows - 1) * columns);
  EXPECT_EQ(bad_edges(solid), 0);
  EXPECT_EQ(euler(solid), 0);
  EXPECT_EQ(connected(solid), solid.triangles.size());
  double longest = 0;  // a seam joined the wrong way round would be spanned by triangles as long as the strip is wide
  for (const auto& t : solid.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 edge =
          solid.points[static_cast<std::size_t>(t[k])] - solid.points[static_cast<std::size_t>(t[(k + 1) % 3])];
      longest = std::max(longest, edge.norm());
    }
  }
  EXPECT_LT(longest, 0.15);
}

// The offset along normals cancels to first order; what stays is what triangles miss of a curved sheet, of second order
// in their length, and the Gaussian curvature times thickness squared over 12, which is below 1e-4 here.
TEST_P(Loops, HoldAreaTimesThickness) {
  const auto error = [](int finer) {
    const Mesh mesh = band(2 * pi, GetParam(), finer);
    const Grid grid{0, finer * (rows - 1) + 1, finer * (columns - 1) + 1, true};
    return std::abs(volume(thicken(mesh, grid, thickness)) / (area(mesh) * thickness) - 1);
  };
  EXPECT_LT(error(1), 5e-3);
  EXPECT_LT(error(2), error(1) / 3.5);
}

INSTANTIATE_TEST_SUITE_P(HalfTwists, Loops, ::testing::Values(0, 1, 2, -3));

TEST(Solid, RingHasTheVolumeOfAPipe) {
  const Solid solid = thicken(band(2 * pi, 0), {0, rows, columns, true}, thickness);
  // A polygon of n sides holds sin(2 pi/n) / (2 pi/n) of its circle.
  const double corner = 2 * pi / (rows - 1);
  EXPECT_NEAR(volume(solid), 2 * pi * radius * width * thickness * std::sin(corner) / corner, 1e-9);
}

TEST(Solid, StripsOfOneMeshAreTakenApart) {
  RunOutput run = sample_run();
  const Mesh second = run.frames.back().surface;
  Mesh& both = run.frames.back().surface;
  const auto shift = static_cast<int>(both.points.size());
  for (std::size_t i = 0; i < second.points.size(); ++i) {
    both.points.push_back(second.points[i] + Vec3(0, 0, 5));
    both.normals.push_back(second.normals[i]);
  }
  for (const auto& t : second.triangles) both.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  run.patterns.push_back(run.patterns[0]);
  run.patterns[1].thickness = 0.01;
  const std::vector<Solid> list = solids(run);
  ASSERT_EQ(list.size(), 2u);
  const double sheet = area(second);
  EXPECT_NEAR(volume(list[0]), sheet * run.patterns[0].width / 50, 0.01 * sheet * run.patterns[0].width / 50);
  EXPECT_NEAR(volume(list[1]), sheet * 0.01, 0.01 * sheet * 0.01);
  for (const Solid& solid : list) {
    EXPECT_EQ(bad_edges(solid), 0);
    EXPECT_EQ(euler(solid), 2);
  }
  run.thickness = 0.002;
  EXPECT_NEAR(volume(solids(run)[1]), sheet * 0.002, 0.01 * sheet * 0.002);
}

TEST(Solid, ObjCountsPointsThroughAllBodies) {
  const Solid one = thicken(band(pi, 0), {0, rows, columns, false}, thickness);
  std::istringstream lines(obj(std::vector<Solid>{one, one}, "ribbon"));
  std::size_t points = 0, faces = 0, objects = 0, largest = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "o") ++objects;
    if (kind == "v") ++points;
    if (kind != "f") continue;
    ++faces;
    for (std::size_t corner; words >> corner;) largest = std::max(largest, corner);
  }
  EXPECT_EQ(objects, 2u);
  EXPECT_EQ(points, 2 * one.points.size());
  EXPECT_EQ(faces, 2 * one.triangles.size());
  EXPECT_EQ(largest, points);
}

TEST(Stl, HoldsEveryTriangleInMillimetres) {
  const Solid solid = thicken(band(2 * pi, 1), {0, rows, columns, true}, thickness);
  const std::string file = stl({solid}, "band");
  ASSERT_EQ(file.size(), 84 + 50 * solid.triangles.size());
  EXPECT_NE(file.substr(0, 5), "solid");
  EXPECT_EQ(file[79], '\0') << "readers take the comment for a C string";
  std::uint32_t count;
  std::memcpy(&count, file.data() + 80, 4);
  EXPECT_EQ(count, solid.triangles.size());
  for (std::size_t t = 0; t < count; ++t) {
    float numbers[12];
    std::memcpy(numbers, file.data() + 84 + 50 * t, sizeof numbers);
    Vec3 corner[3];
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = 1000 * solid.points[static_cast<std::size_t>(solid.triangles[t][k])];
      EXPECT_LT((Vec3(numbers[3 + 3 * k], numbers[4 + 3 * k], numbers[5 + 3 * k]) - corner[k]).norm(), 1e-3);
    }
    const Vec3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
    EXPECT_LT((Vec3(numbers[0], numbers[1], numbers[2]) - normal).norm(), 1e-6);
  }
}

TEST(Zip, ChecksumIsTheStandardOne) {
  EXPECT_EQ(crc32("123456789"), 0xCBF43926u);  // the check value of CRC-32/ISO-HDLC in every catalogue of CRCs
  EXPECT_EQ(crc32(""), 0u);
}

TEST(ThreeMf, EscapesNamesAndIsTheSameEveryTime) {
  const Solid solid = thicken(band(pi, 0), {0, rows, columns, false}, thickness);
  const std::string file = three_mf({solid}, "a \"b\" & <c>");
  EXPECT_NE(file.find("name=\"a &quot;b&quot; &amp; &lt;c&gt;\""), std::string::npos);
  EXPECT_EQ(file, three_mf({solid}, "a \"b\" & <c>"));
}

TEST(Solid, ObjIsABodyOnlyWhereAThicknessIsAskedFor) {
  RunOutput run = sample_run();
  const std::string surface = render(Format::obj, run)[0].second;
  run.thickness = 0.002;
  const std::string body = render(Format::obj, run)[0].second;
  EXPECT_NE(surface.find("\nvn "), std::string::npos);
  EXPECT_EQ(body.find("\nvn "), std::string::npos);
  EXPECT_GT(body.size(), surface.size());
}

}  // namespace
}  // namespace wunderlich::io
