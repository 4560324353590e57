#include "wunderlich/solver/two_stage/types.hpp"

namespace wunderlich::solver::two_stage {

Options printed_options() {
  Options options;
  options.model = {energy::Elastic::truncated, 5, energy::StrainMeasure::printed};
  options.ode.weight = ParallelWeight::state;
  options.ode.damping = Damping::per_step;
  options.opt.minimiser = Minimiser::lbfgs;
  options.opt.projection = Projection::gauss_seidel;
  options.opt.barrier = 0;
  options.opt.proximal = 0;
  options.opt.central_rate = true;
  options.opt.step_size = 0.05;
  options.opt.max_iterations = 30;
  options.contact.metric = ContactMetric::printed;
  options.inertia = TorsionalInertia::off;
  options.substeps = false;
  return options;
}

}  // namespace wunderlich::solver::two_stage
