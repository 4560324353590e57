/// Scalar, vector and rotation types that every layer speaks.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace wunderlich {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Vec4 = Eigen::Vector4d;
using Mat2 = Eigen::Matrix2d;
using Mat3 = Eigen::Matrix3d;
using Mat4 = Eigen::Matrix4d;

/// Unit quaternion of a material frame; the columns of its rotation matrix are d1, d2, d3.
/// Memory order is (x, y, z, w), the scalar last, as in the paper.
using Quat = Eigen::Quaterniond;

/// Of q and -q, which are one frame, the one nearer to another.   @eq Shen2015:18
inline Quat nearer(const Quat& frame, const Quat& to) { return frame.dot(to) < 0 ? Quat(-frame.coeffs()) : frame; }

/// A position with a material frame: what a clamp prescribes.
struct Pose {
  Vec3 position = Vec3::Zero();   ///< [m]
  Quat frame = Quat::Identity();  ///< columns d1, d2, d3
};

}  // namespace wunderlich
