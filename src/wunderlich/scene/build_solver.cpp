#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "wunderlich/scene/build.hpp"
#include "wunderlich/scene/keyframes.hpp"
#include "wunderlich/solver/two_stage/types.hpp"

namespace wunderlich::scene {

namespace two_stage = solver::two_stage;

namespace {

/// Keys that only one method reads; given with another they are a mistake worth telling.
void check_use(const Cell& solver, Method method) {
  using Methods = std::vector<Method>;
  const Methods newton{Method::implicit, Method::equilibrium}, motion{Method::implicit, Method::two_stage};
  const std::vector<std::pair<Methods, std::vector<std::string>>> own{
      {{Method::equilibrium}, {"steps"}},
      {newton, {"tolerance", "max_iterations", "barrier"}},
      {motion, {"time_step", "stop_at_rest", "damping"}},
      {{Method::implicit}, {"integrator", "kinetic_energy", "conserve", "error"}},
      {{Method::two_stage},
       {"form", "projection", "minimiser", "weight_scale", "step_size", "substeps", "torsional_inertia",
        "inertia_form"}}};
  for (const auto& [owners, names] : own) {
    if (std::find(owners.begin(), owners.end(), method) != owners.end()) continue;
    for (const std::string& name : names) {
      const Cell cell = child(solver, name);
      if (cell.value == nullptr) continue;
      const std::string others = owners.size() > 1 ? fmt::format("` and `{}", method_name(owners[1])) : "";
      fail(cell, fmt::format("has no effect with `method: {}`; it belongs to `{}{}`", method_name(method),
                             method_name(owners[0]), others));
    }
  }
}

energy::Model model_of(const Cell& cell) {
  energy::Model model;
  model.elastic = chosen<energy::Elastic>(child(cell, "energy"), {{"wunderlich", energy::Elastic::wunderlich},
                                                                  {"truncated", energy::Elastic::truncated},
                                                                  {"sadowsky", energy::Elastic::sadowsky}});
  const Cell order = child(cell, "taylor_order");
  if (order.value != nullptr && model.elastic != energy::Elastic::truncated) {
    fail(order, "has no effect without `energy: truncated`");
  }
  model.taylor_order = static_cast<int>(integer(order));
  model.strain = chosen<energy::StrainMeasure>(child(cell, "strain"), {{"logarithm", energy::StrainMeasure::logarithm},
                                                                       {"printed", energy::StrainMeasure::printed}});
  return model;
}

LoopPath loop_path_of(const Cell& solver, const geometry::RibbonSpec& ribbon) {
  const Cell cell = child(solver, "path");
  const auto path = chosen<LoopPath>(
      cell, {{"automatic", LoopPath::automatic}, {"twist", LoopPath::twist}, {"planar", LoopPath::planar}});
  if (cell.value != nullptr && ribbon.closure != geometry::Closure::loop) {
    fail(cell, "says how a loop is made; the strip is open");
  }
  if (path == LoopPath::planar && std::abs(ribbon.half_twists) != 2) {
    fail(cell, "leads to a loop with two half twists only; set `ribbon.half_twists: 2`");
  }
  return path;
}

void read_damping(const Cell& damping, two_stage::OdeOptions& ode) {
  const Cell tangent = child(damping, "tangent"), normal = child(damping, "normal");
  const Cell factor_tangent = child(damping, "factor_tangent"), factor_normal = child(damping, "factor_normal");
  if (child(damping, "material").value != nullptr) {
    fail(child(damping, "material"), "has no effect with `method: two-stage`; it belongs to `implicit`");
  }
  const bool rates = tangent.value != nullptr || normal.value != nullptr;
  const bool factors = factor_tangent.value != nullptr || factor_normal.value != nullptr;
  if (rates && factors) fail(damping, "has rates and factors; give one of the two");
  if (rates) ode.damping = two_stage::Damping::rate;
  if (factors) ode.damping = two_stage::Damping::per_step;
  if (rates) ode.damping_tangent = number(tangent), ode.damping_normal = number(normal);
  if (factor_tangent.value != nullptr) ode.factor_tangent = number(factor_tangent);
  if (factor_normal.value != nullptr) ode.factor_normal = number(factor_normal);
}

two_stage::Options two_stage_of(const Cell& cell, const energy::Model& model) {
  const bool printed = text(child(cell, "form")) == "printed";
  two_stage::Options options = printed ? two_stage::printed_options() : two_stage::Options{};
  const auto given = [&](const char* name) { return child(cell, name).value != nullptr; };
  const bool own_model = given("energy") || given("taylor_order") || given("strain");
  if (!printed || own_model) options.model = model;
  if (given("projection")) {
    options.opt.projection = chosen<two_stage::Projection>(
        child(cell, "projection"),
        {{"direct", two_stage::Projection::direct}, {"gauss-seidel", two_stage::Projection::gauss_seidel}});
    if (options.opt.projection == two_stage::Projection::gauss_seidel) {
      options.opt.minimiser = two_stage::Minimiser::lbfgs;  // Newton's method has no projection of its own
    }
  }
  if (given("minimiser")) {
    options.opt.minimiser = chosen<two_stage::Minimiser>(
        child(cell, "minimiser"), {{"newton", two_stage::Minimiser::newton}, {"lbfgs", two_stage::Minimiser::lbfgs}});
  }
  if (options.opt.minimiser == two_stage::Minimiser::newton) {
    const std::string problem = "has no effect with `minimiser: newton`, which holds the constraints itself";
    if (options.opt.central_rate) fail(child(cell, "minimiser"), "`form: printed` needs lbfgs");
    if (options.opt.projection == two_stage::Projection::gauss_seidel) fail(child(cell, "projection"), problem);
    if (given("step_size")) fail(child(cell, "step_size"), problem);
  }
  if (given("step_size")) options.opt.step_size = number(child(cell, "step_size"));
  if (given("substeps")) options.substeps = boolean(child(cell, "substeps"));
  if (given("weight_scale")) options.ode.weight_scale = number(child(cell, "weight_scale"));
  if (given("torsional_inertia")) {
    options.inertia_scale = number(child(cell, "torsional_inertia"));
    options.inertia =
        options.inertia_scale > 0 ? two_stage::TorsionalInertia::physical : two_stage::TorsionalInertia::off;
  }
  if (given("inertia_form") && options.inertia != two_stage::TorsionalInertia::off) {
    options.inertia = chosen<two_stage::TorsionalInertia>(
        child(cell, "inertia_form"),
        {{"physical", two_stage::TorsionalInertia::physical}, {"printed", two_stage::TorsionalInertia::printed}});
  }
  read_damping(child(cell, "damping"), options.ode);
  return options;
}

solver::implicit::Options implicit_of(const Cell& cell) {
  using solver::implicit::Integrator;
  using solver::implicit::KineticEnergy;
  solver::implicit::Options options;
  options.integrator = chosen<Integrator>(
      child(cell, "integrator"),
      {{"generalised-alpha", Integrator::generalised_alpha}, {"bdf2", Integrator::bdf2}, {"euler", Integrator::euler}});
  options.kinetic = chosen<KineticEnergy>(
      child(cell, "kinetic_energy"),
      {{"centerline", KineticEnergy::centerline}, {"rotary", KineticEnergy::rotary}, {"full", KineticEnergy::full}});
  const Cell iterations = child(cell, "max_iterations"), damping = child(cell, "damping");
  options.tolerance = number_or(child(cell, "tolerance"), options.tolerance);
  if (iterations.value != nullptr) options.max_iterations = static_cast<int>(integer(iterations));
  options.error = number_or(child(cell, "error"), options.error);
  options.barrier = number_or(child(cell, "barrier"), options.barrier);
  for (const char* factor : {"factor_tangent", "factor_normal"}) {
    if (child(damping, factor).value != nullptr) {
      fail(child(damping, factor), "depends on the step; the implicit method knows the rates `tangent` and `normal`");
    }
  }
  options.drag_tangent = number(child(damping, "tangent"));
  options.drag_normal = number(child(damping, "normal"));
  options.viscosity = number(child(damping, "material"));
  options.conserve = boolean(child(cell, "conserve"));
  if (options.conserve && options.viscosity > 0) fail(child(cell, "conserve"), "contradicts `damping.material`");
  return options;
}

/// Where a strip that nothing holds starts, if the scene says so.
std::optional<Pose> place_of(const Cell& root, const Cell& initial) {
  const Cell position = child(initial, "position"), tangent = child(initial, "tangent");
  const Cell normal = child(initial, "normal");
  std::optional<Pose> place;
  for (const Cell& cell : {position, tangent, normal}) {
    if (cell.value == nullptr) continue;
    for (const char* support : {"clamps", "pins"}) {
      if (count(child(root, support)) > 0)
        fail(cell, fmt::format("has no effect with `{}`, which place the strip", support));
    }
    place.emplace();
  }
  if (!place) return place;
  place->position = vector(position);
  place->frame = frame_of({direction(tangent), direction(normal)}, {"tangent", "normal", "[0, 0, 1]"}, initial);
  return place;
}

}  // namespace

const char* method_name(Method method) {
  switch (method) {
    case Method::implicit:
      return "implicit";
    case Method::two_stage:
      return "two-stage";
    case Method::equilibrium:
      break;
  }
  return "equilibrium";
}

Method method_of(const Cell& root) {
  return chosen<Method>(
      child(child(root, "solver"), "method"),
      {{"implicit", Method::implicit}, {"two-stage", Method::two_stage}, {"equilibrium", Method::equilibrium}});
}

SolverOptions build_solver(const Cell& root, const geometry::RibbonSpec& ribbon, double last_key) {
  const Cell cell = child(root, "solver");
  SolverOptions options;
  options.method = method_of(root);
  check_use(cell, options.method);
  options.energy = model_of(cell);
  options.loop_path = loop_path_of(cell, ribbon);
  const Cell duration = child(cell, "duration");
  options.duration = duration.value != nullptr ? number(duration) : last_key > 0 ? last_key : 1;
  if (child(cell, "steps").value != nullptr && ribbon.closure == geometry::Closure::loop) {
    fail(child(cell, "steps"), "counts the load steps of an open strip; a loop's path finds its own");
  }
  options.steps = static_cast<int>(integer(child(cell, "steps")));
  const Cell iterations = child(cell, "max_iterations");
  options.tolerance = number_or(child(cell, "tolerance"), options.tolerance);
  if (iterations.value != nullptr) options.max_iterations = static_cast<int>(integer(iterations));
  options.barrier = number_or(child(cell, "barrier"), options.barrier);
  options.time_step = number(child(cell, "time_step"));
  options.stop_at_rest = boolean(child(cell, "stop_at_rest"));
  if (options.method == Method::implicit) options.implicit = implicit_of(cell);
  if (options.method == Method::two_stage) {
    options.two_stage = two_stage_of(cell, options.energy);
    options.energy = options.two_stage.model;
    if (ribbon.closure == geometry::Closure::loop && ribbon.segments < 5) {
      fail(child(child(root, "ribbon"), "segments"), "a loop in motion needs at least 5");
    }
  }
  if (options.method != Method::equilibrium && options.duration / options.time_step > 1e8) {
    fail(child(cell, "time_step"), "makes more than 1e8 steps");
  }
  return options;
}

namespace {

/// Largest slope of the rulings next to square ends, beyond which they would meet there.
double most_slope(const geometry::RibbonSpec& ribbon) {
  const double least = ribbon.spacing.empty() ? 1.0 : *std::min_element(ribbon.spacing.begin(), ribbon.spacing.end());
  const double sum =
      ribbon.spacing.empty() ? ribbon.segments : std::accumulate(ribbon.spacing.begin(), ribbon.spacing.end(), 0.0);
  return 2 * ribbon.length * least / sum / ribbon.width;
}

void check_end_slope(const Cell& cell, const geometry::RibbonSpec& ribbon) {
  const double most = most_slope(ribbon);
  if (ribbon.free_rulings || std::abs(number(cell)) < most) return;
  fail(cell, fmt::format("makes rulings meet next to the square ends; below {:g} in size, or with fewer segments, or "
                         "with `ribbon.free_rulings`",
                         most));
}

std::vector<ProfileRow> profile_of(const Cell& cell, const geometry::RibbonSpec& ribbon) {
  if (cell.value == nullptr) fail(cell, "is missing; `shape: profile` wants it");
  std::vector<ProfileRow> rows;
  for (std::size_t i = 0; i < count(cell); ++i) {
    const Cell row = element(cell, i);
    rows.push_back({number(child(row, "at")), number(child(row, "curvature")), number(child(row, "slope"))});
    if (i == 0) continue;
    const double way = ribbon.length * (rows[i].at - rows[i - 1].at);
    if (!(way > 0)) fail(child(row, "at"), "must be larger than the one before");
    if (0.5 * ribbon.width * std::abs(rows[i].slope - rows[i - 1].slope) >= way) {
      fail(row, "makes rulings meet: the slope may change by less than 2/width per length");
    }
  }
  if (rows.size() < 2) fail(cell, "must have at least two places");
  for (const std::size_t end : {std::size_t{0}, rows.size() - 1}) {
    check_end_slope(child(element(cell, end), "slope"), ribbon);
  }
  return rows;
}

}  // namespace

InitialState build_initial(const Cell& root, const geometry::RibbonSpec& ribbon) {
  const Cell cell = child(root, "initial");
  const bool loop = ribbon.closure == geometry::Closure::loop;
  InitialState initial;
  initial.shape = loop ? InitialShape::equilibrium : InitialShape::straight;
  if (cell.value == nullptr) return initial;
  if (method_of(root) == Method::equilibrium) fail(cell, "has no effect with `method: equilibrium`");
  if (const Cell shape = child(cell, "shape"); shape.value != nullptr) {
    initial.shape = chosen<InitialShape>(shape, {{"straight", InitialShape::straight},
                                                 {"coil", InitialShape::coil},
                                                 {"profile", InitialShape::profile},
                                                 {"closed", InitialShape::closed},
                                                 {"equilibrium", InitialShape::equilibrium}});
    const bool open = initial.shape == InitialShape::straight || initial.shape == InitialShape::coil ||
                      initial.shape == InitialShape::profile;
    if (loop && open) {
      fail(shape, "is open; a loop starts `closed` or at `equilibrium`");
    }
    if (!loop && initial.shape == InitialShape::closed) fail(shape, "is for loops; the strip is open");
  }
  for (const char* name : {"radius", "slope"}) {
    if (initial.shape != InitialShape::coil && child(cell, name).value != nullptr) {
      fail(child(cell, name), "has no effect without `shape: coil`");
    }
  }
  if (initial.shape == InitialShape::coil) {
    initial.radius = number(child(cell, "radius"));
    initial.slope = number(child(cell, "slope"));
    check_end_slope(child(cell, "slope"), ribbon);
  }
  const Cell profile = child(cell, "profile");
  if (initial.shape == InitialShape::profile) {
    initial.profile = profile_of(profile, ribbon);
  } else if (profile.value != nullptr) {
    fail(profile, "has no effect without `shape: profile`");
  }
  initial.place = place_of(root, cell);
  initial.velocity = vector(child(cell, "velocity"));
  initial.spin = vector(child(cell, "spin"));
  return initial;
}

}  // namespace wunderlich::scene
