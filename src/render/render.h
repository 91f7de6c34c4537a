// Rendering of whole pictures. render() is the entry point of the library for pictures:
// preparation, tiles, passes, refinement, statistics, progress. Used by the commands, the viewer
// and the Python module. Radiance is linear RGB in the scene's units; sizes are in pixels.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "image/image.h"
#include "methods/methods.h"
#include "render/preparation.h"
#include "transport/batch.h"
#include "transport/prepared_scene.h"

namespace troffer {

class Checkpoint;
class ProcessGroup;
class Deadline;
class Preview;

// AOVs (arbitrary output variables) besides the picture.
// `sources` has three channels, each a number of sources at the first surface:
//   kj92: sampled by shadow rays, probed and visible, probed and hidden.
//   certified: neither proved lit nor dark, proved lit, proved dark.
// `viewing_error` is the standard error from the spread of a pixel's viewing rays. `error` is the
// method's own estimate where it has one.
enum class Aov {
  albedo,
  normal,
  depth,
  position,
  direct,
  indirect,
  shadow_rays,
  sources,
  error,
  viewing_error
};

struct RenderOptions {
  Method method = Method::certified;
  int spp = 4;  // viewing rays per pixel
  // Limit of viewing rays in a pixel. Refinement adds rays where neighbouring pixels differ. Values
  // from 1 to spp turn refinement off; 0 selects the method's limits (most_viewing_rays()).
  int max_spp = 0;
  int shadow_rays = 64;  // fixed: rays per source per viewing ray
  double error = 0.01;   // certified: see certified_settings
  Kj92Settings kj92;     // kj92: radiosity, source selection and shadow rays
  // Result of prepare(); null: render() prepares what is needed.
  const Preparation* preparation = nullptr;
  CellStore* cells = nullptr;  // certified: cells kept between pictures; may be null
  Preview* preview = nullptr;  // receives finished tiles; may be null
  // Called with the plan before anything is prepared; may be empty.
  std::function<void(const MethodPlan&)> planned;
  // Ends the work when its time is up; GapFiller then fills pixels without samples. Pass its
  // flag() to render() as `stop`. May be null.
  Deadline* deadline = nullptr;
  // Estimated error (RenderStatistics) at which the work is done; 0: no limit.
  double error_limit = 0;
  Checkpoint* checkpoint = nullptr;  // written, and continued if it was read; may be null
  int part = 1, parts = 1;           // share of the picture to render, counted from 1
  // Processes that render the same picture together. All have the same options, except
  // that only rank 0 may have a preview, a deadline or a checkpoint. Only rank 0's result is
  // complete. Without a deadline, pass the group's stop_flag() to render(). May be null.
  ProcessGroup* group = nullptr;
  // automatic: the method's way; for certified, cells or paths, whichever is cheaper.
  Indirect indirect = Indirect::cells;
  int depth = -1;             // path: most bounces; -1 = unlimited
  int width = 0, height = 0;  // 0 = by the camera
  bool has_crop = false;
  std::array<int, 4> crop{};  // x0, y0, x1, y1 in pixels of the whole image; x1, y1 exclusive
  int threads = 0;            // 0 = all cores
  uint64_t seed = 0;
  std::vector<Aov> aovs;
};

// Limits on the viewing rays of pixels. in_pixel: of one pixel. in_mean: on average over a tile, so
// that scattered highlights are refined but large glittering areas do not take longer. usual: the
// number of rays on which the footprint of texture lookups is based. All equal max_spp if it is
// given; otherwise they follow from the method and spp.
struct MostViewingRays {
  int in_pixel = 0, in_mean = 0, usual = 0;
};
MostViewingRays most_viewing_rays(const RenderOptions& options);

// Returns the method's settings for these options.
MethodSettings method_settings(const RenderOptions& options);

// Throws what render() would throw, before any work is done: UsageError for options that contradict
// each other or the scene, InputError for a camera whose numbers overflow.
void check_options(const PreparedScene& scene, const Camera& camera, const RenderOptions& options);

// Errors of pixels, estimated from the spread of their viewing rays as if these were independent.
struct ViewingErrors {
  double relative_rms = 0;  // standard error of a pixel over the picture's mean luminance
  // Share of pixels whose standard error exceeds 1 % of their luminance or of the mean, whichever
  // is more.
  double share_above = 0;
};

struct RenderStatistics {
  int width = 0, height = 0;
  Counters counters;     // work of viewing rays
  Counters preparation;  // work of cells, gathers and forecasts; this process's share
  ViewingErrors viewing_errors;
  // Root mean square of layer `error` over the mean luminance, as a display shows the picture:
  // picture_error() in film.h.
  double estimated_error = 0;
  double share_done = 0;        // share of the work, counted in tiles
  size_t gaps_filled = 0;       // pixels that a time limit left to GapFiller
  bool gaps_are_paths = false;  // they are path traced: there were no cells yet
  size_t unsampled = 0;         // pixels without a sample, after a stop
  // true if unsampled pixels show RenderOptions::preview, false if they are black
  bool shows_preview = false;
  double preprocess_seconds = 0;  // preparation, whether render() or its caller made it
  double render_seconds = 0;      // everything after it
  CellStatistics cells;           // empty if the method makes no cells
  bool is_by_paths = false;       // certified: paths replaced cells
  MethodPlan plan;                // decisions made before the preparation
};

// complete: all that was asked for. good_enough: RenderOptions::error_limit is met. out_of_time:
// RenderOptions::deadline was over. stopped: a stop was requested.
enum class RenderEnd { complete, good_enough, out_of_time, stopped };

// layers[0] is the picture, followed by the AOVs in the order asked for. After a stop or a deadline
// is_complete is false, and every pixel is the mean of its samples. Pixels without samples, which
// only a stop can leave, show the preview or black.
struct RenderResult {
  std::vector<Layer> layers;
  RenderStatistics statistics;
  RenderEnd end = RenderEnd::complete;
  bool is_complete = true;
  std::array<int, 4> window{};  // pixels that the layers hold, as in RenderOptions::crop
};

// Renders what `camera` sees. The result is bit-identical for any number of threads. Throws what
// check_options() throws.
RenderResult render(const PreparedScene& scene, const Camera& camera, const RenderOptions& options,
                    const ProgressCallback& progress, const StopFlag& stop);

}  // namespace troffer
