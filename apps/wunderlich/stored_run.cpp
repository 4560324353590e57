#include "stored_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "wunderlich/base/error.hpp"
#include "wunderlich/io/run_folder.hpp"
#include "wunderlich/picture/film.hpp"
#include "wunderlich/scene/read.hpp"

namespace wunderlich::app {

namespace {

constexpr std::array<const char*, 3> outcome_names{"converged", "not-converged", "interrupted"};

/// Calls `visit` on every number of a record, in a fixed order: the one description of how records are stored.
template <typename Record, typename Visit>
void visit_record(Record& record, Visit visit) {
  for (auto& state : record.states) {
    visit(state.time);
    for (auto& r : state.r) visit(r[0]), visit(r[1]), visit(r[2]);
    for (auto& v : state.r_dot) visit(v[0]), visit(v[1]), visit(v[2]);
    for (auto& q : state.q) visit(q.x()), visit(q.y()), visit(q.z()), visit(q.w());
    for (auto& eta : state.eta) visit(eta);
    for (auto& q : state.end_frame) visit(q.x()), visit(q.y()), visit(q.z()), visit(q.w());
  }
  auto& row = record.history;
  visit(row.time), visit(row.energy.elastic), visit(row.energy.kinetic);
  visit(row.energy.gravity), visit(row.energy.normalized);
  auto& errors = row.constraints;
  visit(errors.max_length_error), visit(errors.max_parallel_error), visit(errors.max_binormal);
  visit(errors.max_torsion_mismatch), visit(errors.max_ruling_ratio);
  visit(row.area_error), visit(row.step_us);
}

std::size_t numbers_of(scene::Record& record) {
  std::size_t count = 1;  // the iterations
  visit_record(record, [&](double&) { ++count; });
  return count;
}

std::vector<double> packed(const std::vector<scene::Record>& records) {
  std::vector<double> numbers;
  for (const scene::Record& record : records) {
    visit_record(record, [&](const double& number) { numbers.push_back(number); });
    numbers.push_back(record.history.iterations);
  }
  return numbers;
}

scene::Record empty_record(const scene::Scene& scene) {
  scene::Record record;
  for (const scene::Scene* strip : strips_of(scene)) {
    const auto n = static_cast<std::size_t>(strip->ribbon.segments);
    geometry::State& state = record.states.emplace_back();
    state.r.assign(n + 1, Vec3::Zero());
    state.r_dot.assign(n + 1, Vec3::Zero());
    state.q.assign(n, Quat::Identity());
    state.eta.assign(n + 1, 0.0);
  }
  return record;
}

std::vector<scene::Record> unpacked(const std::vector<double>& numbers, const scene::Scene& scene,
                                    const std::string& origin) {
  scene::Record record = empty_record(scene);
  const std::size_t size = numbers_of(record);
  if (numbers.size() % size != 0) throw InputError(origin + ": the stored states do not fit the stored scene");
  std::vector<scene::Record> records;
  for (auto number = numbers.begin(); number != numbers.end();) {
    visit_record(record, [&](double& target) { target = *number++; });
    const double iterations = *number++;
    if (!(iterations >= 0 && iterations < 2e9)) throw InputError(origin + ": a stored iteration count is no count");
    record.history.iterations = static_cast<int>(iterations);
    records.push_back(record);
  }
  return records;
}

std::string text_of(const io::Checkpoint& checkpoint, const std::string& name, const std::string& origin) {
  const auto found = checkpoint.texts.find(name);
  if (found == checkpoint.texts.end()) throw InputError(fmt::format("{}: holds no `{}`", origin, name));
  return found->second;
}

const std::vector<double>& array_of(const io::Checkpoint& checkpoint, const std::string& name,
                                    const std::string& origin) {
  const auto found = checkpoint.arrays.find(name);
  if (found == checkpoint.arrays.end()) throw InputError(fmt::format("{}: holds no `{}`", origin, name));
  return found->second;
}

/// The report's table of parameters.
std::vector<io::Parameter> parameters_of(const scene::Scene& scene) {
  std::vector<io::Parameter> list;
  for (const scene::Scene* strip : strips_of(scene)) {
    const geometry::RibbonSpec& ribbon = strip->ribbon;
    if (!strip->ribbon_name.empty()) list.emplace_back("ribbon", strip->ribbon_name);
    list.emplace_back("length", fmt::format("{:g} m", ribbon.length));
    list.emplace_back("width", fmt::format("{:g} m", ribbon.width));
    list.emplace_back("length / width", fmt::format("{:g}", ribbon.length / ribbon.width));
    list.emplace_back("segments", fmt::format("{}", ribbon.segments));
    list.emplace_back("bending stiffness", fmt::format("{:g} N m", ribbon.bending_stiffness));
    list.emplace_back("area density", fmt::format("{:g} kg/m²", ribbon.area_density));
    if (ribbon.closure == geometry::Closure::loop) {
      list.emplace_back("half twists", fmt::format("{}", ribbon.half_twists));
    }
  }
  const Vec3& g = scene.surroundings.gravity;
  if (!g.isZero(0)) list.emplace_back("gravity", fmt::format("({:g}, {:g}, {:g}) m/s²", g.x(), g.y(), g.z()));
  return list;
}

picture::Subject subject_of(const io::RunOutput& output) { return {output.frames, output.bodies, output.patterns}; }

}  // namespace

io::Checkpoint to_checkpoint(const StoredRun& run) {
  io::Checkpoint checkpoint;
  checkpoint.texts["name"] = run.scene.name;
  checkpoint.texts["scene"] = run.scene.resolved;
  checkpoint.texts["written"] = run.scene.written;
  checkpoint.texts["outcome"] = outcome_names[static_cast<std::size_t>(run.outcome)];
  checkpoint.arrays["records"] = packed(run.progress.records);
  checkpoint.arrays["cursor"] = run.progress.cursor;
  return checkpoint;
}

StoredRun from_checkpoint(const io::Checkpoint& checkpoint, const std::string& origin) {
  StoredRun run;
  run.scene = scene::read_scene_text(text_of(checkpoint, "scene", origin), origin);
  run.scene.name = text_of(checkpoint, "name", origin);
  run.scene.written = text_of(checkpoint, "written", origin);
  const std::string outcome = text_of(checkpoint, "outcome", origin);
  for (std::size_t i = 0; i < outcome_names.size(); ++i) {
    if (outcome == outcome_names[i]) run.outcome = static_cast<scene::Outcome>(i);
  }
  run.progress.records = unpacked(array_of(checkpoint, "records", origin), run.scene, origin);
  run.progress.cursor = array_of(checkpoint, "cursor", origin);
  return run;
}

StoredRun load_run(const std::filesystem::path& folder) {
  if (!io::is_run_folder(folder)) throw InputError(folder.string() + ": is not a run folder");
  const std::filesystem::path file = folder / io::checkpoint_file;
  return from_checkpoint(io::read_checkpoint(file), file.string());
}

void require_tools(const std::vector<io::Format>& formats) {
  if (std::find(formats.begin(), formats.end(), io::Format::mp4) != formats.end()) picture::require_film({});
}

io::RunOutput output_of(const StoredRun& run, const Summary& summary, std::string_view report_template,
                        const picture::Style& style) {
  io::RunOutput output;
  output.title = run.scene.title;
  output.summary = summary;
  for (const scene::Record& record : run.progress.records) {
    output.history.push_back(record.history);
    output.frames.push_back(frame_of(run.scene, record));
  }
  std::vector<double> times;
  for (const Frame& frame : output.frames) times.push_back(frame.time);
  output.bodies = bodies_of(run.scene, times);
  output.patterns = patterns_of(run.scene, run.progress.records.back());
  output.parameters = parameters_of(run.scene);
  output.scene_text = run.scene.resolved;
  output.checkpoint = to_checkpoint(run);
  output.report_template = report_template;
  output.png = [style](const io::RunOutput& drawn) { return picture::png(picture::still(subject_of(drawn), style)); };
  output.mp4 = [style](const io::RunOutput& drawn) { return picture::film(subject_of(drawn), style); };
  return output;
}

}  // namespace wunderlich::app
