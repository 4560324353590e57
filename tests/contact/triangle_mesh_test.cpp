/// Solids of triangles: a box of them is a box, faults are found, and inside is told from outside.
#include "wunderlich/contact/triangle_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "wunderlich/contact/mesh.hpp"

namespace wunderlich::contact {
namespace {

Vec3 random_point(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  return {uniform(random), uniform(random), uniform(random)};
}

const Box kBox{{0.3, 0.5, 0.2}};

TEST(TriangleMesh, OfABoxHasItsRidgesAndPeaks) {
  const TriangleMesh mesh = mesh_of(kBox);
  EXPECT_EQ(find_fault(mesh.vertices, mesh.triangles).fault, MeshFault::none);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_EQ(mesh.ridges.size(), 12u);  // without the diagonals of its faces
  EXPECT_EQ(mesh.peaks.size(), 8u);
  EXPECT_EQ(mesh.whole.high, kBox.half_size);
}

TEST(TriangleMesh, HasTheDistanceOfTheBoxThatItIs) {
  const Polyhedron polyhedron{std::make_shared<const TriangleMesh>(mesh_of(kBox))};
  std::mt19937_64 random(31);
  int inside = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 point = random_point(random, 0.6);
    const Distance box = distance(Shape{kBox}, point), mesh = distance(Shape{polyhedron}, point);
    EXPECT_NEAR(mesh.value, box.value, 1e-14);
    EXPECT_LT((mesh.normal - box.normal).norm(), 1e-10);
    EXPECT_LT((mesh.hessian - box.hessian).norm(), 1e-9 * (1 + box.hessian.norm()));
    EXPECT_NEAR(winding(*polyhedron.mesh, point), box.value < 0 ? 1 : 0, 1e-12);
    inside += box.value < 0 ? 1 : 0;
  }
  EXPECT_GT(inside, 20);
}

/// An L: two boxes side by side, one corner hollow.
TEST(TriangleMesh, LeavesHollowAndFlatEdgesAway) {
  std::vector<Vec3> vertices;
  const std::vector<Vec2> outline{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  for (const double z : {0.0, 1.0}) {
    for (const Vec2& p : outline) vertices.emplace_back(p.x(), p.y(), z);
  }
  std::vector<std::array<int, 3>> triangles;
  for (int i = 0; i < 6; ++i) {
    const int j = (i + 1) % 6;
    triangles.push_back({i, j, j + 6});
    triangles.push_back({i, j + 6, i + 6});
  }
  for (const auto& [a, b, c] : std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}) {
    triangles.push_back({a, c, b});
    triangles.push_back({a + 6, b + 6, c + 6});
  }
  ASSERT_EQ(find_fault(vertices, triangles).fault, MeshFault::none);
  const TriangleMesh mesh = make_mesh(vertices, triangles);
  EXPECT_EQ(mesh.ridges.size(), 6u + 6u + 5u);  // the upright one at 3 is hollow
  EXPECT_EQ(mesh.peaks.size(), 12u);
  EXPECT_NEAR(winding(mesh, {0.5, 1.5, 0.5}), 1, 1e-12);
  EXPECT_NEAR(winding(mesh, {1.5, 1.5, 0.5}), 0, 1e-12);
  // The three-edged corner 3 of the upper face is on ridges, the point in the hollow nearest to two faces.
  EXPECT_NEAR(distance(mesh, {1.2, 1.3, 0.5}).value, 0.2, 1e-15);
}

TEST(TriangleMesh, FaultsAreFound) {
  const TriangleMesh box = mesh_of(kBox);
  const auto fault = [&](const auto& change) {
    auto vertices = box.vertices;
    auto triangles = box.triangles;
    change(vertices, triangles);
    return find_fault(vertices, triangles);
  };
  EXPECT_EQ(fault([](auto&, auto& t) { t.pop_back(); }).fault, MeshFault::open);
  EXPECT_EQ(fault([](auto&, auto& t) { t.push_back(t.front()); }).fault, MeshFault::crowded);
  const FaultAt turned = fault([](auto&, auto& t) { std::swap(t[5][0], t[5][1]); });
  EXPECT_EQ(turned.fault, MeshFault::turned);
  EXPECT_EQ(fault([](auto&, auto& t) {
              for (auto& triangle : t) std::swap(triangle[0], triangle[1]);
            }).fault,
            MeshFault::inside_out);
  const FaultAt flat = fault([](auto& v, auto&) { v[7] = v[5]; });
  EXPECT_EQ(flat.fault, MeshFault::no_area);
  EXPECT_EQ(fault([](auto& v, auto&) { v[3] = Vec3::Constant(std::nan("")); }).fault, MeshFault::no_area);
}

TEST(TriangleMesh, IsPiercedWhereALineGoesThrough) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  EXPECT_TRUE(pierces({0.2, 0.2, -1}, {0.3, 0.2, 1}, a, b, c));
  EXPECT_TRUE(pierces({0.2, 0.2, 1}, {0.3, 0.2, -1}, a, b, c));
  EXPECT_TRUE(pierces({0.2, 0.2, 0}, {0.3, 0.2, 1}, a, b, c));     // begins there
  EXPECT_FALSE(pierces({0.2, 0.2, 0.1}, {0.3, 0.2, 1}, a, b, c));  // ends before
  EXPECT_FALSE(pierces({0.8, 0.8, -1}, {0.8, 0.8, 1}, a, b, c));   // beside
  EXPECT_FALSE(pierces({-1, 0.2, 0}, {1, 0.2, 0}, a, b, c));       // in the plane
}

TEST(TriangleMesh, IsShownWithNormalsOfItsFaces) {
  const Mesh picture = mesh_of(Shape{Polyhedron{std::make_shared<const TriangleMesh>(mesh_of(kBox))}}, 1);
  EXPECT_EQ(picture.triangles.size(), 12u);
  for (std::size_t i = 0; i < picture.points.size(); ++i) {
    EXPECT_NEAR(distance(Shape{kBox}, Vec3(picture.points[i] + 0.1 * picture.normals[i])).value, 0.1, 1e-15);
  }
}

}  // namespace
}  // namespace wunderlich::contact
