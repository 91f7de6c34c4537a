// One picture under way: passes over its tiles, and refinement where pixels need it.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "integrate/integrator.h"
#include "render/camera.h"
#include "render/film.h"
#include "render/progress.h"
#include "render/refinement.h"
#include "render/tile.h"

namespace troffer {

// Samples of a pixel per batch: with a tile's pixels about a thousand paths, long enough for
// packets and short enough for the second-level cache.
constexpr int samples_per_batch = 4;

class Rendering {
 public:
  // All but camera and plan must outlive this.
  Rendering(const PreparedScene& scene, const ViewingCamera& camera, const Integrator& integrator,
            const RenderOptions& options, TilePlan plan, const ProgressCallback& progress,
            const StopFlag& stop);

  // False where a stop was requested.
  bool run();

  // Of the window.
  std::vector<Layer> layers() const;
  Counters counters() const;
  ViewingErrors viewing_errors() const;

 private:
  // Memory of one thread.
  struct Work {
    ViewingRays rays;
    RadianceBatch radiance;
    std::vector<Pixel2> pixels;  // of each ray
    std::unique_ptr<IntegratorScratch> scratch;
    Counters counters;
  };
  // What refinement knows; empty where pixels get no further rays.
  struct Refining {
    int first_spp = 0, max_spp = 0;
    RefinementOptions options;
    std::optional<PixelRecords> records;
    std::optional<double> typical;  // luminance
    bool has_begun = false;
    bool can_glance = false;
  };
  // By pixels of the region, row by row.
  struct FurtherRays {
    std::vector<int> samples, glances;  // in all
  };
  struct Progress {
    std::mutex mutex;
    size_t tiles_done = 0, tiles_in_all = 0;
  };
  // Adds the viewing rays that a tile is to get.
  using Fill = std::function<void(const PixelRect& tile, Work& work)>;

  static std::string name_of_ray(const void* work, size_t i);
  void pass(const Fill& fill);
  void add_rays(const Pixel2& p, uint32_t count, Work& w) const;
  void trace(Work& w);
  void refine();
  void refine(const std::vector<int>& wanted);
  void refine(const PixelRect& tile, const std::vector<int>& wanted, Work& w);
  FurtherRays further_rays(double typical) const;
  void glance(const std::vector<int>& wanted);
  void glance(const PixelRect& tile, const std::vector<int>& wanted, Work& w);
  // Not compared with neighbours' patterns, which come pass by pass.
  bool refines_at_once() const { return refining_.can_glance || refining_.options.is_noise; }
  double typical_luminance();  // looked at once
  double mean_luminance() const;
  void tell_progress(const PixelRect& tile);

  const PreparedScene& scene_;
  const ViewingCamera camera_;
  const Integrator& integrator_;
  const RenderOptions& options_;
  const TilePlan plan_;
  Film film_;
  std::vector<Work> work_;  // per thread
  Refining refining_;
  const ProgressCallback& report_;
  Progress progress_;
  const StopFlag& stop_;
  std::atomic<bool> was_stopped_ = false;
};

}  // namespace troffer
