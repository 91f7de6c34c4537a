// State of one picture in progress: passes over its tiles, then refinement where pixels need it.
// Used by render(). rendering_refinement.cpp holds refinement, rendering_state.cpp checkpoints,
// rendering_group.cpp process groups.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "render/camera.h"
#include "render/film.h"
#include "render/progress.h"
#include "render/refinement.h"
#include "render/tile.h"
#include "render/tile_book.h"
#include "transport/integrator.h"

namespace troffer {

// Samples of a pixel per batch. With a tile's pixels this gives about a thousand paths: long enough
// for ray packets, short enough for the second-level cache.
constexpr int samples_per_batch = 4;

// Thirteen members: the inputs, the picture, and its progress.
class Rendering {
 public:
  // Arguments other than camera and plan must outlive this object. Continues from
  // options.checkpoint if that has been read; throws InputError if its contents are impossible.
  Rendering(const PreparedScene& scene, const ViewingCamera& camera, const Integrator& integrator,
            const RenderOptions& options, TilePlan plan, const ProgressCallback& progress,
            const StopFlag& stop);

  // Sets the time that a pixel without rays will take to fill, for the deadline.
  void set_seconds_per_gap(double seconds_per_pixel);

  // Returns complete, good_enough, or stopped (by a request or a deadline).
  RenderEnd run();

  Film& film() { return film_; }

  // Results for the window.
  std::vector<Layer> layers() const;
  Counters counters() const;
  ViewingErrors viewing_errors() const;
  double estimated_error() const;  // as in RenderStatistics
  double share_done() const;

 private:
  // Memory of one thread.
  struct Work {
    ViewingRays rays;
    RadianceBatch radiance;
    std::vector<Pixel2> pixels;  // per ray
    std::unique_ptr<IntegratorScratch> scratch;
    Counters counters;  // of the current tile
  };
  // Plan of one pixel, as in checkpoints and messages: viewing rays in total, surrogate samples,
  // and the effort divisor of viewing rays after the first pass (SampleRequest::effort_divisor).
  struct WantedPixel {
    uint32_t samples, surrogates, effort_divisor;
  };
  // Plans of the region's pixels, row by row.
  struct FurtherRays {
    std::vector<int> samples, surrogates;
    std::vector<uint32_t> effort_divisor;
    // Starts with no further rays.
    FurtherRays(size_t pixels, int first)
        : samples(pixels, first), surrogates(pixels), effort_divisor(pixels, 1) {}
    WantedPixel at(size_t i) const {
      return {uint32_t(samples[i]), uint32_t(surrogates[i]), effort_divisor[i]};
    }
    void set(size_t i, const WantedPixel& w) {
      samples[i] = int(w.samples);
      surrogates[i] = int(w.surrogates);
      effort_divisor[i] = w.effort_divisor;
    }
  };
  // State of refinement; mostly empty if pixels get no further rays.
  struct Refining {
    int first_spp = 0;
    MostViewingRays most;
    RefinementOptions options;
    std::optional<PixelRecords> records;
    std::optional<const LightOutlines> outlines;
    std::optional<double> typical;  // typical luminance of the picture
    std::optional<FurtherRays> wanted;
    bool has_begun = false;
    // all tiles finish a step before the next, so that a limit may end the work
    bool is_stepwise = true;
    bool has_surrogates = false;
  };
  // Numbers of a tile's steps (tile_book.h) by kind, in this order: passes over the whole picture,
  // surrogate samples, further rays.
  struct Steps {
    uint32_t first = 0, surrogates = 0, further = 0;
    uint32_t all() const { return first + surrogates + further; }
  };
  struct Progress {
    std::mutex mutex;
    size_t tiles_done = 0;
    std::atomic<bool> was_stopped = false;
    size_t gaps = 0;  // pixels of the window without samples
    double seconds_per_gap = 0;
  };
  using Tiles = std::vector<size_t>;
  // Does a step of a tile; returns false if it was stopped on the way.
  using Act = std::function<bool(uint32_t step, const PixelRect& tile, Work& work)>;
  struct StepSpan {
    uint32_t first = 0, end = 0;
  };

  static std::string name_of_ray(const void* work, size_t i);
  void step(const StepSpan& steps, const Tiles& tiles, const Act& act);
  bool do_step(uint32_t number, size_t tile, size_t slot, const Act& act);
  bool is_good_enough(uint32_t step, const Tiles& later);
  bool is_limited() const { return options_.deadline != nullptr || options_.error_limit > 0; }
  void add_rays(const Pixel2& p, uint32_t count, Work& w) const;
  void trace(Work& w);
  Rgb edge_correction(const Work& w, size_t ray) const;
  bool trace_all(Work& w);
  RenderEnd refine();
  RenderEnd refine_by_passes();
  RenderEnd refine_by_tiles();
  bool refine(const PixelRect& tile, Work& w);
  float error_scale(int rays) const;
  Tiles all_tiles() const;
  Tiles noisiest_first() const;
  FurtherRays further_rays(double typical) const;
  void keep_in_bounds(const PixelRect& tile, int mean, std::vector<int>& wanted) const;
  void keep_in_bounds(const PixelRect& tile, FurtherRays& wanted) const;
  bool add_surrogates(const PixelRect& tile, Work& w);
  // True if all further rays of a tile are traced in one step. Otherwise they come pass by pass,
  // because kj92 compares patterns of neighbours.
  bool refines_at_once() const { return refining_.has_surrogates || refining_.options.is_noise; }
  double typical_luminance();  // computed once
  double mean_luminance(const PixelRect& window) const;
  void tell_progress(size_t tile, uint32_t step);
  void save_in_time();
  // Within a process group (rendering_group.cpp):
  bool leads() const;
  void agree_on_limits();
  bool agree(bool value);
  void share_steps(const StepSpan& steps, const Tiles& tiles, const Act& act);
  void save_for_group(size_t tile, std::vector<uint8_t>& out) const;
  void load_from_group(size_t tile, ByteReader& in);
  void take_over(size_t tile, ByteReader in);
  void brief(size_t tile, std::vector<uint8_t>& out) const;
  void take_brief(size_t tile, ByteReader in);
  void share_records();
  void save_tile(size_t tile, std::vector<uint8_t>& out) const;
  void save();
  void restore();
  bool restore_tile(ByteReader in);
  bool restore_wanted(ByteReader in);
  bool is_as_expected(uint32_t steps, int x, int y) const;

  const PreparedScene& scene_;
  const ViewingCamera camera_;
  const Integrator& integrator_;
  const RenderOptions& options_;
  const TilePlan plan_;
  Film film_;
  std::vector<Work> work_;  // per thread
  Refining refining_;
  Steps steps_;
  TileBook book_;
  const ProgressCallback& report_;
  Progress progress_;
  const StopFlag& stop_;
};

}  // namespace troffer
