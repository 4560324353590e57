/// Meshes of solids: their points lie on the surface, their triangles look outwards and close.
#include "wunderlich/contact/mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace wunderlich::contact {
namespace {

/// Volume by the divergence theorem: right only if every triangle is there and turned outwards.
double volume(const Mesh& mesh) {
  double six_volumes = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto point = [&](int i) { return mesh.points[static_cast<std::size_t>(i)]; };
    six_volumes += point(a).cross(point(b)).dot(point(c));
  }
  return six_volumes / 6;
}

void expect_on_surface(const Shape& shape, const Mesh& mesh) {
  ASSERT_EQ(mesh.points.size(), mesh.normals.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const Vec3 outwards = mesh.points[i] + 0.1 * mesh.normals[i];
    EXPECT_NEAR(distance(shape, {}, mesh.points[i]).value, 0, 1e-15);
    EXPECT_NEAR(distance(shape, {}, outwards).value, 0.1, 1e-15);
  }
}

TEST(SolidMesh, HasItsPointsAndNormalsOnTheSurfaceAndItsVolume) {
  const double r = 0.3, h = 0.7;
  const double ball = 4 * EIGEN_PI / 3 * r * r * r, tube = EIGEN_PI * r * r * 2 * h;
  const std::vector<std::pair<Shape, double>> solids{
      {Sphere{r}, ball}, {Cylinder{r, h}, tube}, {Capsule{r, h}, ball + tube}, {Box{{0.1, 0.2, 0.4}}, 0.2 * 0.4 * 0.8}};
  for (const auto& [shape, exact] : solids) {
    const Mesh mesh = mesh_of(shape, 5);
    expect_on_surface(shape, mesh);
    EXPECT_NEAR(volume(mesh), exact, 5e-3 * exact);
  }
}

TEST(SolidMesh, CutsOffWhatHasNoEnd) {
  const Mesh plane = mesh_of(HalfSpace{}, 5);
  expect_on_surface(HalfSpace{}, plane);
  EXPECT_EQ(plane.points.front(), Vec3(-5, -5, 0));
  const Mesh tube = mesh_of(Cylinder{0.3, std::numeric_limits<double>::infinity()}, 5);
  EXPECT_NEAR(volume(tube), EIGEN_PI * 0.09 * 10, 0.02);
}

}  // namespace
}  // namespace wunderlich::contact
