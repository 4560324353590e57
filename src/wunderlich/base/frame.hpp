/// What an exporter sees: one recorded instant of a model, without any knowledge of the model.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "wunderlich/base/types.hpp"

namespace wunderlich {

/// One node of the centerline with its mean material frame and strains.
struct CenterlineSample {
  double u = 0;            ///< arc length from the start [m]
  Vec3 r = Vec3::Zero();   ///< position [m]
  Vec3 d1 = Vec3::Zero();  ///< surface normal on the centerline
  Vec3 d2 = Vec3::Zero();  ///< binormal, across the strip
  Vec3 d3 = Vec3::Zero();  ///< tangent
  double kappa = 0;        ///< curvature [1/m]
  double tau = 0;          ///< torsion [1/m]
  double eta = 0;          ///< ruling slope, ruling = d2 + eta d3
  double eta_prime = 0;    ///< d eta / du [1/m]
  int ribbon = 0;          ///< which strip it is of
};

/// A named scalar per mesh point.
struct PointField {
  std::string name;
  std::string unit;
  std::vector<double> values;
};

/// A triangle mesh with point data.
struct Mesh {
  std::vector<Vec3> points;                   ///< [m]
  std::vector<Vec3> normals;                  ///< unit, one a point
  std::vector<std::array<int, 3>> triangles;  ///< point indices
  std::vector<PointField> fields;
};

/// One instant: the centerline for tables and plots, the surface for pictures.
struct Frame {
  double time = 0;                           ///< [s]; the load parameter of an equilibrium path
  std::vector<CenterlineSample> centerline;  ///< segments + 1 samples of each strip
  Mesh surface;                              ///< same connectivity in every frame of a run
};

/// A rigid thing beside the strip: what an obstacle looks like and where it is.
struct Body {
  Mesh mesh;                ///< in its own frame
  std::vector<Pose> poses;  ///< of its own frame, one for each frame of the run
};

/// Does it stand elsewhere in some frame than in the first?
inline bool moves(const Body& body) {
  return std::any_of(body.poses.begin(), body.poses.end(), [&](const Pose& pose) {
    return pose.position != body.poses.front().position || pose.frame.coeffs() != body.poses.front().frame.coeffs();
  });
}

/// The strip unrolled flat: x along the strip, y across it.
struct FlatPattern {
  double length = 0;                                    ///< [m]
  double width = 0;                                     ///< [m]
  std::vector<std::array<Eigen::Vector2d, 2>> rulings;  ///< end points of each node's ruling [m]
  std::vector<double> fold_angle;                       ///< signed turn about each ruling [rad]
  bool loop = false;                                    ///< its two ends are joined
  int half_twists = 0;                                  ///< of a loop
  double thickness = 0;                                 ///< of the material [m]; 0: not known
};

}  // namespace wunderlich
