/// A sweep: one base scene, axes along which keys of it change, and what is collected of each run.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "wunderlich/scene/document.hpp"

namespace wunderlich::sweep {

/// One value of an axis: what it is called in tables, and the keys it sets.
struct AxisPoint {
  std::vector<double> values;            ///< one a column; NaN where the value is a word
  std::vector<std::string> words;        ///< the same as text
  std::vector<std::string> assignments;  ///< `key=value`
};

/// Columns that change together. A plain axis has one; zipped and sampled ones have several.
struct Axis {
  std::vector<std::string> columns;
  std::vector<AxisPoint> points;
  bool logarithmic = false;  ///< drawn so
};

/// A result: its column, and where in the run's record it stands, `energy.normalized`.
struct Collected {
  std::string name;
  std::string path;
};

struct Sweep {
  std::string name;
  std::string title;
  std::string scene_name;
  std::string scene_text;                ///< the base scene, whole
  std::vector<std::string> assignments;  ///< `key=value` of every run
  std::vector<Axis> axes;                ///< runs are all their combinations, the last axis fastest
  std::vector<Collected> collected;
  std::vector<std::string> fields;  ///< by node: some of kappa, tau, eta, x, y, z
  std::vector<std::string> keep;    ///< formats of a run folder for each run; none: its figures only
  double timeout = 0;               ///< of a run [s]; 0: none
  std::string text;                 ///< the sweep as YAML that stands alone
};

/// Reads a sweep file. Throws InputError with file, line and key: what the table of keys forbids, axes without values,
/// two axes that set one key, values that the scene refuses (each is tried alone).
Sweep read_sweep(const std::string& path);

/// The same from text; `folder` is where the base scene is looked for.
Sweep read_sweep_text(const std::string& text, const std::string& source);

std::size_t run_count(const Sweep& sweep);

/// Indices into the axes' points.
std::vector<std::size_t> place_of(const Sweep& sweep, std::size_t run);

/// What a run sets, in order.
std::vector<std::string> assignments_of(const Sweep& sweep, std::size_t run);

/// Names a run by what it is: a hash of the base scene, the assignments and the program's version, 16 hex digits.
std::string key_of(const Sweep& sweep, std::size_t run);

/// Random numbers that are the same on every machine.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double uniform();                  ///< in [0, 1)
  std::size_t below(std::size_t n);  ///< in [0, n)

 private:
  std::uint64_t next();
  std::uint64_t state_;
};

}  // namespace wunderlich::sweep
