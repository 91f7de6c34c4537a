// Indirect light from the radiosity preprocessing: the general value of the hit's place, and, where
// the selection took bright patches out of it, their light with certified visibility
// (certified_patches.h). As good as the solution is.
#pragma once

#include <memory>

#include "integrate/certified_patches.h"
#include "integrate/indirect_light.h"
#include "integrate/radiosity_light.h"

namespace troffer {

class RadiosityIndirect final : public IndirectLight {
 public:
  // Solution and selection (of `radiosity`) belong to the scene. The light of selected patches is
  // for others to add.
  RadiosityIndirect(const PreparedScene& scene, const RadiosityLight& radiosity)
      : scene_(scene), radiosity_(radiosity) {}
  // It is added here. occluders: of the scene.
  RadiosityIndirect(const PreparedScene& scene, const RadiosityLight& radiosity,
                    std::shared_ptr<const Occluders> occluders, const CertifiedOptions& of_lights);

  std::unique_ptr<IndirectLightScratch> make_scratch() const override;
  void begin(IndirectLightScratch& scratch) const override;
  void queue(WaveHits& wave, IndirectLightScratch& scratch, RadianceBatch& out,
             Counters& counters) const override;
  void flush(IndirectLightScratch& scratch, RadianceBatch& out, Counters& counters) const override;
  // By one ray per sample, distributed by cosine, which takes the radiosity of the surface that it
  // meets.
  void gather(const SensorBatch& sensors, IndirectLightScratch& scratch, RadianceBatch& out,
              Counters& counters) const override;

 private:
  struct Scratch;

  const PreparedScene& scene_;
  RadiosityLight radiosity_;
  std::shared_ptr<const Occluders> occluders_;  // null: no light of patches
  CertifiedOptions patch_options_;
  CertifiedPatches patches_;
};

}  // namespace troffer
