#include "wunderlich/scene/build.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace wunderlich::scene {

namespace {

double width_of(const Cell& ribbon, double length) {
  const Cell width = child(ribbon, "width");
  const Cell aspect = child(ribbon, "aspect");
  if (width.value != nullptr && aspect.value != nullptr) fail(aspect, "contradicts `width`; give one of the two");
  if (aspect.value == nullptr) return number(width);
  return length / number(aspect);
}

/// One of `given` or a product of material constants `made_from`; never both.
bool from_constants(const Cell& ribbon, const std::string& given, const std::string& made_from) {
  const Cell constant = child(ribbon, made_from);
  if (constant.value == nullptr) return false;
  if (child(ribbon, given).value != nullptr)
    fail(constant, fmt::format("contradicts `{}`; give one of the two", given));
  if (child(ribbon, "thickness").value == nullptr) fail(constant, "needs `thickness` beside it");
  return true;
}

void check_derived(const Cell& cell, double value, const std::string& pattern) {
  const Key& key = *find_key(pattern);
  if (value >= key.low && value <= key.high) return;
  fail(cell, fmt::format("gives {} = {:g}; must be {}", pattern, value, allowed(key)));
}

double stiffness_of(const Cell& ribbon) {
  if (!from_constants(ribbon, "bending_stiffness", "young_modulus")) return number(child(ribbon, "bending_stiffness"));
  const double h = number(child(ribbon, "thickness"));
  const double nu = number(child(ribbon, "poisson_ratio"));
  const Cell modulus = child(ribbon, "young_modulus");
  const double stiffness = number(modulus) * h * h * h / (12 * (1 - nu * nu));
  check_derived(modulus, stiffness, "ribbon.bending_stiffness");
  return stiffness;
}

double density_of(const Cell& ribbon) {
  if (!from_constants(ribbon, "area_density", "mass_density")) return number(child(ribbon, "area_density"));
  const Cell density = child(ribbon, "mass_density");
  const double area_density = number(density) * number(child(ribbon, "thickness"));
  check_derived(density, area_density, "ribbon.area_density");
  return area_density;
}

/// Constants that nothing uses are a mistake worth telling.
void check_material_use(const Cell& ribbon) {
  const bool modulus = child(ribbon, "young_modulus").value != nullptr;
  const bool density = child(ribbon, "mass_density").value != nullptr;
  const Cell thickness = child(ribbon, "thickness");
  const Cell poisson = child(ribbon, "poisson_ratio");
  if (thickness.value != nullptr && !modulus && !density) {
    fail(thickness, "has no effect without `young_modulus` or `mass_density`");
  }
  if (poisson.value != nullptr && !modulus) fail(poisson, "has no effect without `young_modulus`");
}

std::vector<double> spacing_of(const Cell& ribbon, int segments) {
  const Cell cell = child(ribbon, "spacing");
  if (cell.value == nullptr) return {};
  std::vector<double> spacing = numbers(cell);
  if (spacing.size() != static_cast<std::size_t>(segments)) {
    fail(cell, fmt::format("has {} numbers; must have one a segment, {}", spacing.size(), segments));
  }
  const auto [least, most] = std::minmax_element(spacing.begin(), spacing.end());
  constexpr double largest_ratio = 1e4;
  if (*most > largest_ratio * *least) {
    fail(cell,
         fmt::format("the longest segment is {:g} times the shortest; at most {:g}", *most / *least, largest_ratio));
  }
  return spacing;
}

}  // namespace

geometry::RibbonSpec build_ribbon(const Cell& root) {
  const Cell cell = child(root, "ribbon");
  geometry::RibbonSpec ribbon;
  ribbon.length = number(child(cell, "length"));
  ribbon.width = width_of(cell, ribbon.length);
  check_derived(child(cell, "aspect"), ribbon.width, "ribbon.width");
  check_derived(child(cell, "width"), ribbon.length / ribbon.width, "ribbon.aspect");
  ribbon.segments = static_cast<int>(integer(child(cell, "segments")));
  check_material_use(cell);
  ribbon.bending_stiffness = stiffness_of(cell);
  ribbon.area_density = density_of(cell);
  ribbon.closure = chosen<geometry::Closure>(child(cell, "closure"),
                                             {{"open", geometry::Closure::open}, {"loop", geometry::Closure::loop}});
  ribbon.half_twists = static_cast<int>(integer(child(cell, "half_twists")));
  ribbon.free_rulings = boolean(child(cell, "free_rulings"));
  ribbon.spacing = spacing_of(cell, ribbon.segments);
  const bool loop = ribbon.closure == geometry::Closure::loop;
  if (!loop && ribbon.half_twists != 0)
    fail(child(cell, "half_twists"), "only a loop can have them; set `closure: loop`");
  if (loop && ribbon.free_rulings) fail(child(cell, "free_rulings"), "a loop has no ends; leave it out");
  if (loop && ribbon.segments < 3) fail(child(cell, "segments"), "a loop needs at least 3");
  return ribbon;
}

OutputOptions build_output(const Cell& root, const geometry::RibbonSpec& ribbon) {
  const Cell cell = child(root, "output");
  OutputOptions options;
  options.frames = static_cast<int>(integer(child(cell, "frames")));
  options.subdivision = static_cast<int>(integer(child(cell, "subdivision")));
  options.across = static_cast<int>(integer(child(cell, "across")));
  options.formats = words(child(cell, "formats"));
  const double segments = ribbon.segments;
  constexpr double most_states = 2e7;
  if (segments * options.frames > most_states) {
    fail(child(cell, "frames"),
         fmt::format("{} frames of {} segments are too much to keep; segments times frames at most {:g}",
                     options.frames, ribbon.segments, most_states));
  }
  constexpr double most_points = 2e7;
  if (segments * options.subdivision * (options.across + 1) > most_points) {
    fail(child(cell, "subdivision"),
         fmt::format("{} segments x {} strips x {} quads make too large a surface; at most {:g} points",
                     ribbon.segments, options.subdivision, options.across, most_points));
  }
  return options;
}

}  // namespace wunderlich::scene
