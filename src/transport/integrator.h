// Interface of all methods that compute light. render/ makes one integrator per picture or list of
// points, and calls it with batches of viewing rays or sensors from many threads. Radiance is in
// the scene's units, irradiance in W/m² per channel (lx in photometric scenes).
#pragma once

#include <memory>

#include "transport/batch.h"
#include "transport/prepared_scene.h"

namespace troffer {

// Memory that one thread reuses from batch to batch.
struct IntegratorScratch {
  virtual ~IntegratorScratch() = default;
};

// Adaptive sampling of pixels for an integrator whose viewing rays are cheap and noisy. The default
// means that the method's usual sampling applies.
struct PixelSampling {
  int first = 0;     // viewing rays of a pixel after which its noise is estimated
  int most = 0;      // viewing rays of a pixel at most
  double error = 0;  // relative error at which sampling stops (allowed_error())
  // Convergence of stratified samples: the mean of n viewing rays of a pixel has the variance of
  // about n^(1 + evenness) independent ones.
  double evenness = 0;
  double proportion = 0;  // of the picture (allowed_error.h); 0: each pixel reaches its own error
  double typical = 0;     // usual luminance of the picture (allowed_error.h); 0: not known
  bool is_by_noise() const { return most > 0; }
};

// Computes radiance and irradiance; one virtual call per batch. Immutable and thread-safe; each
// thread needs its own scratch. Results depend only on rays, streams and samples. They do not
// depend on how rays are cut into batches, unless a method says so (kj92).
class Integrator {
 public:
  virtual ~Integrator() = default;
  virtual std::unique_ptr<IntegratorScratch> make_scratch() const = 0;
  // Adds to `out`, which has been reset to rays.size().
  virtual void radiance(const ViewingRays& rays, IntegratorScratch& scratch, RadianceBatch& out,
                        Counters& counters) const = 0;
  virtual PixelSampling sampling() const { return {}; }
  // Another integrator of the same light whose viewing rays are cheaper and noisier, for further
  // viewing rays of a pixel; null if there is none.
  virtual const Integrator* cheaper() const { return nullptr; }
  // True if surrogate_radiance() is implemented (KnownRadiance).
  virtual bool has_surrogates() const { return false; }
  // Adds known radiance to out.known, which has size rays.size(). Other members of
  // `out` have no meaning afterwards.
  virtual void surrogate_radiance(const ViewingRays&, IntegratorScratch&, RadianceBatch&,
                                  Counters&) const {}
  // Adds one estimate of the irradiance at each point, W/m² per channel, to out.direct and
  // out.indirect. `out` has been reset to sensors.size().
  virtual void irradiance(const SensorBatch& sensors, IntegratorScratch& scratch,
                          RadianceBatch& out, Counters& counters) const = 0;
};

}  // namespace troffer
