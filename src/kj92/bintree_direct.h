// Direct light of `--method kj92`: adaptive shadow rays to the sources selected for the hit's
// patch, plus the direct part of the general radiosity for all other lights. Selected sources may
// be bright patches, whose light counts as indirect. Rough gloss is sampled by shadow rays and by
// the walk, combined by multiple importance sampling.
// Biased by design: rays depend on earlier results, and probe rays may miss what the preprocessing
// missed. Patterns are reused from hit to hit and forgotten at the start of a batch. The result
// therefore depends on the content of the batch and its order.
// References: [1] Kok & Jansen, "Adaptive Sampling of Area Light Sources in Ray Tracing Including
//   Diffuse Interreflection", Eurographics '92.
#pragma once

#include <memory>
#include <vector>

#include "kj92/radiosity_light.h"
#include "kj92/tree_sampling.h"
#include "transport/direct_light.h"

namespace troffer {

// Thread safe: each thread uses its own scratch.
class BintreeDirect final : public DirectLight {
 public:
  // `radiosity` holds the solution and the selection of the same scene.
  BintreeDirect(const PreparedScene& scene, const RadiosityLight& radiosity,
                const TreeSamplingOptions& options);

  std::unique_ptr<DirectLightScratch> make_scratch() const override;
  WalkedPart walked_part() const override { return WalkedPart::specular; }
  void begin(const SampleRequest& request, DirectLightScratch& scratch) const override;
  // Adds direct light at the hits. Stores the patch of each hit in its walk, for weigh().
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
  std::vector<TreatedSource> everywhere_;  // all lights, as probed sources: for hits off the mesh
};

}  // namespace troffer
