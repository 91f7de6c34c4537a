// Shadow rays for what lists of facets leave open: gathered over all sources of a cluster, then
// cast in numbers in proportion to what each could be wrong by.
//
// A pair of receiver and cell with open light W (weighted by brightness) that casts n rays has a
// variance of at most W²/4n, as a ray's answer is 0 or 1. For a receiver with an allowed standard
// error E the numbers n_i = W_i sum W / 4E² make the sum of these bounds E² with the fewest rays.
// A weak source's visible share is kept to a looser bound of its own. These are bounds on what rays
// add to the error of the samples that they go through; that of the samples is estimated.
// References: docs/certified.md, "Residual rays".
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/rgb.h"
#include "shadow/mask_points.h"
#include "shadow/shadow_scene.h"

namespace troffer {

// What rays to one source need to know of it.
struct RaySource {
  Vec3d point, normal;   // of its plane; flat sources only: normal towards the receivers
  double tolerance = 0;  // metres above the plane that still belong to it
  bool is_round = false;
  Vec3d centre;  // round: rays end where they first meet this sphere
  double radius = 0;
  uint64_t own = no_round_source;
  FoundFacets* found = nullptr;
  float brightness = 1;  // luminance of its radiance, for the numbers of rays
  uint32_t tag = 0;      // the caller's
};

// What rays of one receiver to one cell came to; adds to what masks and certificates gave.
struct RayAnswer {
  uint32_t member = 0, tag = 0, rays = 0;
  float light = 0;           // projected solid angle that they found open, sr
  float light_variance = 0;  // sr²
  Rgb value;                 // of an integrand
  float value_variance = 0;  // of its luminance
};

struct RayLimits {
  uint32_t most_rays = 256;        // of a receiver, for its allowed error
  float pair_error = 0.02f;        // allowed standard error of each source's visible share …
  uint32_t most_pair_rays = 64;    // … unless that takes more rays than this,
  uint32_t most_share_rays = 512;  // or for all pairs of a receiver more than this
};

class ResidualRays {
 public:
  // Forgets everything; receivers: of the cluster.
  void begin(size_t receivers);
  bool is_empty() const { return pending_.empty() && chosen_.empty(); }

  // From now on rays go to this source.
  void set_source(const RaySource& source);
  // … to a cell with this frame.
  void set_frame(const MaskFrame& frame);

  // `light`, in sr, is open, of `unoccluded` of the whole source: a number of rays to be decided by
  // finish(). `random` is the receiver's and the cell's own.
  // passes > 1: one of so many masks of the pair, whose calls follow each other; those that found
  // nothing open may be left out.
  void add(uint32_t member, const Vec3& origin, const OpenSamples& samples, float light,
           float unoccluded, uint64_t random, uint32_t passes = 1);
  // One ray to each of these points; `light` × the mean of the values of those that are free is the
  // answer.
  void add(uint32_t member, const Vec3& origin, std::span<const Vec3> points,
           std::span<const Rgb> values, float light);
  // From entry `first` on (see size()), multiplies light by factor[member].
  size_t size() const { return pending_.size(); }
  void scale(size_t first, std::span<const float> factor);

  // allowed[i]: standard error of receiver i, in brightness × sr. Facets that were met are noted
  // with their sources; the `most_found` most hit are kept.
  std::span<const RayAnswer> finish(ShadowScene& scene, std::span<const float> allowed,
                                    const RayLimits& limits, size_t most_found);

 private:
  struct Pending {
    uint32_t member, source, frame;
    Vec3 origin;
    float light, unoccluded;
    uint64_t random;
    uint32_t passes;
    OpenSamples samples;
  };
  struct Chosen {
    uint32_t member, source, first, count;
    float light;
  };
  struct Group {
    uint32_t source, first, count;  // segments
    uint32_t answer, frame, passes;
    bool has_values;
    float light;
  };
  void add_segments(const Vec3& origin, const RaySource& source, std::span<const Vec3> points);
  void cast_pending(std::span<const float> allowed, const RayLimits& limits);
  void cast_chosen();
  void trace(ShadowScene& scene);
  void trace_without_names(ShadowScene& scene);
  bool is_free(const RaySource& source, const ShadowSegment& segment, const ShadowHit& hit,
               const ShadowScene& scene) const;
  struct Tally;
  std::vector<Tally> look_at_hits(const ShadowScene& scene);
  void add_light(const Group& group, const Tally& tally);
  void tell_passes(size_t first_group);
  void add_value(const Group& group, size_t first_value);
  void add_up(const ShadowScene& scene);

  std::vector<RaySource> sources_;
  std::vector<MaskFrame> frames_;
  std::vector<Pending> pending_;
  std::vector<Chosen> chosen_;
  std::vector<Vec3> chosen_points_, chosen_origins_;
  std::vector<Rgb> chosen_values_;
  size_t receivers_ = 0;

  std::vector<float> open_;        // per receiver: sum of brightness × light
  std::vector<float> for_shares_;  // per receiver: rays wanted for visible shares
  std::vector<Vec3> points_;
  std::vector<ShadowSegment> segments_;
  std::vector<ShadowHit> hits_;
  std::vector<uint8_t> is_free_;
  enum class RayState : uint8_t { open, free, hidden };  // open: what it meets has a name
  std::vector<RayState> state_;
  std::vector<uint32_t> picked_;  // indices of segments that go into one call
  std::vector<ShadowSegment> picked_segments_;
  std::vector<ShadowHit> picked_hits_;
  std::vector<float> before_;
  std::vector<uint8_t> is_hidden_, has_rim_;
  std::vector<Group> groups_;
  std::vector<RayAnswer> answers_;
};

}  // namespace troffer
