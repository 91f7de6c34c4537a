// The scene as certified visibility uses it: candidate occluders from the facet hierarchy, and rays
// from the tracer.
#pragma once

#include <cstdint>
#include <vector>

#include "shadow/shadow_scene.h"
#include "trace/occluders.h"
#include "trace/tracer.h"

namespace troffer {

// Holds scratch memory: use one object per thread. The scene's structures must outlive it.
class ShadowWorld final : public ShadowScene {
 public:
  ShadowWorld(const Scene& scene, const Occluders& occluders, const Tracer& tracer);

  void candidates(std::span<const Plane> planes, const Box& receivers, const Box& source,
                  size_t most, uint64_t own, ShadowCandidates& out) override;
  void trace(std::span<const ShadowSegment> segments, std::span<ShadowHit> hits) override;
  void occluded(const SegmentArrays& segments, std::span<uint8_t> is_hidden) override;
  Quad facet(uint32_t id) const override { return occluders_.facet(id); }
  double magnitude() const override { return magnitude_; }
  // Hierarchy nodes visited by all calls of candidates(), for benchmarks.
  uint64_t visited_nodes() const { return visited_nodes_; }

 private:
  void set_rays(std::span<const ShadowSegment> segments);

  const Occluders& occluders_;
  const Tracer& tracer_;
  double magnitude_ = 0;
  uint64_t visited_nodes_ = 0;
  Occluders::Found found_;
  std::vector<Ray> rays_;
  Segments segments_;
  std::vector<Hit> hits_;
};

}  // namespace troffer
