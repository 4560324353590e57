/// States and records as NumPy arrays.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <vector>

#include "wunderlich/scene/run.hpp"

namespace wunderlich::bindings {

namespace py = pybind11;

/// Read-only views of the state's own memory; `owner` is kept alive by them.
py::array view(const std::vector<Vec3>& vectors, py::handle owner);    ///< (n, 3)
py::array view(const std::vector<Quat>& rotations, py::handle owner);  ///< (n, 4): x, y, z, w
py::array view(const std::vector<double>& numbers, py::handle owner);  ///< (n)

/// All records of one strip by name; the first axis counts records.
py::dict strip_arrays(const scene::Scene& scene, const std::vector<scene::Record>& records, std::size_t strip);

/// A column an array: the names of `history.csv`, and the rest of HistoryRow.
py::dict history_arrays(const std::vector<scene::Record>& records);

/// One history row by the same names.
py::dict history_dict(const HistoryRow& row);

/// "points" (n, 3), "triangles" (m, 3); "fields" (n) and "units" by name.
py::dict surface_arrays(const Mesh& mesh);

}  // namespace wunderlich::bindings
