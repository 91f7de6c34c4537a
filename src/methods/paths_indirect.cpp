#include "methods/paths_indirect.h"

#include "base/error.h"

namespace troffer {

struct PathsIndirect::Scratch final : IndirectLightScratch {
  std::unique_ptr<IntegratorScratch> paths;
};

std::unique_ptr<IndirectLightScratch> PathsIndirect::make_scratch() const {
  auto scratch = std::make_unique<Scratch>();
  scratch->paths = paths_.make_scratch();
  return scratch;
}

void PathsIndirect::queue(WaveHits&, IndirectLightScratch&, RadianceBatch&, Counters&) const {
  TROFFER_CHECK(false);
}

void PathsIndirect::flush(IndirectLightScratch&, RadianceBatch&, Counters&) const {}

void PathsIndirect::gather(const SensorBatch& sensors, IndirectLightScratch& scratch,
                           RadianceBatch& out, Counters& counters) const {
  paths_.irradiance(sensors, *static_cast<Scratch&>(scratch).paths, out, counters);
}

}  // namespace troffer
