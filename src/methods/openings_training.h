// Finds the openings through which the sky lights the scene (select/openings.h), by training paths
// from all over the picture.
#pragma once

#include <memory>

#include "gather/gather_records.h"
#include "methods/path_forecast.h"
#include "select/openings.h"
#include "transport/prepared_scene.h"

namespace troffer {

// Finds openings by paths that cost about `rays` (costs.h). f: the forecast of such paths without
// openings. Adds the rays to `counters`. Returns null if the scene has no sky, if little of its
// light is blocked, or if the paths found none.
std::shared_ptr<const Openings> find_openings(const PreparedScene& scene, const PictureView& view,
                                              const PathForecast& f, double rays, uint64_t seed,
                                              int threads, Counters& counters);

}  // namespace troffer
