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

// Returns a path tracer for the light that the options ask for. Direct methods and `--indirect
// none` get direct light only.
std::unique_ptr<Integrator> paths_for(const PreparedScene& scene, const RenderOptions& options);

class GapFiller {
 public:
  // The arguments must outlive this object.
  GapFiller(const PreparedScene& scene, const ViewingCamera& camera, const RenderOptions& options);

  // Replaces the integrator from the next call on, and returns the one so far.
  std::unique_ptr<Integrator> use(std::unique_ptr<Integrator> other, bool is_by_paths);
  bool is_by_paths() const { return is_by_paths_; }

  // Seconds on all threads for the first samples of one pixel: measured here by some rays through
  // the window.
  double seconds_per_pixel(const PixelRect& window);

  // Fills the pixels of the window that have no samples, and returns their number. Each gets 4
  // samples, enough for an error estimate, and more while time is left. Only the deadline's
  // `parent` stops it before that.
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
