// What a picture would take by path tracing, from a look at a few thousand of its pixels; and
// whether that is less than the default's own way, by cells, would take (docs/cells.md, "Paths").
//
// Work is counted in rays, never in seconds: the same choice on every machine, for any number of
// threads and for every crop of the picture.
#pragma once

#include <cstdint>

#include "gather/gather_records.h"
#include "transport/integrator.h"
#include "transport/prepared_scene.h"

namespace troffer {

struct PathForecast {
  double viewing_rays = 0;  // of a pixel, on average, as many as the error asked for wants
  double rays = 0;          // of all kinds, for the whole picture
  double evenness = 0;      // PixelSampling
  // What else the picture would take that much for: cells' making, in rays. Negative: paths take
  // less than a picture by cells does even if cells cost nothing.
  double rays_for_cells = 0;
};

// error: asked of a pixel (allowed_error()); most: viewing rays that a pixel may have.
PathForecast forecast_paths(const PreparedScene& scene, const PictureView& view, double error,
                            int most, uint64_t seed, Counters& counters);

// How paths would sample the pixels of such a picture.
PixelSampling sampling_by_paths(const PathForecast& forecast, double error, int most);

// Making a cell takes as long as tracing so many rays of paths: at the least.
constexpr double rays_of_cell = 60;

}  // namespace troffer
