/// Elastic energy of a rod with exact first and second derivatives in its coordinates (see frames.hpp).
///
/// Derivatives are those of the energy as a function of increments from the very state they are taken at, frames
/// carried along: the gauge in which transport in time adds nothing to first order, and a known term to second.
#pragma once

#include <array>

#include "wunderlich/baseline/rod/frames.hpp"

namespace wunderlich::baseline::rod {

/// Strains at a node, over its hinge's length.   @eq Bergou2008:1, Bergou2010
struct Strain {
  double soft = 0, hard = 0;  ///< curvature about m2 and m1, averaged over the two sections [1/m]
  double twist = 0;           ///< [rad/m]
};
Strain strain(const Rod& rod, const State& state, std::size_t node);

/// Of stretching, bending and twisting [J].
struct Energy {
  double stretch = 0, soft = 0, hard = 0, twist = 0;
  double sum() const { return stretch + soft + hard + twist; }
};
Energy elastic_energy(const Rod& rod, const State& state);

/// Derivatives by the eleven coordinates around a node: node, edge, node, edge, node.
using Vec11 = Eigen::Matrix<double, 11, 1>;
using Mat11 = Eigen::Matrix<double, 11, 11>;
struct HingeTerms {
  Vec11 gradient;
  Mat11 hessian;
};

/// What bends and twists at a node: its energy is the sum of stiffness strain^2/2 of these, its forces the sum of
/// stress slope with stress = stiffness strain.
struct Measures {
  int count = 0;
  std::array<double, 5> strain{}, stiffness{};
  std::array<Vec11, 5> slope;
};
Measures measures(const Rod& rod, const State& state, std::size_t node);

/// `stress`, one a measure: those that the Hessian has turn with the rod, where a method knows better than what strains
/// say; null: what they say.
HingeTerms hinge_terms(const Rod& rod, const State& state, std::size_t node, const double* stress = nullptr);

/// What stretches an edge [N].
double tension(const Rod& rod, const State& state, std::size_t edge);

/// Of stretching an edge, by the vector from its first node to its second. `turned` [N] is the tension that the Hessian
/// has turn with the edge: its own, or what a method expects it to be.
struct EdgeTerms {
  Vec3 gradient;
  Mat3 hessian;
};
EdgeTerms edge_terms(const Rod& rod, const State& state, std::size_t edge, double turned);

/// The coordinates around a node, in the order of its terms. In a loop those of node 0 stand for the last node's.
std::array<std::size_t, 11> hinge_coordinates(const Rod& rod, std::size_t node);

}  // namespace wunderlich::baseline::rod
