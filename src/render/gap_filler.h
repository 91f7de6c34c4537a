// Completes a picture that ran out of time: path traces the pixels that have no sample yet. The
// result is unbiased but noisy. Used by render() and the preview.
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

  // Returns the seconds that a pixel takes at least, with all threads, measured by tracing some
  // rays through the window.
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
  std::unique_ptr<Integrator> paths_;
  std::vector<Work> work_;  // per thread
};

}  // namespace troffer
