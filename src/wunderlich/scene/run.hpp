/// Runs a scene: the one call behind the command line and the bindings.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "wunderlich/base/frame.hpp"
#include "wunderlich/base/summary.hpp"
#include "wunderlich/geometry/state.hpp"
#include "wunderlich/scene/scene.hpp"

namespace wunderlich::scene {

/// One recorded instant as states, enough to rebuild its Frame.
struct Record {
  std::vector<geometry::State> states;  ///< one a strip
  HistoryRow history;                   ///< sums and largest errors over all strips
};

enum class Outcome { converged, not_converged, interrupted };

/// Everything a checkpoint stores. `cursor` is the solver's own state, opaque to others.
struct Progress {
  std::vector<Record> records;
  std::vector<double> cursor;
};

struct RunResult {
  Outcome outcome = Outcome::not_converged;
  Summary summary;
  Progress progress;
};

/// Called after each step; returns false to stop (Ctrl-C).
struct RunStatus {
  std::string phase;    ///< "bend", "twist", "close", "load", "settle"
  double fraction = 0;  ///< of the path, in [0, 1]
  int iterations = 0;   ///< Newton iterations so far
};
using Observer = std::function<bool(const RunStatus&)>;

/// Throws InputError where the strip starts inside a solid. Not part of reading a scene:
/// it takes a look at the strip.
void check_start(const Scene& scene);

/// Runs from the start, or goes on from `resume`. Does no I/O. Deterministic: a resumed run ends bit for bit
/// as an uninterrupted one.
RunResult run(const Scene& scene, const Observer& observer, const Progress* resume = nullptr);

/// The strip whose state this is: one of `strips_of`, with the ends that are held then.
geometry::Ribbon ribbon_of(const Scene& strip, const geometry::State& state);

/// The exporter's view of a record. Several strips are one surface in parts, told apart by its field `ribbon`.
Frame frame_of(const Scene& scene, const Record& record);
std::vector<FlatPattern> patterns_of(const Scene& scene, const Record& record);

/// The obstacles at these times.
std::vector<Body> bodies_of(const Scene& scene, const std::vector<double>& times);

}  // namespace wunderlich::scene
