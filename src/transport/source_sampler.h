// A fixed number of Owen-Sobol shadow rays from a vertex to a source, spread over the source by
// solid angle. FixedDirect samples all sources this way, certified light those without
// certificates.
#pragma once

#include <vector>

#include "base/random.h"
#include "transport/matte_rays.h"
#include "transport/walk.h"

namespace troffer {

// Shadow rays that wait to be traced, and memory for the samples of one source from one vertex.
struct SourceSamplerScratch {
  ShadowBatch shadows;
  SobolBlocks blocks, single;
  std::vector<uint32_t> primitives, order;
  std::vector<LightChoice> choices;
  std::vector<float> numbers, pmfs, u, v;
  std::vector<Vec3> receivers;
  std::vector<LightSample> points;
  std::vector<uint8_t> is_valid;
  LightSampleScratch lights;
  MatteRays matte;  // rays of matte surfaces
  LightPoints matte_points;

  void resize(size_t n);
  const SobolBlocks& blocks_of(uint32_t n);
};

// A vertex, and the parts of its BSDF that the rays illuminate.
struct SampledVertex {
  const Walk& walk;
  const Vertex& vertex;
  // Part that only these rays illuminate; may be null.
  const Bsdf* alone = nullptr;
  // Part that is also sampled by one BSDF sample, so that the power heuristic applies; may be null.
  const Bsdf* competing = nullptr;
  bool has_transmission = false;  // true if either part transmits
  bool is_direct = true;          // the light counts as direct
};

class SourceSampler {
 public:
  explicit SourceSampler(const PreparedScene& scene);

  uint32_t lights() const { return uint32_t(trees_.size()); }
  bool is_empty(uint32_t light) const { return trees_[light].is_empty(); }

  // Adds n shadow rays to a light that is not empty, or one to a delta light. Traces the rays, and
  // adds their light to `out`, when a batch is full.
  void sample(const SampledVertex& at, uint32_t light, uint32_t n, SourceSamplerScratch& s,
              RadianceBatch& out, Counters& counters) const;
  // Traces all rays that wait and adds their light to `out`.
  void resolve(SourceSamplerScratch& s, RadianceBatch& out, Counters& counters) const;

  // Returns the weight of emission that a walk has hit at v, against n shadow rays to that light
  // from the previous vertex; 1 if no sampling competes.
  float emission_weight(const Walk& walk, const Vertex& v, uint32_t n) const;
  // The same for a light at infinity that a walk sees as it leaves the scene.
  float miss_weight(const Walk& walk, uint32_t primitive, uint32_t n) const {
    return troffer::miss_weight(scene_, walk, primitive, float(n));
  }

 private:
  bool is_matte(const SampledVertex& at, uint32_t light) const;
  void sample_matte(const SampledVertex& at, uint32_t light, uint32_t n,
                    SourceSamplerScratch& s) const;
  bool choose_matte_points(const SampledVertex& at, uint32_t light, uint32_t n,
                           SourceSamplerScratch& s) const;
  uint32_t choose_pieces(const SampledVertex& at, uint32_t light, uint32_t n,
                         SourceSamplerScratch& s) const;
  uint32_t choose_points(const SampledVertex& at, uint32_t light, uint32_t n,
                         SourceSamplerScratch& s) const;

  const PreparedScene& scene_;
  std::vector<LightTree> trees_;  // per light, over its primitives
  std::vector<bool> is_delta_;    // per light
  std::vector<bool> is_even_;     // per light: all its primitives are surfaces of uniform radiance
};

}  // namespace troffer
