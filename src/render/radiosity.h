// Radiosity preprocessing of a prepared scene: compute, save, load. The façade of radiosity/, used
// by the command radiosity and by the preparation of kj92. References: docs/method/radiosity.md.
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
  RadiositySolution solution;  // is_complete is false after a stop
  double seconds = 0;
};

// Throws UsageError for invalid options.
void check(const RadiosityOptions& options);

// Returns a warning about lights that the preprocessing leaves out, or an empty string. Their
// direct light is complete, but reflections of it are missing.
std::string lights_left_out(const Scene& scene);

// Solves the radiosity. `progress` follows the logarithm of the unshot power, which falls almost
// evenly and never rises. The result does not depend on `threads` (0 = all cores).
RadiosityResult preprocess(const PreparedScene& scene, const RadiosityOptions& options, int threads,
                           const ProgressCallback& progress, const StopFlag& stop);

std::vector<uint8_t> save_radiosity(const PreparedScene& scene, const RadiositySolution& solution);

// Reads a solution from a file's bytes. `options`: those that it must have been computed with, or
// nullptr. Throws InputError, naming `file`, if it is not a whole solution of this scene with these
// options.
RadiositySolution load_radiosity(const PreparedScene& scene, std::span<const uint8_t> bytes,
                                 const std::string& file, const RadiosityOptions* options,
                                 int threads);

}  // namespace troffer
