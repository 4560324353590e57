/// The strip that a rod's sections span: x + v m2. Not developable as a rule; how far it is from it is what is
/// measured.
#pragma once

#include "wunderlich/base/frame.hpp"
#include "wunderlich/baseline/rod/frames.hpp"

namespace wunderlich::baseline::rod {

/// Frame of the strip at a node, as the ribbon's: columns m1, m2, tangent; between those of its two edges. Seen from
/// the first edge at node 0 of a loop and from the last at its last node.
Mat3 node_frame(const Rod& rod, const State& state, std::size_t node);

/// Points by node, `across` + 1 a node from v = -w/2 to w/2.
std::vector<Vec3> surface_points(const Rod& rod, const State& state, int across);

/// The same as a mesh with normals and `across` quads over the width of each edge.
Mesh surface_mesh(const Rod& rod, const State& state, int across);

/// Area over length times width, less one; between nodes m2 turns evenly. To quadrature, about 1e-6 for turns that a
/// picture resolves.
double area_change(const Rod& rod, const State& state);

/// Length of a rim over the length of the rod, less one; the rims at v = -w/2 and w/2. A Moebius strip has one rim, of
/// which each is a half.
std::array<double, 2> rim_stretch(const Rod& rod, const State& state);

/// Largest elongation of an edge of the centreline, over its rest length.
double largest_stretch(const Rod& rod, const State& state);

/// Nodes with frames and strains, for tables; eta is none of a rod's.
std::vector<CenterlineSample> centerline(const Rod& rod, const State& state);

}  // namespace wunderlich::baseline::rod
