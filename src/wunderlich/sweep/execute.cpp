#include "wunderlich/sweep/execute.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "wunderlich/base/error.hpp"
#include "wunderlich/io/bytes.hpp"
#include "wunderlich/io/summary_json.hpp"
#include "wunderlich/scene/read.hpp"

namespace wunderlich::sweep {

namespace {

using Json = nlohmann::ordered_json;
using Get = double (*)(const CenterlineSample&);

Get getter(const std::string& field) {
  if (field == "kappa") return [](const CenterlineSample& s) { return s.kappa; };
  if (field == "tau") return [](const CenterlineSample& s) { return s.tau; };
  if (field == "eta") return [](const CenterlineSample& s) { return s.eta; };
  if (field == "x") return [](const CenterlineSample& s) { return s.r.x(); };
  if (field == "y") return [](const CenterlineSample& s) { return s.r.y(); };
  return [](const CenterlineSample& s) { return s.r.z(); };
}

double largest(const std::vector<CenterlineSample>& line, Get get) {
  double most = 0;
  for (const CenterlineSample& sample : line) most = std::max(most, std::abs(get(sample)));
  return most;
}

Json shape_json(const std::vector<CenterlineSample>& line) {
  Json shape;
  for (const char* field : {"kappa", "tau", "eta"}) shape[std::string("max_") + field] = largest(line, getter(field));
  return shape;
}

Json fields_json(const std::vector<std::string>& fields, const std::vector<CenterlineSample>& line) {
  Json out;
  for (const std::string& field : fields) {
    std::string values;
    for (const CenterlineSample& sample : line) io::append(values, getter(field)(sample));
    out[field] = io::base64(values);
  }
  return out;
}

void fill(const Sweep& sweep, const scene::Scene& scene, scene::RunResult& result, const Keep& keep, Record& record) {
  record.status = result.outcome == scene::Outcome::converged ? Status::done : Status::not_converged;
  record.reason = result.summary.failure;
  const Frame frame = scene::frame_of(scene, result.progress.records.back());
  Json body = {{"summary", Json::parse(io::summary_json(result.summary))}, {"shape", shape_json(frame.centerline)}};
  if (!sweep.fields.empty()) body["fields"] = fields_json(sweep.fields, frame.centerline);
  record.body = body.dump();
  if (keep && !sweep.keep.empty()) keep(scene, result, record.key);
}

}  // namespace

Record execute(const Sweep& sweep, std::size_t run, const Keep& keep) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  Record record;
  record.key = key_of(sweep, run);
  bool started = false;
  try {
    const scene::Scene scene =
        scene::read_scene_text(sweep.scene_text, sweep.scene_name + ".yaml", assignments_of(sweep, run));
    scene::check_start(scene);
    started = true;
    scene::RunResult result = scene::run(scene, {});
    fill(sweep, scene, result, keep, record);
  } catch (const InputError& error) {
    record.status = started ? Status::failed : Status::refused;  // after that only the disk can say no
    record.reason = error.what();
  } catch (const std::exception& error) {
    record.status = Status::failed;
    record.reason = error.what();
  }
  record.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return record;
}

}  // namespace wunderlich::sweep
