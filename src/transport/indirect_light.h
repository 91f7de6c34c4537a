// Light that has been reflected before, as a method computes it: the other of the two parts that a
// method chooses (direct_light.h). Without it a walk ends at the first rough surface.
#pragma once

#include <memory>

#include "transport/wave.h"

namespace troffer {

// Memory that one thread reuses from batch to batch.
struct IndirectLightScratch {
  virtual ~IndirectLightScratch() = default;
};

// Immutable; any number of threads may call it, each with a scratch of its own.
class IndirectLight {
 public:
  virtual ~IndirectLight() = default;
  virtual std::unique_ptr<IndirectLightScratch> make_scratch() const = 0;

  // Starts a batch: forgets what was learnt from another one. `request` holds until the next call.
  virtual void begin(const SampleRequest&, IndirectLightScratch&) const {}
  // What the hits' diffuse parts send on (SurfaceScattering::diffuse), as DirectLight::queue has
  // it; the specular parts are the walks'.
  virtual void queue(WaveHits& wave, IndirectLightScratch& scratch, RadianceBatch& out,
                     Counters& counters) const = 0;
  // Whether queue() wants wide gloss of first hits as well (SurfaceScattering::gather_gloss).
  virtual bool gathers_gloss() const { return false; }
  // Whether know() knows anything.
  virtual bool is_known() const { return false; }
  // Adds to out.known what first hits reflect, by what is at hand: no rays.
  virtual void know(const WaveHits&, RadianceBatch&) const {}
  virtual void flush(IndirectLightScratch& scratch, RadianceBatch& out,
                     Counters& counters) const = 0;

  // Adds one estimate of the indirect irradiance at each sensor to out.indirect.
  virtual void gather(const SensorBatch& sensors, IndirectLightScratch& scratch, RadianceBatch& out,
                      Counters& counters) const = 0;
};

}  // namespace troffer
