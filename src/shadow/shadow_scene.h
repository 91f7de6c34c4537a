// What certified visibility asks of a scene: who stands in a shaft, and what a ray meets.
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
constexpr uint32_t ray_is_stopped = 0xfffffffeu;  // by what is no facet

// A round source among what is no facet, by the scene's own numbering: it does not hide itself.
constexpr uint64_t no_round_source = ~0ull;

// From a receiver, clear of its surface, to a point of a source.
struct ShadowSegment {
  Vec3 from, to;
  uint64_t own = no_round_source;
  float first = 0;  // what lies before, as a share of the way, is known to be free
};

// Segments coordinate by coordinate: where each begins, and the way to where it ends.
struct SegmentArrays {
  std::array<std::vector<float>, 3> from, way;

  size_t size() const { return from[0].size(); }
  void resize(size_t n) {
    for (auto* arrays : {&from, &way})
      for (std::vector<float>& a : *arrays) a.resize(n);
  }
  // The segment as far as `share` of its way.
  void add(const ShadowSegment& s, float share) {
    for (size_t a = 0; a < 3; ++a) {
      from[a].push_back(s.from[a]);
      way[a].push_back((s.to[a] - s.from[a]) * share);
    }
  }
};

// The first thing on a segment: ray_is_free, ray_is_stopped, or the id of a facet, and where.
struct ShadowHit {
  uint32_t id = ray_is_free;
  float t = 1;  // 0 at `from`, 1 at `to`
};

// is_front_only where a facet is part of a closed surface outside of which both ends lie.
struct ShadowCandidates {
  std::vector<FacetToAdd> facets;
  std::vector<RoundBody> rounds;
  std::vector<Quad> masked;  // what only rays can tell of, all of it where is_masked_known
  bool is_masked_known = false;
  bool is_complete = true;   // nothing else can hide anything inside the shaft
  bool is_too_long = false;  // there are more facets: fewer receivers, or less source, would help
};

// The scene as certified visibility sees it: a few virtual calls per cluster and source; for single
// rays none but facet(), of those that are stopped. It may keep memory between calls: one for each
// thread.
class ShadowScene {
 public:
  virtual ~ShadowScene() = default;
  // Sets `out` to all facets, spheres and disks but `own` that may have a point inside all planes,
  // at most about `most` of each. What is none of these makes the list incomplete.
  virtual void candidates(std::span<const Plane> planes, const Box& receivers, const Box& source,
                          size_t most, uint64_t own, ShadowCandidates& out) = 0;
  // hits[i]: the first thing on segments[i] but for segments[i].own, at which a segment ends free.
  virtual void trace(std::span<const ShadowSegment> segments, std::span<ShadowHit> hits) = 0;
  // is_hidden[i]: whether anything lies on segment i: cheaper.
  virtual void occluded(const SegmentArrays& segments, std::span<uint8_t> is_hidden) = 0;
  virtual Quad facet(uint32_t id) const = 0;
  // Largest absolute coordinate of all facets, metres.
  virtual double magnitude() const = 0;
};

}  // namespace troffer
