// The radiosity preprocessing for a prepared scene: compute, save, load. The façade of radiosity/.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "radiosity/solver.h"
#include "render/render.h"
#include "transport/prepared_scene.h"

namespace troffer {

struct RadiosityResult {
  RadiositySolution solution;  // is_complete is false where a stop was requested
  double seconds = 0;
};

// Throws UsageError for options that make no sense.
void check(const RadiosityOptions& options);

// Lights of the scene that the preprocessing leaves out, in words for a warning; empty: none. Their
// direct light is not touched by this, but what surfaces reflect of it is missing.
std::string lights_left_out(const Scene& scene);

// `progress` gets how far the unshot power is on its way down, by its logarithm, which falls about
// evenly: it cannot rise. The result does not depend on `threads` (0 = all cores).
RadiosityResult preprocess(const PreparedScene& scene, const RadiosityOptions& options, int threads,
                           const ProgressCallback& progress, const StopFlag& stop);

std::vector<uint8_t> save_radiosity(const PreparedScene& scene, const RadiositySolution& solution);

// From a file's bytes. `options`: those that it must have been computed with, or nullptr. Throws
// InputError, naming `file`, where it is no whole solution of this scene with these options.
RadiositySolution load_radiosity(const PreparedScene& scene, std::span<const uint8_t> bytes,
                                 const std::string& file, const RadiosityOptions* options,
                                 int threads);

}  // namespace troffer
