/// What every kind of run keeps while it goes: records, times of steps, sums by phase. Internal to scene/.
#pragma once

#include <string>
#include <vector>

#include "wunderlich/base/stopwatch.hpp"
#include "wunderlich/base/summary.hpp"
#include "wunderlich/geometry/ribbon.hpp"
#include "wunderlich/scene/run.hpp"
#include "wunderlich/solver/equilibrium.hpp"

namespace wunderlich::scene {

inline constexpr int kMaxHalvings = 8;    ///< of a step that fails
inline constexpr int kRestingSteps = 20;  ///< below the speed of rest, before a motion is over

struct Recording {
  std::vector<Record> records;
  Timing timing;
  std::vector<double> step_us;

  void add_phase_time(const std::string& phase, double seconds);
  /// Median and 95th percentile of the steps so far, and the mean number of iterations.
  Timing finished(int steps, int iterations) const;
};

/// Keeps about `limit` records: when there are too many, every second one goes, but never the first or last.
void thin(std::vector<Record>& records, int limit);

/// What a summary says of the last record, whatever the method; of several strips the shape is the first one's.
Summary summary_of(const Scene& scene, const geometry::Ribbon& ribbon, const Record& last, Outcome outcome);

/// V l/(D w).
double normalized(const geometry::Ribbon& ribbon, double elastic);

/// Why a loop that its path has closed is not the one that was asked for; empty if it is. A closed band keeps its
/// linking number unless it passes through itself, which nothing here prevents.
std::string lost_turns(const solver::PathProblem& path, const solver::PathState& state, const geometry::State& shape);

/// Runs of one method each; see run().
RunResult run_path(const Scene& scene, const Observer& observer, const Progress* resume);
RunResult run_motion(const Scene& scene, const Observer& observer, const Progress* resume);

/// The strip whose state this is: a loop before it closes is the cut strip; a clamp that has let go leaves its end
/// without a frame of its own.
geometry::Ribbon path_ribbon(const Scene& scene, const geometry::State& state);
geometry::Ribbon motion_ribbon(const Scene& scene, double time);

}  // namespace wunderlich::scene
