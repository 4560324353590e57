/// What makes (r, q, eta) a ribbon: the paper's internal constraints, each a small struct.
///
/// Every constraint of this layer has the same four functions, found by overload:
///   rows(ribbon, c)                                 how many scalar equations
///   residual(ribbon, c, state, out)                 their values, `out` has `rows` entries
///   add_jacobian(ribbon, c, state, first_row, out)  derivatives in the chart, row `first_row` on (geometry/chart.hpp)
///   add_hessian(ribbon, c, state, multiplier, out)  of sum_k multiplier_k residual_k
/// `constraint/holding.hpp` has the external ones.
#pragma once

#include "wunderlich/geometry/chart.hpp"

namespace wunderlich::constraint {

using geometry::Triplets;
using ResidualRef = Eigen::Ref<Eigen::VectorXd>;
using MultiplierRef = Eigen::Ref<const Eigen::VectorXd>;

/// e.e - l.l per segment [m^2].   @eq Shen2015:12
struct Length {};

/// (r_{s+1} - r_s)/l - d3, three a segment, dimensionless. Contains the length.   @eq Shen2015:16
struct Parallel {};

/// gamma per hinge [1/m]: the centerline is a geodesic.   @eq Shen2015:14
struct Binormal {
  geometry::StrainMeasure strain = geometry::StrainMeasure::logarithm;
};

/// kappa eta - tau per hinge [1/m]: the relative rotation is about the ruling.   @eq Shen2015:15
struct TorsionMatch {
  geometry::StrainMeasure strain = geometry::StrainMeasure::logarithm;
};

/// 1 - x >= 0 and 1 + x >= 0 per segment, x = w eta'/2: inequalities, two rows a segment.   @eq Shen2015:13
struct RulingBound {};

/// How many scalar equations.
int rows(const geometry::Ribbon& ribbon, const Length&);
int rows(const geometry::Ribbon& ribbon, const Parallel&);
int rows(const geometry::Ribbon& ribbon, const Binormal&);
int rows(const geometry::Ribbon& ribbon, const TorsionMatch&);
int rows(const geometry::Ribbon& ribbon, const RulingBound&);

/// Their values; `out` has `rows` entries.
void residual(const geometry::Ribbon& ribbon, const Length&, const geometry::State& state, ResidualRef out);
void residual(const geometry::Ribbon& ribbon, const Parallel&, const geometry::State& state, ResidualRef out);
void residual(const geometry::Ribbon& ribbon, const Binormal& c, const geometry::State& state, ResidualRef out);
void residual(const geometry::Ribbon& ribbon, const TorsionMatch& c, const geometry::State& state, ResidualRef out);
void residual(const geometry::Ribbon& ribbon, const RulingBound&, const geometry::State& state, ResidualRef out);

/// Their derivatives in the chart of `geometry/chart.hpp`, from row `first_row` on.
void add_jacobian(const geometry::Ribbon& ribbon, const Length&, const geometry::State& state, int first_row,
                  Triplets& out);
void add_jacobian(const geometry::Ribbon& ribbon, const Parallel&, const geometry::State& state, int first_row,
                  Triplets& out);
void add_jacobian(const geometry::Ribbon& ribbon, const Binormal& c, const geometry::State& state, int first_row,
                  Triplets& out);
void add_jacobian(const geometry::Ribbon& ribbon, const TorsionMatch& c, const geometry::State& state, int first_row,
                  Triplets& out);
void add_jacobian(const geometry::Ribbon& ribbon, const RulingBound&, const geometry::State& state, int first_row,
                  Triplets& out);

/// Second derivatives of the sum of multiplier times residual, in the chart.
void add_hessian(const geometry::Ribbon& ribbon, const Length&, const geometry::State& state, MultiplierRef multiplier,
                 Triplets& out);
void add_hessian(const geometry::Ribbon& ribbon, const Parallel&, const geometry::State& state,
                 MultiplierRef multiplier, Triplets& out);
void add_hessian(const geometry::Ribbon& ribbon, const Binormal& c, const geometry::State& state,
                 MultiplierRef multiplier, Triplets& out);
void add_hessian(const geometry::Ribbon& ribbon, const TorsionMatch& c, const geometry::State& state,
                 MultiplierRef multiplier, Triplets& out);
void add_hessian(const geometry::Ribbon& ribbon, const RulingBound&, const geometry::State& state,
                 MultiplierRef multiplier, Triplets& out);

}  // namespace wunderlich::constraint
