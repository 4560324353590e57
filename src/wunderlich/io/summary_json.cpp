#include "wunderlich/io/summary_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "wunderlich/base/error.hpp"
#include "wunderlich/base/version.hpp"

namespace wunderlich::io {

namespace {

using Json = nlohmann::ordered_json;

void require_finite(const Json& value, const std::string& key) {
  if (value.is_number_float() && !std::isfinite(value.get<double>())) {
    throw std::domain_error(fmt::format("summary.json: {} is not finite", key));
  }
  if (!value.is_structured()) return;
  for (const auto& [name, item] : value.items())
    require_finite(item, key.empty() ? name : fmt::format("{}.{}", key, name));
}

Json vector_json(const Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); }

Vec3 vector_from(const Json& value) {
  return {value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>()};
}

Json energy_json(const Energies& energy) {
  return {{"elastic", energy.elastic},
          {"kinetic", energy.kinetic},
          {"gravity", energy.gravity},
          {"total", energy.total()},
          {"normalized", energy.normalized}};
}

Json constraints_json(const ConstraintErrors& errors) {
  return {{"max_length_error", errors.max_length_error},
          {"max_parallel_error", errors.max_parallel_error},
          {"max_binormal", errors.max_binormal},
          {"max_torsion_mismatch", errors.max_torsion_mismatch},
          {"max_ruling_ratio", errors.max_ruling_ratio}};
}

Json timing_json(const Timing& timing) {
  Json out = {{"wall_seconds", timing.wall_seconds},
              {"step_us_median", timing.step_us_median},
              {"step_us_p95", timing.step_us_p95},
              {"iterations_mean", timing.iterations_mean}};
  if (timing.phases.empty()) return out;
  out["phases"] = Json::array();
  for (const auto& [phase, seconds] : timing.phases) out["phases"].push_back({{"name", phase}, {"seconds", seconds}});
  return out;
}

Json to_json(const Summary& summary) {
  Json out;
  out["program"] = program;
  out["version"] = version;
  out["scene"] = summary.scene;
  out["model"] = summary.model;
  out["method"] = summary.method;
  out["converged"] = summary.converged;
  if (!summary.failure.empty()) out["failure"] = summary.failure;
  out["segments"] = summary.segments;
  out["time"] = summary.time;
  out["steps"] = summary.steps;
  out["energy"] = energy_json(summary.energy);
  out["constraints"] = constraints_json(summary.constraints);
  out["area_error"] = summary.area_error;
  out["timing"] = timing_json(summary.timing);
  if (summary.contact) {
    out["contact"] = {{"count", summary.contact->count},
                      {"max_penetration", summary.contact->max_penetration},
                      {"minimum_distance", summary.contact->minimum_distance}};
  }
  if (summary.closure_error) out["closure_error"] = *summary.closure_error;
  out["ends"] = Json::array();
  for (const Reaction& end : summary.ends) {
    out["ends"].push_back({{"force", vector_json(end.force)}, {"torque", vector_json(end.torque)}});
  }
  if (summary.stability) {
    out["stability"] = {{"stable", summary.stability->stable}, {"negative_modes", summary.stability->negative_modes}};
  }
  const Topology& topology = summary.topology;
  out["topology"] = {{"twist", topology.twist}, {"writhe", topology.writhe}, {"link", topology.link}};
  out["kappa_zeros"] = summary.kappa_zeros;
  out["warnings"] = summary.warnings;
  return out;
}

Timing timing_from(const Json& in) {
  Timing out;
  out.wall_seconds = in.at("wall_seconds");
  out.step_us_median = in.at("step_us_median");
  out.step_us_p95 = in.at("step_us_p95");
  out.iterations_mean = in.at("iterations_mean");
  for (const Json& phase : in.value("phases", Json::array())) {
    out.phases.emplace_back(phase.at("name").get<std::string>(), phase.at("seconds").get<double>());
  }
  return out;
}

Summary from_json(const Json& in) {
  Summary out;
  out.scene = in.at("scene");
  out.model = in.at("model");
  out.method = in.at("method");
  out.converged = in.at("converged");
  out.failure = in.value("failure", "");
  out.segments = in.at("segments");
  out.time = in.at("time");
  out.steps = in.at("steps");
  const Json& energy = in.at("energy");
  out.energy = {energy.at("elastic"), energy.at("kinetic"), energy.at("gravity"), energy.at("normalized")};
  const Json& errors = in.at("constraints");
  out.constraints = {errors.at("max_length_error"), errors.at("max_parallel_error"), errors.at("max_binormal"),
                     errors.at("max_torsion_mismatch"), errors.at("max_ruling_ratio")};
  out.area_error = in.at("area_error");
  out.timing = timing_from(in.at("timing"));
  if (in.contains("contact")) {
    const Json& contact = in["contact"];
    out.contact = ContactSummary{contact.at("count"), contact.at("max_penetration"), contact.at("minimum_distance")};
  }
  if (in.contains("closure_error")) out.closure_error = in["closure_error"].get<double>();
  for (const Json& end : in.at("ends"))
    out.ends.push_back({vector_from(end.at("force")), vector_from(end.at("torque"))});
  if (in.contains("stability")) {
    out.stability = Stability{in["stability"].at("stable"), in["stability"].at("negative_modes")};
  }
  const Json& topology = in.at("topology");
  out.topology = {topology.at("twist"), topology.at("writhe"), topology.at("link")};
  out.kappa_zeros = in.at("kappa_zeros").get<std::vector<double>>();
  out.warnings = in.at("warnings").get<std::vector<std::string>>();
  return out;
}

}  // namespace

std::string summary_json(const Summary& summary) {
  const Json out = to_json(summary);
  require_finite(out, "");
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Summary parse_summary(std::string_view text, std::string_view origin) {
  try {
    return from_json(Json::parse(text));
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: not a summary of a run: {}", origin, error.what()));
  }
}

}  // namespace wunderlich::io
