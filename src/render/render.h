// The whole image: tiles, passes, statistics, progress. The façade of the library.
#pragma once

#include <array>
#include <cstdint>
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

// AOVs that an image can carry besides the picture.
// sources: how many sources were sampled by shadow rays; probed and found visible; probed and found
// hidden (kj92). certified: neither proved lit nor dark; proved lit; proved dark.
// viewing_error: by the spread of the pixel's viewing rays, where `error` may stand for less.
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
  // Where neighbouring pixels differ the picture is refined by further viewing rays, up to so many
  // in a pixel; at most spp: nowhere; 0: as most_viewing_rays() says.
  int max_spp = 0;
  int shadow_rays = 64;  // fixed: rays per source per viewing ray
  double error = 0.01;   // certified: see certified_settings
  Kj92Settings kj92;     // certified: the radiosity of its indirect light
  // Made beforehand by prepare(); null: made by render(), where it is needed.
  const Preparation* preparation = nullptr;
  CellStore* cells = nullptr;  // certified: kept from before, and kept for later; may be null
  Preview* preview = nullptr;  // gets what is finished, tile by tile; may be null
  // The work is broken off at its time, and what is missing of the picture made by paths; the stop
  // flag of render() must be its own. May be null.
  Deadline* deadline = nullptr;
  // The work is done when the picture's told error (RenderStatistics) is at most this; 0: as told.
  double error_limit = 0;
  Checkpoint* checkpoint = nullptr;  // is written, and gone on from; may be null
  int part = 1, parts = 1;           // the part-th of so many shares of the picture, from 1
  // Other processes that call render() for the same picture, all of them alike but for preview,
  // deadline and checkpoint, which are rank 0's, as the result is: that of others is not whole. The
  // stop flag of these must be the crew's. May be null.
  ProcessGroup* group = nullptr;
  // automatic: cells, or paths where these take less.
  Indirect indirect = Indirect::cells;
  int depth = -1;             // path: most bounces; -1 = unlimited
  int width = 0, height = 0;  // 0 = by the camera
  bool has_crop = false;
  std::array<int, 4> crop{};  // x0, y0, x1, y1 in pixels of the whole image; x1, y1 exclusive
  int threads = 0;            // 0 = all cores
  uint64_t seed = 0;
  std::vector<Aov> aovs;
};

// The most viewing rays that a pixel may get; that pixels of a tile may get in the mean, so that
// what glitters here and there is refined, and all that glitters takes no longer; that a pixel is
// taken to get where textures are filtered. All are max_spp where it was given, else as many as the
// method takes by itself (MethodRow::refinement).
struct MostViewingRays {
  int in_pixel = 0, in_mean = 0, usual = 0;
};
MostViewingRays most_viewing_rays(const RenderOptions& options);

// What the options say about the method.
MethodSettings method_settings(const RenderOptions& options);

// UsageError for options that contradict each other or the scene, InputError for a camera whose
// numbers overflow: what render() would throw, before any work is done.
void check_options(const PreparedScene& scene, const Camera& camera, const RenderOptions& options);

// What the spread of the viewing rays says about the pixels' luminances, as of independent samples.
struct ViewingErrors {
  double relative_rms = 0;  // standard error of a pixel, over the picture's mean luminance
  // Of the pixels: with a standard error over 1 % of their luminance, or of the mean if that is
  // more.
  double share_above = 0;
};

struct RenderStatistics {
  int width = 0, height = 0;
  Counters counters;
  ViewingErrors viewing_errors;
  // What the layer `error` says of all pixels together: root of their mean square, over the
  // picture's mean luminance.
  double estimated_error = 0;
  double share_done = 0;          // of the work, by tiles
  size_t gaps_filled = 0;         // pixels that a time limit left to GapFiller
  bool gaps_are_paths = false;    // they are path traced: there were no cells yet
  size_t unsampled = 0;           // pixels without a sample, where a stop was requested
  bool shows_preview = false;     // these show RenderOptions::preview; else they are black
  double preprocess_seconds = 0;  // of the preparation, whoever made it
  double render_seconds = 0;      // of what came after
  CellStatistics cells;           // none where the method makes none
  bool is_by_paths = false;       // certified: paths took the place of cells
};

// complete: all that was asked for; good_enough: RenderOptions::error_limit is kept; out_of_time:
// RenderOptions::deadline was over; stopped: a stop was requested.
enum class RenderEnd { complete, good_enough, out_of_time, stopped };

// layers[0] is the picture; then the AOVs in the order asked for. Where a stop was requested, or
// time was over, is_complete is false and every pixel is the mean of the samples it has (without
// any, which happens only where a stop was requested, the preview, or black).
struct RenderResult {
  std::vector<Layer> layers;
  RenderStatistics statistics;
  RenderEnd end = RenderEnd::complete;
  bool is_complete = true;
  std::array<int, 4> window{};  // the pixels that the layers hold, as RenderOptions::crop
};

// Renders what `camera` sees. The result is the same, bit for bit, for any number of threads.
// Throws what check_options() throws.
RenderResult render(const PreparedScene& scene, const Camera& camera, const RenderOptions& options,
                    const ProgressCallback& progress, const StopFlag& stop);

}  // namespace troffer
