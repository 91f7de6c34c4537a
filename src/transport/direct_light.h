// Interface of direct light: light straight from sources. WaveIntegrator combines one
// DirectLight with at most one IndirectLight.
//
// The integrator passes the hits of walks to queue(), a few dozen per virtual call, and calls
// flush() at the end of each wave. When flush() returns, the light of all queued hits, times the
// walks' throughput, has been added to `out` at the walks' indices.
#pragma once

#include <memory>

#include "transport/wave.h"

namespace troffer {

class MirrorImages;  // mirror_images.h

// Memory that one thread reuses from batch to batch.
struct DirectLightScratch {
  virtual ~DirectLightScratch() = default;
};

// The part of a surface's scattering from which walks sample their next direction. Emission that
// they then hit is weighted against source sampling by MIS (weigh()).
enum class WalkedPart : uint8_t {
  whole,     // the whole BSDF; walks end at Lambertian surfaces
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

  // Starts a batch and drops state of the previous one, such as facets that rays have found.
  // `request` must stay valid until the next call.
  virtual void begin(const SampleRequest&, DirectLightScratch&) const {}
  virtual void queue(WaveHits& wave, DirectLightScratch& scratch, RadianceBatch& out,
                     Counters& counters) const = 0;
  virtual void flush(DirectLightScratch& scratch, RadianceBatch& out, Counters& counters) const = 0;

  // Sets seen.weights (1 on entry), the MIS weights of emission that walks have hit. Each of these
  // walks left its last vertex by a non-delta lobe, and sources were sampled there too.
  virtual void weigh(SeenEmission& seen) const = 0;
};

}  // namespace troffer
