// Indirect light from the radiosity solution: the general radiosity at the hit. Light of selected
// patches is not part of it; BintreeDirect adds that (bintree_direct.h). The result is as accurate
// as the solution.
#pragma once

#include <memory>

#include "kj92/radiosity_light.h"
#include "transport/indirect_light.h"

namespace troffer {

// Thread safe: each thread uses its own scratch.
class RadiosityIndirect final : public IndirectLight {
 public:
  // `radiosity` holds the solution and the selection of the same scene.
  RadiosityIndirect(const PreparedScene& scene, const RadiosityLight& radiosity)
      : scene_(scene), radiosity_(radiosity) {}

  std::unique_ptr<IndirectLightScratch> make_scratch() const override;
  void queue(WaveHits& wave, IndirectLightScratch& scratch, RadianceBatch& out,
             Counters& counters) const override;
  void flush(IndirectLightScratch&, RadianceBatch&, Counters&) const override {}
  // Adds indirect light at sensors: one cosine-distributed ray per sample reads the radiosity of
  // the surface that it hits.
  void gather(const SensorBatch& sensors, IndirectLightScratch& scratch, RadianceBatch& out,
              Counters& counters) const override;

 private:
  struct Scratch;

  const PreparedScene& scene_;
  RadiosityLight radiosity_;
};

}  // namespace troffer
