// Interface of direct light: light straight from sources. WaveIntegrator combines one
// DirectLight with at most one IndirectLight.
//
// A walk passes its hits to queue(), a few dozen at a time; flush() ends a wave. By then the light
// of the hits, times the walks' throughput, has been added to `out` at the walks' indices. One
// virtual call serves a few dozen hits.
#pragma once

#include <memory>

#include "transport/wave.h"

namespace troffer {

class MirrorImages;  // mirror_images.h

// Memory that one thread reuses from batch to batch.
struct DirectLightScratch {
  virtual ~DirectLightScratch() = default;
};

// The part of a surface's scattering that walks follow, in competition with the sampling of
// sources.
enum class WalkedPart : uint8_t {
  whole,     // all of it, unless the surface is Lambertian
  specular,  // mirror, gloss and transmission: SurfaceScattering::specular
};

// Immutable and thread-safe; each thread needs its own scratch.
class DirectLight {
 public:
  virtual ~DirectLight() = default;
  virtual std::unique_ptr<DirectLightScratch> make_scratch() const = 0;
  virtual WalkedPart walked_part() const = 0;
  // True if queue() and flush() estimate RadianceBatch::direct_variance.
  virtual bool estimates_variance() const { return false; }

  // Mirror images whose lights are added to the diffuse part of surfaces; null if there are none.
  // Walks must not count emission that they meet by way of such a mirror.
  virtual std::shared_ptr<const MirrorImages> images() const { return nullptr; }

  // Starts a batch and drops what was learnt from the previous one. `request` must stay valid until
  // the next call.
  virtual void begin(const SampleRequest&, DirectLightScratch&) const {}
  virtual void queue(WaveHits& wave, DirectLightScratch& scratch, RadianceBatch& out,
                     Counters& counters) const = 0;
  virtual void flush(DirectLightScratch& scratch, RadianceBatch& out, Counters& counters) const = 0;

  // Sets seen.weights, which are 1 on entry, for emission that walks have hit. Each walk left a
  // vertex whose sources were sampled, by a lobe that is not a delta.
  virtual void weigh(SeenEmission& seen) const = 0;
};

}  // namespace troffer
