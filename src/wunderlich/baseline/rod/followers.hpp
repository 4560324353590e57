/// Loads that turn with a section, and torques: they have no potential.
#pragma once

#include "wunderlich/baseline/rod/contact.hpp"

namespace wunderlich::baseline::rod {

/// A force at a node and a torque on the section of an edge that ends there.
struct Follower {
  std::size_t node = 0, edge = 0;
  bool turns = false;  ///< components along the section's m1, m2, m3; else along world axes
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  ///< [N], [N m]
};

/// What it does on the seven coordinates of its edge (first node, turn, second node): its work by their increments is
/// force . increment, and the derivative of that force in them is not symmetric.   @eq Bergou2010
struct FollowerTerms {
  Vec7 force;
  Mat7 derivative;
};
FollowerTerms follower_terms(const State& state, const Follower& load);

}  // namespace wunderlich::baseline::rod
