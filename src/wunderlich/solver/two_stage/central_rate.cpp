#include "wunderlich/solver/two_stage/central_rate.hpp"

#include "wunderlich/energy/width_factor.hpp"
#include "wunderlich/solver/two_stage/objective.hpp"

namespace wunderlich::solver::two_stage {

using geometry::Ribbon;

namespace {

/// The nodes whose eta make the central difference at a hinge, as the hinge's node sees them.
struct Difference {
  std::size_t before, after;
  double after_sign;  ///< across the seam
  double slope;       ///< dx/d eta_after
};

Difference difference_at(const Ribbon& ribbon, std::size_t node) {
  const auto last = static_cast<std::size_t>(ribbon.segments);
  const auto& l = ribbon.rest_length;
  const double half = 0.5 * ribbon.width;
  if (node > 0 && node < last) return {node - 1, node + 1, 1, half / (l[node - 1] + l[node])};
  if (ribbon.is_loop()) return {last - 1, 1, ribbon.seam_sign(), half / (l[last - 1] + l[0])};
  if (node == 0) return {0, 1, 1, half / l[0]};
  return {last - 1, last, 1, half / l[last - 1]};
}

}  // namespace

double central_elastic(const Ribbon& ribbon, const energy::Model& model, const geometry::State& shape,
                       const Workspace& work, std::vector<double>* gradient) {
  double sum = 0;
  for (std::size_t h = 0; h < work.hinges.size(); ++h) {
    const auto node = static_cast<std::size_t>(work.hinges[h].node);
    const Difference d = difference_at(ribbon, node);
    const double x = d.slope * (d.after_sign * shape.eta[d.after] - shape.eta[d.before]);
    const auto phi = energy::width_factor(model, x);
    const double kappa = work.strain[h][1], tau = work.strain[h][2], eta = shape.eta[node];
    const double weight = 0.5 * ribbon.bending_stiffness * ribbon.width * work.hinges[h].length;
    const double stretch = 2 + eta * eta, bending = kappa * kappa + tau * tau * stretch;
    sum += weight * phi.value * bending;
    if (gradient == nullptr) continue;
    const double scale = 2 * weight * phi.value;
    add_end_slope(work, node, scale * Vec3(kappa, tau * stretch, tau * tau * eta), *gradient);
    const double rate = weight * phi.first * bending * d.slope;
    const NodeView& before = work.views[d.before];
    const NodeView& after = work.views[d.after];
    (*gradient)[static_cast<std::size_t>(4 * before.eta)] -= before.eta_sign * rate;
    (*gradient)[static_cast<std::size_t>(4 * after.eta)] += after.eta_sign * d.after_sign * rate;
  }
  return sum;
}

}  // namespace wunderlich::solver::two_stage
