/// The quadratic bending of isometric surfaces, with a Hessian that is constant.
#pragma once

#include <vector>

#include "wunderlich/baseline/shell/shell.hpp"

namespace wunderlich::baseline::shell {

/// A linear function of the points: sum of weight * x[point].
struct Stencil {
  std::vector<int> points;
  std::vector<double> weights;
};

/// The mean curvature of an edge times its area: |e| (t_1 + t_2) with the outward conormals t of its two triangles,
/// each by the gradient of the surface in its triangle. Its length is 2 |e| sin(theta/2) where an edge is folded by
/// theta. In a conforming shell on the vertices (cotangent weights), in a nonconforming one on the midpoints of edges.
/// `edge` must not lie on the rim.   @eq Wardetzky2007, Bergou2006
Stencil vertex_stencil(const StripMesh& mesh, int edge);
Stencil midpoint_stencil(const StripMesh& mesh, int edge);

/// K of sum over edges of (D/2) share |H_e|^2 / (area of the edge's two triangles). Ghosts have no area: an edge at a
/// clamp stands for half a cell. Rims have no rows, which is the natural condition of a free edge. As printed `share`
/// is 3; see the shells for why a conforming one takes 1.   @eq Wardetzky2007, Bergou2006
Sparse bending_matrix(const StripMesh& mesh, double stiffness, double share, Stencil (*stencil)(const StripMesh&, int),
                      int point_count);

/// Elastic energy [J].
double bending_energy(const Shell& shell, const Points& x);

}  // namespace wunderlich::baseline::shell
