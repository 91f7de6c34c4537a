// Interface from certified visibility to the scene: facets in a shaft, and the first hit of a ray.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/box.h"
#include "base/quad.h"
#include "base/round_body.h"
#include "shadow/coverage_mask.h"
#include "shadow/shaft.h"

namespace troffer {

constexpr uint32_t ray_is_free = 0xffffffffu;
constexpr uint32_t ray_hit_non_facet = 0xfffffffeu;  // hit an occluder that is not a facet

// Marks segments without a round source of their own. A round source, by the scene's numbering,
// does not hide itself.
constexpr uint64_t no_round_source = ~0ull;

// Segment from a receiver, clear of its surface, to a point of a source.
struct ShadowSegment {
  Vec3 from, to;
  uint64_t own = no_round_source;
  float first = 0;  // share of the way that is known to be free
};

// Segments as separate coordinates: start, and vector to the end.
struct SegmentArrays {
  std::array<std::vector<float>, 3> from, way;

  size_t size() const { return from[0].size(); }
  void resize(size_t n) {
    for (auto* arrays : {&from, &way})
      for (std::vector<float>& a : *arrays) a.resize(n);
  }
  // Adds the first `share` of a segment.
  void add(const ShadowSegment& s, float share) {
    for (size_t a = 0; a < 3; ++a) {
      from[a].push_back(s.from[a]);
      way[a].push_back((s.to[a] - s.from[a]) * share);
    }
  }
};

// First hit of a segment: ray_is_free, ray_hit_non_facet, or the id of a facet, and its position.
struct ShadowHit {
  uint32_t id = ray_is_free;
  float t = 1;  // 0 at `from`, 1 at `to`
};

// Result of ShadowScene::candidates. is_front_only is set for facets of closed surfaces that
// contain neither end.
struct ShadowCandidates {
  std::vector<FacetToAdd> facets;
  std::vector<RoundBody> rounds;
  std::vector<Quad> masked;  // occluders that only rays can decide; all of them if is_masked_known
  bool is_masked_known = false;
  bool is_complete = true;   // nothing else can hide anything inside the shaft
  bool is_too_long = false;  // more facets exist: fewer receivers would help
};

// The scene as certified visibility sees it. Virtual calls are per cluster and source; of single
// rays only facet() is called, for hits. Implementations may keep memory between calls, so each
// thread has its own object.
class ShadowScene {
 public:
  virtual ~ShadowScene() = default;
  // Sets `out` to all facets, spheres and disks except `own` that may have a point inside all
  // planes, up to about `most` of each. Any other occluder makes the list incomplete.
  virtual void candidates(std::span<const Plane> planes, const Box& receivers, const Box& source,
                          size_t most, uint64_t own, ShadowCandidates& out) = 0;
  // Sets hits[i] to the first hit of segments[i], ignoring segments[i].own. Contact at the end
  // counts as free.
  virtual void trace(std::span<const ShadowSegment> segments, std::span<ShadowHit> hits) = 0;
  // Sets is_hidden[i] to 1 if anything lies on segment i. Cheaper than trace().
  virtual void occluded(const SegmentArrays& segments, std::span<uint8_t> is_hidden) = 0;
  virtual Quad facet(uint32_t id) const = 0;
  // Returns the largest absolute coordinate of all facets, metres.
  virtual double magnitude() const = 0;
};

}  // namespace troffer
