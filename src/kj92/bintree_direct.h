// Direct light by the method of 1992: shadow rays, adaptively, to the sources that were selected
// for the hit's patch, and what the selection left in the general value of light straight from
// lights.
//
// The diffuse part of a surface is lit by both; rough gloss is sampled by rays to the lights as
// well as by the walk, and the two are combined. Selected sources may be bright patches, whose
// light is indirect. Biased by design: where rays go, and when they stop, depends on what rays
// found; what the preprocessing missed, probe rays may miss too. Patterns are reused from hit to
// hit in the order given and forgotten at the beginning of a batch: the result depends on what is
// in the batch, and in which order.
// References: [1] Kok & Jansen, "Adaptive Sampling of Area Light Sources in Ray Tracing Including
//   Diffuse Interreflection", Eurographics '92.
#pragma once

#include <memory>
#include <vector>

#include "kj92/radiosity_light.h"
#include "kj92/tree_sampling.h"
#include "transport/direct_light.h"

namespace troffer {

class BintreeDirect final : public DirectLight {
 public:
  // Solution and selection (of `radiosity`) belong to the scene.
  BintreeDirect(const PreparedScene& scene, const RadiosityLight& radiosity,
                const TreeSamplingOptions& options);

  std::unique_ptr<DirectLightScratch> make_scratch() const override;
  WalkedPart walked_part() const override { return WalkedPart::specular; }
  void begin(const SampleRequest& request, DirectLightScratch& scratch) const override;
  // Leaves in the walks, for weigh(), on which patch they were.
  void queue(WaveHits& wave, DirectLightScratch& scratch, RadianceBatch& out,
             Counters& counters) const override;
  void flush(DirectLightScratch&, RadianceBatch&, Counters&) const override {}
  void weigh(SeenEmission& seen) const override;

 private:
  struct Scratch;

  void shade(WaveHits& wave, size_t i, Scratch& s, RadianceBatch& out, Counters& counters) const;
  std::span<const TreatedSource> treated_at(const RadiosityPlace& place) const;
  uint32_t note_of(const SurfaceScattering& s, const RadiosityPlace& place) const;
  bool is_treated(uint32_t note, uint32_t light) const;

  const PreparedScene& scene_;
  RadiosityLight radiosity_;
  TreeSamplingOptions options_;
  std::vector<TreeSource> sources_;
  std::vector<uint32_t> index_of_source_;
  std::vector<TreatedSource> everywhere_;  // all lights, probed: off the mesh
};

}  // namespace troffer
