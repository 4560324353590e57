/// The paper's soft tie between frames and centerline, of the two-stage method.
#pragma once

#include "wunderlich/energy/model.hpp"
#include "wunderlich/geometry/chart.hpp"

namespace wunderlich::energy {

/// w_para sum over segments of |(r_{s+1} - r_s)/l - d3|^2 [J], `parallel_weight` in [J].   @eq Shen2015:20
double parallel_value(const geometry::Ribbon& ribbon, double parallel_weight, const geometry::State& state);
void add_parallel_gradient(const geometry::Ribbon& ribbon, double parallel_weight, const geometry::State& state,
                           Eigen::VectorXd& gradient);
void add_parallel_hessian(const geometry::Ribbon& ribbon, double parallel_weight, const geometry::State& state,
                          geometry::Triplets& hessian);

/// -dE_para/dr_s = +dE_para/dr_{s+1} of one segment: the force that turns its edge towards d3, on its first node [N].
Vec3 parallel_pull(const geometry::Ribbon& ribbon, double parallel_weight, const geometry::State& state, int segment);

/// The paper's choice alpha |K_D| / dim K [J], alpha = `weight_scale` in [10, 100]: K is the Hessian of the elastic
/// energy in (q, eta), K_D its diagonal. In terms of rotation vectors the diagonal of q is 4 times that of theta.
/// @eq Shen2015:5.1
double parallel_weight(const geometry::Ribbon& ribbon, const Model& model, const geometry::State& state,
                       double weight_scale);

}  // namespace wunderlich::energy
