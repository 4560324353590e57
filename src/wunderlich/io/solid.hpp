/// Bodies to print: the final surface given a thickness.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "wunderlich/base/frame.hpp"
#include "wunderlich/io/run_output.hpp"

namespace wunderlich::io {

/// A closed surface: every edge is of two triangles that run through it in opposite directions, counter-clockwise seen
/// from outside.
struct Solid {
  std::vector<Vec3> points;                   ///< [m]
  std::vector<std::array<int, 3>> triangles;  ///< point indices
};

/// Where one strip is in a mesh: `rows` rulings of `columns` points each, one after the other.
struct Grid {
  int first = 0;  ///< index of its first point
  int rows = 0;
  int columns = 0;
  bool loop = false;  ///< the last row is the first one again, maybe turned over
};

/// The strips of a frame, in the order of their patterns.
std::vector<Grid> grids(const Mesh& surface, const std::vector<FlatPattern>& patterns);

/// Half of the thickness [m] to both sides along the normals, closed by walls along the edges and at open ends. A loop
/// is joined across its seam; of a one-sided one the two sheets go over into each other, and the body is a torus as any
/// other. Where the surface bends more sharply than half the thickness the body passes through itself.
Solid thicken(const Mesh& surface, const Grid& grid, double thickness);

/// The final surface, a body a strip, as thick as `output.thickness` says; else as the material of the strip is, or,
/// where that is not known or makes no body, a fiftieth of its width. Throws InputError where `output.thickness` is no
/// more than a millionth of a strip's length, or more than its width.
std::vector<Solid> solids(const RunOutput& output);

/// Wavefront OBJ, in metres, z up; an object a body.
std::string obj(const std::vector<Solid>& solids, const std::string& name);

}  // namespace wunderlich::io
