// What every method of computing light offers to render/.
#pragma once

#include <memory>

#include "transport/batch.h"
#include "transport/prepared_scene.h"

namespace troffer {

// Memory that one thread reuses from batch to batch.
struct IntegratorScratch {
  virtual ~IntegratorScratch() = default;
};

// How the pixels of a picture are to be sampled by an integrator whose viewing rays cost little and
// differ much; nothing of it: as the method's are.
struct PixelSampling {
  int first = 0;     // viewing rays of a pixel by which its noise is judged
  int most = 0;      // … in all, wherever that is noisier than
  double error = 0;  // … this (allowed_error())
  // Means of n viewing rays of a pixel, which are spread evenly, have about the variance of
  // n^(1 + evenness) independent ones.
  double evenness = 0;
  bool is_by_noise() const { return most > 0; }
};

// One virtual call per batch, never per ray. Immutable: any number of threads may call radiance,
// each with a scratch of its own. The result depends on the rays, streams and samples alone, not
// on what a scratch was used for before; and not on how rays are cut into batches, unless a method
// says so (kj92).
class Integrator {
 public:
  virtual ~Integrator() = default;
  virtual std::unique_ptr<IntegratorScratch> make_scratch() const = 0;
  // Adds to `out`, which has been reset to rays.size().
  virtual void radiance(const ViewingRays& rays, IntegratorScratch& scratch, RadianceBatch& out,
                        Counters& counters) const = 0;
  virtual PixelSampling sampling() const { return {}; }
  // Whether there is anything known of radiance before light is sampled (KnownRadiance).
  virtual bool has_surrogates() const { return false; }
  // Adds that to out.known, of size rays.size(), and nothing else.
  virtual void surrogate_radiance(const ViewingRays&, IntegratorScratch&, RadianceBatch&,
                                  Counters&) const {}
  // Adds one estimate of the irradiance at each point, W/m² per channel, to out.direct and
  // out.indirect; `out` has been reset to sensors.size().
  virtual void irradiance(const SensorBatch& sensors, IntegratorScratch& scratch,
                          RadianceBatch& out, Counters& counters) const = 0;
};

}  // namespace troffer
