#include "transport/fixed_direct.h"

#include "base/error.h"

namespace troffer {

struct FixedDirect::Scratch final : DirectLightScratch {
  SourceSamplerScratch rays;
};

std::unique_ptr<DirectLightScratch> FixedDirect::make_scratch() const {
  return std::make_unique<Scratch>();
}

void FixedDirect::queue(WaveHits& wave, DirectLightScratch& scratch, RadianceBatch& out,
                        Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  CheckItems items;
  // Lights are the outer loop, so that rays from neighbouring hits to one source are adjacent.
  for (uint32_t light = 0; light < sampler_.lights(); ++light) {
    if (sampler_.is_empty(light)) continue;
    for (size_t i = 0; i < wave.size(); ++i) {
      const Bsdf& bsdf = wave.bsdfs[i];
      if (is_purely_delta(bsdf)) continue;
      items.at(wave.walks[i].index);
      // glossy surfaces also follow their own lobe
      const bool is_matte = is_lambertian(bsdf, nullptr);
      const SampledVertex at{wave.walks[i], wave.vertices[i], is_matte ? &bsdf : nullptr,
                             is_matte ? nullptr : &bsdf, bsdf.has_transmission};
      sampler_.sample(at, light, shadow_rays_, s.rays, out, counters);
    }
  }
}

void FixedDirect::flush(DirectLightScratch& scratch, RadianceBatch& out, Counters& counters) const {
  sampler_.resolve(static_cast<Scratch&>(scratch).rays, out, counters);
}

void FixedDirect::weigh(SeenEmission& seen) const {
  for (size_t i = 0; i < seen.size(); ++i)
    seen.weights[i] =
        seen.vertices[i] == nullptr
            ? sampler_.miss_weight(*seen.walks[i], seen.at_infinity[i], shadow_rays_)
            : sampler_.emission_weight(*seen.walks[i], *seen.vertices[i], shadow_rays_);
}

}  // namespace troffer
