// Light that was reflected before, at sensors, by path tracing (path.h): nothing is known
// beforehand, and nothing is biased. For pictures there is PathIntegrator.
#pragma once

#include <memory>
#include <utility>

#include "methods/path.h"
#include "transport/indirect_light.h"

namespace troffer {

class PathsIndirect final : public IndirectLight {
 public:
  // images: those whose light is somebody else's to count; null: none.
  PathsIndirect(const PreparedScene& scene, std::shared_ptr<const MirrorImages> images)
      : paths_(scene, {.leaves_out_direct_at_sensors = true, .images = std::move(images)}) {}

  std::unique_ptr<IndirectLightScratch> make_scratch() const override;
  // Not to be called: for sensors alone.
  void queue(WaveHits& wave, IndirectLightScratch& scratch, RadianceBatch& out,
             Counters& counters) const override;
  void flush(IndirectLightScratch& scratch, RadianceBatch& out, Counters& counters) const override;
  // By a path per sample.
  void gather(const SensorBatch& sensors, IndirectLightScratch& scratch, RadianceBatch& out,
              Counters& counters) const override;

 private:
  struct Scratch;

  PathIntegrator paths_;
};

}  // namespace troffer
