// Indirect light from the radiosity preprocessing: the general value at the hit's place. The light
// of patches that the selection took out of that value is added by the method's direct light
// (bintree_direct.h). The result is as accurate as the solution.
#pragma once

#include <memory>

#include "kj92/radiosity_light.h"
#include "transport/indirect_light.h"

namespace troffer {

class RadiosityIndirect final : public IndirectLight {
 public:
  // The solution and the selection that `radiosity` holds belong to the scene.
  RadiosityIndirect(const PreparedScene& scene, const RadiosityLight& radiosity)
      : scene_(scene), radiosity_(radiosity) {}

  std::unique_ptr<IndirectLightScratch> make_scratch() const override;
  void queue(WaveHits& wave, IndirectLightScratch& scratch, RadianceBatch& out,
             Counters& counters) const override;
  void flush(IndirectLightScratch&, RadianceBatch&, Counters&) const override {}
  // One cosine-distributed ray per sample reads the radiosity of the surface that it hits.
  void gather(const SensorBatch& sensors, IndirectLightScratch& scratch, RadianceBatch& out,
              Counters& counters) const override;

 private:
  struct Scratch;

  const PreparedScene& scene_;
  RadiosityLight radiosity_;
};

}  // namespace troffer
