/// One run of a sweep.
#pragma once

#include <functional>

#include "wunderlich/scene/run.hpp"
#include "wunderlich/sweep/record.hpp"
#include "wunderlich/sweep/spec.hpp"

namespace wunderlich::sweep {

/// Keeps a run's folder; called where `sweep.keep` asks for it.
using Keep = std::function<void(const scene::Scene& scene, scene::RunResult& result, const std::string& key)>;

/// Runs it here and now. Never throws: what goes wrong is in the record.
Record execute(const Sweep& sweep, std::size_t run, const Keep& keep);

}  // namespace wunderlich::sweep
