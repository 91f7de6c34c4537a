// Further viewing rays of a picture's pixels: what the first pass recorded about them, and how many
// rays each pixel gets after it. Used by Rendering; the rules for one pixel are in refinement.h.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "render/light_outlines.h"
#include "render/refinement.h"
#include "render/render.h"
#include "render/tile.h"
#include "transport/integrator.h"

namespace troffer {

// Samples of a pixel per batch. With a tile's pixels this gives about a thousand paths: long enough
// for ray packets, short enough for the second-level cache.
constexpr int samples_per_pass = 4;

// Plan of one pixel, as in checkpoints and messages: viewing rays in total if all are like the
// first ones (FurtherChoice), and surrogate samples.
struct WantedPixel {
  uint32_t samples, surrogates;
};

// Numbers of a tile's steps (tile_book.h) by kind, in this order: passes over the whole picture,
// surrogate samples, further rays.
struct TileSteps {
  uint32_t first = 0, surrogates = 0, further = 0;
  uint32_t all() const { return first + surrogates + further; }
};

// Mostly empty if pixels get no further rays. Thirteen members: the inputs, the limits, what the
// first pass recorded, and the plan.
class FurtherRays {
 public:
  // The arguments other than `plan` must outlive this object. plan: must stay in place.
  FurtherRays(const PreparedScene& scene, const ViewingCamera& camera, const Integrator& integrator,
              const RenderOptions& options, const TilePlan& plan);

  bool is_refined() const { return records_.has_value(); }
  double most_even() const { return double(options_.most_even); }
  int first_spp() const { return first_spp_; }
  const TileSteps& steps() const { return steps_; }
  // True if pixels get surrogate samples and corrections at the outlines of lamps.
  bool has_surrogates() const { return has_surrogates_; }
  // True if all further rays of a tile are traced in one step. Otherwise they come pass by pass,
  // because kj92 compares patterns of neighbours.
  bool are_at_once() const { return has_surrogates_ || options_.is_noise; }
  // Records of the first pass; empty if pixels are not refined.
  std::optional<PixelRecords>& records() { return records_; }
  const std::optional<PixelRecords>& records() const { return records_; }
  // True while the first pass stores records, with which refinement compares.
  bool is_recording() const { return records_ && !has_begun_; }
  const LightOutlines& outlines() const { return *outlines_; }

  // Decides the further rays of all pixels from the first pass, unless they are known. typical:
  // typical luminance of the picture.
  void decide(const Film& film, double typical);
  // Starts with no further rays: the leader of the process group sends the plans with each tile.
  void wait_for_leader();
  bool are_decided() const { return !wanted_.empty(); }
  // Ends the recording.
  void begin() { has_begun_ = true; }
  bool has_begun() const { return has_begun_; }

  size_t pixels() const { return records_->records.size(); }
  const WantedPixel& at(size_t i) const { return wanted_[i]; }
  const WantedPixel& at(int x, int y) const { return wanted_[records_->index(x, y)]; }
  void set(size_t i, const WantedPixel& w) { wanted_[i] = w; }
  // Takes over the plans of a checkpoint, one per pixel. Returns false if they are impossible.
  bool restore(std::vector<WantedPixel> wanted);

  // Returns the tiles ordered by the mean number of samples wanted, so that scarce time goes to the
  // noisiest.
  std::vector<size_t> noisiest_first() const;
  // Returns the error scale of each of `rays` rays of a pixel. Their mean still errs at most half
  // as much as that of the usual number. Powers of two let the rays of many pixels share batches.
  float error_scale(uint32_t rays) const;

 private:
  void decide_row(const RefinementView& view, int y);
  void limit_mean(const PixelRect& tile, int mean, uint32_t WantedPixel::*number);

  const PreparedScene& scene_;
  const ViewingCamera& camera_;
  const RenderOptions& render_;
  const TilePlan& plan_;
  int first_spp_;
  MostViewingRays most_;
  bool has_surrogates_ = false, has_begun_ = false;
  RefinementOptions options_;
  TileSteps steps_;
  std::optional<PixelRecords> records_;
  std::optional<const LightOutlines> outlines_;
  std::vector<WantedPixel> wanted_;  // per pixel of the region, row by row; empty: not decided
};

}  // namespace troffer
