/// Runs other models than the ribbon on the same scene, side by side.
#pragma once

#include <string>
#include <vector>

#include "wunderlich/base/comparison.hpp"
#include "wunderlich/scene/run.hpp"

namespace wunderlich::scene {

enum class Model { ribbon, rod, shell_conforming, shell_nonconforming };

/// As the command line says it: "shell-conforming".
const char* model_name(Model model);

/// "ribbon,rod": each at most once, at least one. Throws InputError.
std::vector<Model> parse_models(const std::string& list);

/// The `failure` of a model that the observer ended.
inline constexpr const char* kInterrupted = "interrupted";

/// One model on the scene. What it cannot do of it, and where it did not get through, is the result's `failure`;
/// nothing is hidden. Throws nothing for that. An observer that returns false ends it: the result is then not
/// `converged`, with kInterrupted for a failure.
ModelResult run_model(const Scene& scene, Model model, const Observer& observer);

/// Throws InputError where the scene has several strips.
void check_comparable(const Scene& scene);

/// All of them, one after the other, with the scene's obstacles at their frames.
Comparison compare(const Scene& scene, const std::vector<Model>& models, const Observer& observer);

}  // namespace wunderlich::scene
