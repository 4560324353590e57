/// A strip made by hand: in the plane z = 0 along x, or bent to an arc.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "wunderlich/base/frame.hpp"

namespace wunderlich::picture::testing {

/// `rows` quads along the length l, `across` over the width w; curved up to an arc of curvature `kappa`.
inline Frame strip(double l, double w, int rows, int across, double kappa = 0) {
  Frame frame;
  Mesh& mesh = frame.surface;
  mesh.fields = {{"u", "m", {}}, {"v", "m", {}}, {"kappa", "1/m", {}}, {"tau", "1/m", {}}, {"eta", "", {}}};
  for (int i = 0; i <= rows; ++i) {
    const double u = l * i / rows, a = kappa * u;
    const Vec3 r = kappa == 0 ? Vec3(u, 0, 0) : Vec3(std::sin(a) / kappa, 0, (1 - std::cos(a)) / kappa);
    const Vec3 d3(std::cos(a), 0, std::sin(a)), d1(-std::sin(a), 0, std::cos(a)), d2 = d3.cross(d1);
    frame.centerline.push_back({u, r, d1, d2, d3, kappa});
    for (int b = 0; b <= across; ++b) {
      const double v = w * (static_cast<double>(b) / across - 0.5);
      mesh.points.push_back(r + v * d2);
      mesh.normals.push_back(d1);
      const double values[] = {u, v, kappa, 0, 0};
      for (std::size_t f = 0; f < 5; ++f) mesh.fields[f].values.push_back(values[f]);
    }
  }
  for (int a = 0; a < rows; ++a) {
    for (int b = 0; b < across; ++b) {
      const int p = a * (across + 1) + b;
      mesh.triangles.push_back({p, p + 1, p + across + 1});
      mesh.triangles.push_back({p + 1, p + across + 2, p + across + 1});
    }
  }
  return frame;
}

inline FlatPattern pattern(double l, double w) {
  FlatPattern out;
  out.length = l;
  out.width = w;
  return out;
}

}  // namespace wunderlich::picture::testing
