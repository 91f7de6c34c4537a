// Direct light by a fixed number of shadow rays to every source, at Owen-scrambled Sobol points.
// This is classical distribution ray tracing, the baseline of the comparisons. Unbiased.
//
// Diffuse surfaces use shadow rays alone. Glossy ones also use the walk, which is one sample of
// their own lobe; the power heuristic combines both.
#pragma once

#include "transport/direct_light.h"
#include "transport/source_sampler.h"

namespace troffer {

class FixedDirect final : public DirectLight {
 public:
  // shadow_rays: per source and viewing ray; powers of two are stratified best.
  FixedDirect(const PreparedScene& scene, int shadow_rays)
      : sampler_(scene), shadow_rays_(uint32_t(shadow_rays)) {}

  std::unique_ptr<DirectLightScratch> make_scratch() const override;
  WalkedPart walked_part() const override { return WalkedPart::whole; }
  void queue(WaveHits& wave, DirectLightScratch& scratch, RadianceBatch& out,
             Counters& counters) const override;
  void flush(DirectLightScratch& scratch, RadianceBatch& out, Counters& counters) const override;
  void weigh(SeenEmission& seen) const override;

 private:
  struct Scratch;

  SourceSampler sampler_;
  uint32_t shadow_rays_;
};

}  // namespace troffer
