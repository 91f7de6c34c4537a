// Light straight from sources, as a method computes it: one of the two parts that a method chooses.
//
// A walk brings hits, a few dozen at a time, to queue(); flush() ends a wave. By then their light
// has been added to `out`, times the walks' throughput, at the walks' indices. One virtual call per
// few dozen hits, none per ray.
#pragma once

#include <memory>

#include "transport/wave.h"

namespace troffer {

class MirrorImages;  // mirror_images.h

// Memory that one thread reuses from batch to batch.
struct DirectLightScratch {
  virtual ~DirectLightScratch() = default;
};

// What is left to walks, which compete with the sampling of sources there.
enum class WalkedPart : uint8_t {
  whole,     // all that a surface scatters, where it is not Lambertian
  specular,  // mirrors, gloss, what transmits: SurfaceScattering::specular
};

// Immutable; any number of threads may call it, each with a scratch of its own.
class DirectLight {
 public:
  virtual ~DirectLight() = default;
  virtual std::unique_ptr<DirectLightScratch> make_scratch() const = 0;
  virtual WalkedPart walked_part() const = 0;
  // The variance of what is added is told (RadianceBatch::direct_variance).
  virtual bool tells_variance() const { return false; }

  // Images of lights in mirrors, whose light is added too, where a surface's diffuse part gets it:
  // walks that run into such a light by way of such a mirror do not count it. Null: none.
  virtual std::shared_ptr<const MirrorImages> images() const { return nullptr; }

  // Starts a batch: forgets what was learnt from another one. `request` holds until the next call.
  virtual void begin(const SampleRequest&, DirectLightScratch&) const {}
  virtual void queue(WaveHits& wave, DirectLightScratch& scratch, RadianceBatch& out,
                     Counters& counters) const = 0;
  virtual void flush(DirectLightScratch& scratch, RadianceBatch& out, Counters& counters) const = 0;

  // Weights of emission that walks have run into, all of which left a vertex whose sources were
  // sampled, by a lobe that is no delta: seen.weights, which are 1.
  virtual void weigh(SeenEmission& seen) const = 0;
};

}  // namespace troffer
