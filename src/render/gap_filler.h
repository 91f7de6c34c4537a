// Completes a picture whose time is up: pixels without samples get a few from a cheap integrator of
// the same light. That is the method's own quick integrator once its cells exist, else path tracing
// (unbiased and noisy).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/deadline.h"
#include "render/camera.h"
#include "render/film.h"
#include "render/tile.h"
#include "transport/integrator.h"

namespace troffer {

// Path tracing of the light that is asked for: `--indirect none` and direct methods, direct light.
std::unique_ptr<Integrator> paths_for(const PreparedScene& scene, const RenderOptions& options);

class GapFiller {
 public:
  // All must outlive this.
  GapFiller(const PreparedScene& scene, const ViewingCamera& camera, const RenderOptions& options);

  // Replaces path tracing, from the next call on.
  void use(std::unique_ptr<Integrator> quick);
  bool is_by_paths() const { return is_by_paths_; }

  // Seconds on all threads for the first samples of one pixel: measured here by some rays through
  // the window.
  double seconds_per_pixel(const PixelRect& window);

  // Fills pixels of the window that have no samples, and tells how many they were: with 4 each, so
  // that they tell their error, and more as time is left. Only a set `parent` of the deadline stops
  // it before that.
  size_t fill(Film& film, const PixelRect& window, const Deadline& deadline);

 private:
  struct Work {
    std::unique_ptr<IntegratorScratch> scratch;
    ViewingRays rays;
    RadianceBatch radiance;
    Counters counters;
  };
  void trace(const std::vector<Pixel2>& pixels, uint32_t first_sample, Film* film,
             const StopFlag& stop);

  const ViewingCamera& camera_;
  const RenderOptions& options_;
  std::unique_ptr<Integrator> integrator_;
  bool is_by_paths_ = true;
  std::vector<Work> work_;  // per thread
};

}  // namespace troffer
