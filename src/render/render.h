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
// sources (kj92): numbers of sources sampled by shadow rays; probed and visible; probed and hidden.
// sources (certified): neither proved lit nor dark; proved lit; proved dark.
// viewing_error: standard error by the spread of the pixel's viewing rays; `error` may cover less.
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
  // Most viewing rays of a pixel, where refinement finds that neighbouring pixels differ. A number
  // up to spp turns refinement off; 0: as most_viewing_rays() says.
  int max_spp = 0;
  int shadow_rays = 64;  // fixed: rays per source per viewing ray
  double error = 0.01;   // certified: see certified_settings
  Kj92Settings kj92;     // certified: the radiosity of its indirect light
  // Result of prepare(); null: render() prepares what is needed.
  const Preparation* preparation = nullptr;
  CellStore* cells = nullptr;  // certified: cells from before, updated for later use; may be null
  Preview* preview = nullptr;  // receives finished tiles; may be null
  // Called with the plan before anything is prepared; may be empty.
  std::function<void(const MethodPlan&)> planned;
  // Ends the work when its time is over; paths then fill the missing pixels. The stop flag of
  // render() must be the deadline's own. May be null.
  Deadline* deadline = nullptr;
  // Estimated error (RenderStatistics) at which the work is done; 0: no limit.
  double error_limit = 0;
  Checkpoint* checkpoint = nullptr;  // written, and continued if it was read; may be null
  int part = 1, parts = 1;           // share of the picture to render, counted from 1
  // Processes that render the same picture together, with the same options except preview, deadline
  // and checkpoint. Those are rank 0's, as is the result; the results of other ranks are
  // incomplete. The stop flag must be the process group's. May be null.
  ProcessGroup* group = nullptr;
  // automatic: cells, or paths where these are cheaper.
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
// number for which textures are filtered. All equal max_spp if it is given; otherwise they follow
// from the method (MethodRow::refinement).
struct MostViewingRays {
  int in_pixel = 0, in_mean = 0, usual = 0;
};
MostViewingRays most_viewing_rays(const RenderOptions& options);

// Returns the method's settings for these options.
MethodSettings method_settings(const RenderOptions& options);

// Throws what render() would throw, before any work is done: UsageError for options that contradict
// each other or the scene, InputError for a camera whose numbers overflow.
void check_options(const PreparedScene& scene, const Camera& camera, const RenderOptions& options);

// Errors of pixels by the spread of their viewing rays, as if these were independent samples.
struct ViewingErrors {
  double relative_rms = 0;  // standard error of a pixel over the picture's mean luminance
  // Share of pixels whose standard error exceeds 1 % of their luminance or of the mean, whichever
  // is more.
  double share_above = 0;
};

struct RenderStatistics {
  int width = 0, height = 0;
  Counters counters;
  ViewingErrors viewing_errors;
  // Root mean square of layer `error` over the picture's mean luminance.
  double estimated_error = 0;
  double share_done = 0;        // share of the work, counted in tiles
  size_t gaps_filled = 0;       // pixels that a time limit left to GapFiller
  bool gaps_are_paths = false;  // they are path traced: there were no cells yet
  size_t unsampled = 0;         // pixels without a sample, after a stop
  // unsampled pixels show RenderOptions::preview; else they are black
  bool shows_preview = false;
  double preprocess_seconds = 0;  // of the preparation, wherever it was made
  double render_seconds = 0;      // of everything after it
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
