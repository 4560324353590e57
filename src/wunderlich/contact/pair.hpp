/// Two parts of triangulated surfaces beside each other: how far they are apart, and the barrier between them.
#pragma once

#include <array>

#include "wunderlich/base/types.hpp"

namespace wunderlich::contact {

using Vec12 = Eigen::Matrix<double, 12, 1>;
using Mat12 = Eigen::Matrix<double, 12, 12>;

/// What the four points of a pair are: a vertex and a triangle's corners, or the ends of one edge and of another.
enum class PairKind { vertex_triangle, edge_edge };
using PairPoints = std::array<Vec3, 4>;

/// Where two closed primitives are nearest to each other. `way` = sum of weights times points leads from the second to
/// the first; weights of the first sum to 1, those of the second to -1.
struct PairNearest {
  double distance;  ///< [m]
  Vec3 way;         ///< [m]
  Vec4 weights;     ///< of the four points
};

/// Of the points of a pair; where several places are as near, one of them.
PairNearest pair_nearest(PairKind kind, const PairPoints& x);

/// Euclidean distance of the closed primitives [m], not signed. Finite for any finite points: triangles without area
/// and edges without length are what is left of them.
double pair_distance(PairKind kind, const PairPoints& x);

/// How the barrier of a pair acts.
struct Gap {
  double reach;     ///< distance beyond `offset` at which it begins [m]
  double offset;    ///< distance at which it is infinite: the bodies' thickness [m]
  double parallel;  ///< |e1 x e2|^2 of two edges below which it is weakened, 0 for never [m^4]
};

/// Energy and its derivatives with respect to the four points. `second` times `along along^T` is the part of the
/// Hessian that pulls along the way, never negative; what is left may be.
struct PairEnergy {
  double value;
  Vec12 gradient;
  Mat12 hessian;
  Vec12 along;    ///< gradient of the distance
  double second;  ///< derivative of the energy by the distance
};

/// The barrier B(distance - offset, reach). Of edges the nearest points jump when they turn through parallel; there it
/// is multiplied by a factor that falls to 0, which makes it once continuously differentiable. Infinite where the
/// distance is not above the offset (Li2020, nearly parallel edges)
double pair_value(PairKind kind, const PairPoints& x, const Gap& gap);

/// The same with its exact derivatives, not made positive. Where it is infinite the derivatives are 0.
PairEnergy pair_energy(PairKind kind, const PairPoints& x, const Gap& gap);

}  // namespace wunderlich::contact
