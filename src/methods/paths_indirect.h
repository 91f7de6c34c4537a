// Indirect light at sensors by path tracing (path.h): unbiased, and without preparation. Used where
// measuring points take paths instead of cells (MethodSettings::measures_by_paths). Pictures by
// paths use PathIntegrator.
#pragma once

#include <memory>
#include <utility>

#include "methods/path.h"
#include "transport/indirect_light.h"

namespace troffer {

class PathsIndirect final : public IndirectLight {
 public:
  // images: mirrors whose light the direct light counts; null: none.
  PathsIndirect(const PreparedScene& scene, std::shared_ptr<const MirrorImages> images)
      : paths_(scene, {.leaves_out_direct_at_sensors = true, .images = std::move(images)}) {}

  std::unique_ptr<IndirectLightScratch> make_scratch() const override;
  // Must not be called: only sensors are served.
  void queue(WaveHits& wave, IndirectLightScratch& scratch, RadianceBatch& out,
             Counters& counters) const override;
  void flush(IndirectLightScratch& scratch, RadianceBatch& out, Counters& counters) const override;
  // Traces one path per sample.
  void gather(const SensorBatch& sensors, IndirectLightScratch& scratch, RadianceBatch& out,
              Counters& counters) const override;

 private:
  struct Scratch;

  PathIntegrator paths_;
};

}  // namespace troffer
