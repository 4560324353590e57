#include "wunderlich/io/solid.hpp"

#include <fmt/format.h>

#include <cassert>
#include <iterator>

#include "wunderlich/base/error.hpp"

namespace wunderlich::io {

namespace {

/// The two sheets of a strip, as indices of points.
struct Sheets {
  Grid grid;
  bool turned = false;  ///< a loop whose last ruling is the first one turned over

  int kept_rows() const { return grid.loop ? grid.rows - 1 : grid.rows; }

  /// `side` 0 lies along the normal, 1 against it.
  int operator()(int row, int column, int side) const {
    if (row == kept_rows()) {  // beyond the seam
      return turned ? index(0, grid.columns - 1 - column, 1 - side) : index(0, column, side);
    }
    return index(row, column, side);
  }

 private:
  int index(int row, int column, int side) const { return 2 * (row * grid.columns + column) + side; }
};

/// Cut from the second corner to the last.
void add_quad(Solid& solid, int a, int b, int c, int d) {
  solid.triangles.push_back({a, b, d});
  solid.triangles.push_back({b, c, d});
}

/// Both sheets over the quad between two rows: cut along the same diagonal, so that the body is as thick everywhere.
void add_sheets(Solid& solid, const Sheets& at, int row, int column) {
  const auto point = [&](int down, int right, int side) { return at(row + down, column + right, side); };
  add_quad(solid, point(0, 0, 0), point(0, 1, 0), point(1, 1, 0), point(1, 0, 0));
  add_quad(solid, point(0, 0, 1), point(1, 0, 1), point(1, 1, 1), point(0, 1, 1));
}

}  // namespace

std::vector<Grid> grids(const Mesh& surface, const std::vector<FlatPattern>& patterns) {
  assert(!surface.triangles.empty() && !patterns.empty());
  // The first triangle spans two rows; each row has a point more than the rulings are cut.
  const int columns = surface.triangles[0][2] - surface.triangles[0][0];
  const int rows = static_cast<int>(surface.points.size()) / columns;
  int segments = 0;
  for (const FlatPattern& pattern : patterns) segments += static_cast<int>(pattern.rulings.size()) - 1;
  const int subdivision = (rows - static_cast<int>(patterns.size())) / segments;
  std::vector<Grid> list;
  int first = 0;
  for (const FlatPattern& pattern : patterns) {
    const int own = subdivision * (static_cast<int>(pattern.rulings.size()) - 1) + 1;
    list.push_back({first, own, columns, pattern.loop});
    first += own * columns;
  }
  assert(static_cast<std::size_t>(first) == surface.points.size());
  return list;
}

Solid thicken(const Mesh& surface, const Grid& grid, double thickness) {
  assert(grid.rows >= 2 && grid.columns >= 2 && (!grid.loop || grid.rows >= 4));
  const auto first = static_cast<std::size_t>(grid.first);
  const auto last = static_cast<std::size_t>(grid.first + (grid.rows - 1) * grid.columns);
  const Sheets at{grid, grid.loop && surface.normals[first].dot(surface.normals[last]) < 0};
  const auto count = static_cast<std::size_t>(at.kept_rows() * grid.columns);
  Solid solid;
  solid.points.reserve(2 * count);
  for (std::size_t i = first; i < first + count; ++i) {
    const Vec3 offset = 0.5 * thickness * surface.normals[i];
    solid.points.push_back(surface.points[i] + offset);
    solid.points.push_back(surface.points[i] - offset);
  }
  const int right = grid.columns - 1;
  for (int row = 0; row + 1 < grid.rows; ++row) {
    for (int column = 0; column < right; ++column) add_sheets(solid, at, row, column);
    add_quad(solid, at(row, 0, 0), at(row + 1, 0, 0), at(row + 1, 0, 1), at(row, 0, 1));
    add_quad(solid, at(row, right, 0), at(row, right, 1), at(row + 1, right, 1), at(row + 1, right, 0));
  }
  if (grid.loop) return solid;
  const int end = grid.rows - 1;
  for (int column = 0; column < right; ++column) {
    add_quad(solid, at(0, column, 0), at(0, column, 1), at(0, column + 1, 1), at(0, column + 1, 0));
    add_quad(solid, at(end, column, 0), at(end, column + 1, 0), at(end, column + 1, 1), at(end, column, 1));
  }
  return solid;
}

namespace {

/// Files hold single precision, in which both sheets must differ.
double least_thickness(const FlatPattern& strip) { return 1e-6 * strip.length; }

bool makes_body(double thickness, const FlatPattern& strip) {
  return thickness >= least_thickness(strip) && thickness <= strip.width;
}

double thickness_of(const RunOutput& output, const FlatPattern& strip) {
  if (!output.thickness) return makes_body(strip.thickness, strip) ? strip.thickness : strip.width / 50;
  if (makes_body(*output.thickness, strip)) return *output.thickness;
  throw InputError(fmt::format(
      "--thickness: {:g} m is not allowed; must be from {:g} m, a millionth of the length, to the width, {:g} m",
      *output.thickness, least_thickness(strip), strip.width));
}

}  // namespace

std::vector<Solid> solids(const RunOutput& output) {
  const Mesh& surface = output.frames.back().surface;
  const std::vector<Grid> strips = grids(surface, output.patterns);
  std::vector<Solid> list;
  for (std::size_t i = 0; i < strips.size(); ++i) {
    list.push_back(thicken(surface, strips[i], thickness_of(output, output.patterns[i])));
  }
  return list;
}

std::string obj(const std::vector<Solid>& solids, const std::string& name) {
  std::string out = "# metres, z up\n";
  auto end = std::back_inserter(out);
  std::size_t before = 1;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    fmt::format_to(end, "o {}{}\n", name, i == 0 ? "" : fmt::format("-{}", i + 1));
    for (const Vec3& p : solids[i].points) fmt::format_to(end, "v {} {} {}\n", p.x(), p.y(), p.z());
    for (const auto& t : solids[i].triangles) {
      const auto at = [&](int k) { return before + static_cast<std::size_t>(t[static_cast<std::size_t>(k)]); };
      fmt::format_to(end, "f {} {} {}\n", at(0), at(1), at(2));
    }
    before += solids[i].points.size();
  }
  return out;
}

}  // namespace wunderlich::io
