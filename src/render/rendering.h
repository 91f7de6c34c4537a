// One picture in progress: passes over its tiles, then further rays where pixels need them. Used by
// render(). TileTracer traces rays, FurtherRays decides where more are needed, and RenderingArchive
// serializes the state. This class schedules the tiles' steps on threads and process groups.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include "base/parallel.h"
#include "render/camera.h"
#include "render/film.h"
#include "render/further_rays.h"
#include "render/progress.h"
#include "render/rendering_archive.h"
#include "render/tile.h"
#include "render/tile_book.h"
#include "render/tile_tracer.h"

namespace troffer {

// It has thirteen members because it owns the parts named above besides inputs and progress.
class Rendering {
 public:
  // Arguments other than camera and plan must outlive this object. Continues from
  // options.checkpoint if that has been read; throws InputError if its contents are impossible.
  Rendering(const PreparedScene& scene, const ViewingCamera& camera, const Integrator& integrator,
            const RenderOptions& options, TilePlan plan, const ProgressCallback& progress,
            const StopFlag& stop);

  // Sets the time that GapFiller needs for one pixel without samples. The deadline keeps back this
  // time for each such pixel of the window.
  void set_seconds_per_gap(double seconds_per_pixel);

  // Returns complete, good_enough, or stopped (by a request or a deadline).
  RenderEnd run();

  Film& film() { return film_; }

  // Results for the window, the part of the picture that was asked for (TilePlan).
  std::vector<Layer> layers() const;
  Counters counters() const;
  ViewingErrors viewing_errors() const;
  double estimated_error() const;  // as in RenderStatistics
  double share_done() const;

 private:
  struct Progress {
    std::mutex mutex;
    size_t tiles_done = 0;
    std::atomic<bool> was_stopped = false;
    size_t gaps = 0;  // pixels of the window without samples
    double seconds_per_gap = 0;
    // If true, all tiles finish a step before any begins the next. A limit can then end the work
    // with tiles of equal quality.
    bool is_stepwise = true;
  };
  using Tiles = std::vector<size_t>;
  // Does a step of a tile; returns false if it was stopped on the way.
  using Act = std::function<bool(uint32_t step, const PixelRect& tile, TileWork& work)>;
  struct StepSpan {
    uint32_t first = 0, end = 0;
  };

  void step(const StepSpan& steps, const Tiles& tiles, const Act& act);
  bool do_step(uint32_t number, size_t tile, size_t slot, const Act& act);
  bool is_good_enough(uint32_t step, const Tiles& later);
  bool is_limited() const { return options_.deadline != nullptr || options_.error_limit > 0; }
  RenderEnd first_pass();
  RenderEnd refine();
  RenderEnd refine_by_passes();
  RenderEnd refine_by_tiles();
  Tiles all_tiles() const;
  double typical_luminance();  // computed once
  double mean_luminance(const PixelRect& window) const;
  void restore();
  void tell_progress(size_t tile, uint32_t step);
  void save_in_time();
  // Within a process group. Each process has its own film; that of rank 0 receives all tiles.
  bool leads() const;
  void agree_on_limits();
  bool agree(bool value);
  void share_steps(const StepSpan& steps, const Tiles& tiles, const Act& act);
  void take_over(size_t tile, ByteReader in);
  void share_records();

  const ViewingCamera camera_;
  const RenderOptions& options_;
  const TilePlan plan_;
  Film film_;
  FurtherRays further_;
  TileTracer tracer_;
  std::vector<TileWork> work_;  // per thread
  TileBook book_;
  RenderingArchive archive_;
  std::optional<double> typical_;  // typical luminance of the picture
  const ProgressCallback& report_;
  Progress progress_;
  const StopFlag& stop_;
};

}  // namespace troffer
