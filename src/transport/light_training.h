// Makes learned lights (select/learned_lights.h) from test paths: where paths scatter, a few light
// samples are tested by shadow rays. Used by the default method's paths.
#pragma once

#include <functional>
#include <memory>

#include "select/learned_lights.h"
#include "transport/prepared_scene.h"

namespace troffer {

// True if light samples may gain by learned lights: a few lights are at infinity, and one is not
// alone or is a sky whose directions can be told apart.
bool may_learn_lights(const PreparedScene& scene);

// Returns the lights that paths from these viewing rays learn. batch: returns the viewing rays of
// the i-th batch, whose streams must differ from all others. budget: cost of all work (costs.h);
// one batch is traced at least. The scene must outlive the result. Adds the rays to `counters`.
// Results do not depend on the number of threads.
std::shared_ptr<const LearnedLights> learn_lights(
    const PreparedScene& scene, const std::function<ViewingRays(uint32_t i)>& batch, double budget,
    int threads, Counters& counters);

}  // namespace troffer
