#include "wunderlich/scene/run.hpp"

#include <pybind11/functional.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <utility>

#include "arrays.hpp"
#include "module.hpp"
#include "stored_run.hpp"
#include "wunderlich/base/error.hpp"
#include "wunderlich/io/file.hpp"
#include "wunderlich/io/run_folder.hpp"
#include "wunderlich/io/summary_json.hpp"

namespace wunderlich::bindings {

namespace {

using scene::Scene;

/// A run and what is said of it.
struct Run {
  app::StoredRun stored;
  Summary summary;

  const std::vector<scene::Record>& records() const { return stored.progress.records; }
  const scene::Record& record(long frame) const {
    const auto count = static_cast<long>(records().size());
    if (frame < -count || frame >= count) throw py::index_error("frame out of range");
    return records()[static_cast<std::size_t>(frame < 0 ? frame + count : frame)];
  }
};

/// Has Ctrl-C been pressed? Another exception of a signal's handler goes on.
bool interrupted() {
  if (PyErr_CheckSignals() == 0) return false;
  if (PyErr_ExceptionMatches(PyExc_KeyboardInterrupt) == 0) throw py::error_already_set();
  PyErr_Clear();
  return true;
}

/// Asks Python after each step. False, or Ctrl-C, ends the run with what it has.
bool goes_on(const py::object& observer, const scene::RunStatus& status, bool& by_user) {
  const py::gil_scoped_acquire python;
  by_user = interrupted();
  if (by_user) return false;
  if (observer.is_none()) return true;
  try {
    return !observer(status.phase, status.fraction, status.iterations).is(py::bool_(false));
  } catch (py::error_already_set& error) {
    if (!error.matches(PyExc_KeyboardInterrupt)) throw;
    by_user = true;
    return false;
  }
}

/// The run, and whether it was Ctrl-C that ended it.
std::pair<Run, bool> run(const Scene& scene, const py::object& observer, const Run* resume) {
  const py::gil_scoped_release others;
  if (resume == nullptr) check_start(scene);
  bool by_user = false;
  const scene::Observer ask = [&](const scene::RunStatus& status) { return goes_on(observer, status, by_user); };
  scene::RunResult result = scene::run(scene, ask, resume != nullptr ? &resume->stored.progress : nullptr);
  Run run{{scene, std::move(result.progress), result.outcome}, std::move(result.summary)};
  return {std::move(run), by_user};
}

const char* outcome_name(const Run& run) {
  switch (run.stored.outcome) {
    case scene::Outcome::converged:
      return "converged";
    case scene::Outcome::not_converged:
      return "not_converged";
    case scene::Outcome::interrupted:
      break;
  }
  return "interrupted";
}

void save(const Run& run, const std::filesystem::path& folder, const std::vector<std::string>& formats) {
  const py::gil_scoped_release others;
  std::vector<io::Format> list;
  for (const std::string& name : formats) {
    list.push_back(io::parse_format(name));
    if (list.back() == io::Format::html) {
      throw InputError("html: the page is made by the program: `wunderlich export --to html` takes the saved folder");
    }
  }
  app::require_tools(list);
  io::require_writable(folder);
  io::write_run_folder(folder, app::output_of(run.stored, run.summary, {}), list);
}

Run load(const std::filesystem::path& folder) {
  const std::filesystem::path summary = folder / io::summary_file;
  app::StoredRun stored = app::load_run(folder);
  return {std::move(stored), io::parse_summary(io::read_file(summary), summary.string())};
}

py::tuple kept(const Run& run) {
  return py::make_tuple(py::bytes(io::encode_checkpoint(app::to_checkpoint(run.stored))),
                        io::summary_json(run.summary));
}

Run from_kept(const py::tuple& kept) {
  const std::string bytes = kept[0].cast<std::string>();
  return {app::from_checkpoint(io::decode_checkpoint(bytes, "pickle"), "pickle"),
          io::parse_summary(kept[1].cast<std::string>(), "pickle")};
}

}  // namespace

void define_run(py::module_& module) {
  py::class_<Run>(module, "Run")
      .def_property_readonly("scene", [](const Run& r) { return r.stored.scene; })
      .def_property_readonly("outcome", &outcome_name)
      .def_property_readonly("frames", [](const Run& r) { return r.records().size(); })
      .def_property_readonly("strips", [](const Run& r) { return r.records().front().states.size(); })
      .def("summary_json", [](const Run& r) { return io::summary_json(r.summary); })
      .def(
          "state",
          [](const Run& r, long frame, std::size_t strip) -> const geometry::State& {
            const std::vector<geometry::State>& states = r.record(frame).states;
            if (strip >= states.size()) throw py::index_error("strip out of range");
            return states[strip];
          },
          py::return_value_policy::reference_internal)
      .def("arrays", [](const Run& r, std::size_t strip) { return strip_arrays(r.stored.scene, r.records(), strip); })
      .def("history", [](const Run& r) { return history_arrays(r.records()); })
      .def("surface",
           [](const Run& r, long frame) { return surface_arrays(frame_of(r.stored.scene, r.record(frame)).surface); })
      .def("save", &save)
      .def(py::pickle(&kept, &from_kept));
  module.def("run", &run);
  module.def("load_run", &load);
}

}  // namespace wunderlich::bindings
