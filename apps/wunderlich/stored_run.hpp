/// A run as it is kept: the scene and the recorded states in a checkpoint, and what exporters make of them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "wunderlich/io/checkpoint.hpp"
#include "wunderlich/io/formats.hpp"
#include "wunderlich/io/run_output.hpp"
#include "wunderlich/picture/style.hpp"
#include "wunderlich/scene/run.hpp"

namespace wunderlich::app {

/// What a checkpoint holds.
struct StoredRun {
  scene::Scene scene;
  scene::Progress progress;
  scene::Outcome outcome = scene::Outcome::not_converged;
};

io::Checkpoint to_checkpoint(const StoredRun& run);

/// Throws InputError that begins with `origin` if the checkpoint does not fit together.
StoredRun from_checkpoint(const io::Checkpoint& checkpoint, const std::string& origin);

/// The run kept in a run folder. Throws InputError if the folder is none.
StoredRun load_run(const std::filesystem::path& folder);

/// Throws InputError if a format needs what is not on this machine: ffmpeg for films. To be called before the work.
void require_tools(const std::vector<io::Format>& formats);

/// Everything that the run folder and the exports are made from, pictures in the style given; without the page's
/// template all but the page.
io::RunOutput output_of(const StoredRun& run, const Summary& summary, std::string_view report_template,
                        const picture::Style& style = {});

}  // namespace wunderlich::app
