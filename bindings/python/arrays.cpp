#include "arrays.hpp"

#include <algorithm>
#include <string>

#include "wunderlich/geometry/surface.hpp"

namespace wunderlich::bindings {

namespace {

using Array = py::array_t<double>;
using Shape = std::vector<py::ssize_t>;

py::ssize_t size_of(std::size_t size) { return static_cast<py::ssize_t>(size); }

py::array read_only(const Shape& shape, const double* data, py::handle owner) {
  py::array array(py::dtype::of<double>(), shape, data, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// Calls `visit(name, value)` for every number of a row: the one list of the history's columns.
template <class Visit>
void visit_row(const HistoryRow& row, const Visit& visit) {
  visit("time", row.time);
  visit("elastic", row.energy.elastic), visit("kinetic", row.energy.kinetic), visit("gravity", row.energy.gravity);
  visit("total", row.energy.total()), visit("normalized", row.energy.normalized);
  visit("max_length_error", row.constraints.max_length_error);
  visit("max_parallel_error", row.constraints.max_parallel_error);
  visit("max_binormal", row.constraints.max_binormal);
  visit("max_torsion_mismatch", row.constraints.max_torsion_mismatch);
  visit("max_ruling_ratio", row.constraints.max_ruling_ratio);
  visit("area_error", row.area_error), visit("iterations", row.iterations), visit("step_us", row.step_us);
}

/// The arrays of a strip under way.
struct StripArrays {
  Array time, r, r_dot, q, eta, d1, d2, d3, kappa, tau, eta_prime;

  StripArrays(py::ssize_t frames, py::ssize_t nodes)
      : time(frames),
        r(Shape{frames, nodes, 3}),
        r_dot(Shape{frames, nodes, 3}),
        q(Shape{frames, nodes - 1, 4}),
        eta(Shape{frames, nodes}),
        d1(Shape{frames, nodes, 3}),
        d2(Shape{frames, nodes, 3}),
        d3(Shape{frames, nodes, 3}),
        kappa(Shape{frames, nodes}),
        tau(Shape{frames, nodes}),
        eta_prime(Shape{frames, nodes}) {}

  void set(py::ssize_t f, const geometry::State& state, const std::vector<CenterlineSample>& line) {
    time.mutable_at(f) = state.time;
    std::copy_n(state.r.front().data(), 3 * state.r.size(), r.mutable_data(f));
    std::copy_n(state.r_dot.front().data(), 3 * state.r_dot.size(), r_dot.mutable_data(f));
    std::copy_n(state.q.front().coeffs().data(), 4 * state.q.size(), q.mutable_data(f));
    std::copy_n(state.eta.data(), state.eta.size(), eta.mutable_data(f));
    for (std::size_t i = 0; i < line.size(); ++i) {
      const py::ssize_t n = size_of(i);
      std::copy_n(line[i].d1.data(), 3, d1.mutable_data(f, n));
      std::copy_n(line[i].d2.data(), 3, d2.mutable_data(f, n));
      std::copy_n(line[i].d3.data(), 3, d3.mutable_data(f, n));
      kappa.mutable_at(f, n) = line[i].kappa;
      tau.mutable_at(f, n) = line[i].tau;
      eta_prime.mutable_at(f, n) = line[i].eta_prime;
    }
  }
};

}  // namespace

py::array view(const std::vector<Vec3>& vectors, py::handle owner) {
  return read_only({size_of(vectors.size()), 3}, vectors.front().data(), owner);
}

py::array view(const std::vector<Quat>& rotations, py::handle owner) {
  return read_only({size_of(rotations.size()), 4}, rotations.front().coeffs().data(), owner);
}

py::array view(const std::vector<double>& numbers, py::handle owner) {
  return read_only({size_of(numbers.size())}, numbers.data(), owner);
}

py::dict strip_arrays(const scene::Scene& scene, const std::vector<scene::Record>& records, std::size_t strip) {
  const scene::Scene& own = *scene::strips_of(scene).at(strip);
  const std::size_t nodes = records.front().states.at(strip).r.size();
  StripArrays arrays(size_of(records.size()), size_of(nodes));
  geometry::Ribbon ribbon;
  for (std::size_t f = 0; f < records.size(); ++f) {
    const geometry::State& state = records[f].states[strip];
    ribbon = scene::ribbon_of(own, state);
    arrays.set(size_of(f), state, geometry::centerline(ribbon, state));
  }
  py::dict out;
  out["u"] = Array(size_of(nodes), ribbon.node_u.data());
  out["time"] = arrays.time, out["r"] = arrays.r, out["r_dot"] = arrays.r_dot, out["q"] = arrays.q;
  out["eta"] = arrays.eta, out["d1"] = arrays.d1, out["d2"] = arrays.d2, out["d3"] = arrays.d3;
  out["kappa"] = arrays.kappa, out["tau"] = arrays.tau, out["eta_prime"] = arrays.eta_prime;
  return out;
}

py::dict history_arrays(const std::vector<scene::Record>& records) {
  py::dict out;
  for (std::size_t f = 0; f < records.size(); ++f) {
    visit_row(records[f].history, [&](const char* name, auto value) {
      if (f == 0) out[name] = py::array_t<decltype(value)>(size_of(records.size()));
      py::cast<py::array_t<decltype(value)>>(out[name]).mutable_at(f) = value;
    });
  }
  return out;
}

py::dict history_dict(const HistoryRow& row) {
  py::dict out;
  visit_row(row, [&](const char* name, auto value) { out[name] = value; });
  return out;
}

py::dict surface_arrays(const Mesh& mesh) {
  py::dict out;
  out["points"] = Array(Shape{size_of(mesh.points.size()), 3}, mesh.points.front().data());
  out["triangles"] = py::array_t<int>(Shape{size_of(mesh.triangles.size()), 3}, mesh.triangles.front().data());
  py::dict fields, units;
  for (const PointField& field : mesh.fields) {
    fields[field.name.c_str()] = Array(size_of(field.values.size()), field.values.data());
    units[field.name.c_str()] = field.unit;
  }
  out["fields"] = fields, out["units"] = units;
  return out;
}

}  // namespace wunderlich::bindings
