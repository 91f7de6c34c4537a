// Interface of indirect light: light that has been reflected before it reaches a hit. The
// counterpart of DirectLight (direct_light.h). Without an IndirectLight, a walk ends at the first
// rough surface.
#pragma once

#include <memory>

#include "transport/wave.h"

namespace troffer {

// Memory that one thread reuses from batch to batch.
struct IndirectLightScratch {
  virtual ~IndirectLightScratch() = default;
};

// Immutable and thread-safe; each thread needs its own scratch.
class IndirectLight {
 public:
  virtual ~IndirectLight() = default;
  virtual std::unique_ptr<IndirectLightScratch> make_scratch() const = 0;

  // Starts a batch and drops what was learnt from the previous one. `request` must stay valid until
  // the next call.
  virtual void begin(const SampleRequest&, IndirectLightScratch&) const {}
  // Adds the indirect light that the diffuse parts of hits reflect (SurfaceScattering::diffuse),
  // under the same terms as DirectLight::queue. Walks account for the specular parts.
  virtual void queue(WaveHits& wave, IndirectLightScratch& scratch, RadianceBatch& out,
                     Counters& counters) const = 0;
  // True if queue() also takes the wide gloss of first hits (SurfaceScattering::gather_gloss).
  virtual bool gathers_gloss() const { return false; }
  // True if know() is implemented.
  virtual bool is_known() const { return false; }
  // Adds an approximation of the light that first hits reflect to out.known. Traces no rays.
  virtual void know(const WaveHits&, RadianceBatch&) const {}
  virtual void flush(IndirectLightScratch& scratch, RadianceBatch& out,
                     Counters& counters) const = 0;

  // Adds one estimate of the indirect irradiance at each sensor to out.indirect.
  virtual void gather(const SensorBatch& sensors, IndirectLightScratch& scratch, RadianceBatch& out,
                      Counters& counters) const = 0;
};

}  // namespace troffer
