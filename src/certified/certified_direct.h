// Direct light by certified visibility: the structure of the method of 1992 with shadow flags that
// are proved.
//
// Hits of a batch are treated together for every source (certified_lights.h), without rays but
// where no list of facets is complete; lights at infinity are sources among others. A fixed number
// of shadow rays (source_sampler.h) does points, spots and distant lights, and rough surfaces that
// transmit.
// Unbiased. Hits are clustered, and found occluders are remembered within a batch: the noise of the
// result, though not its mean, depends on what is in the batch. References: docs/certified.md.
#pragma once

#include <memory>

#include "certified/certified_lights.h"
#include "transport/direct_light.h"
#include "transport/source_sampler.h"

namespace troffer {

struct CertifiedSettings {
  CertifiedOptions estimator;
  double error = 0.01;     // allowed, relative to unoccluded light
  int shadow_rays = 64;    // per source and viewing ray where there are no certificates
  int gloss_samples = 32;  // points of a source at which gloss and textures are looked at
  int viewing_rays = 1;    // of a pixel, which share what is drawn
  int draws = 0;           // points of near lights from each hit, in place of certificates; 0: none
  int matte_times = 1;     // … so many times as many where no hit of a cluster is glossy
};

// Settings for an allowed standard error of a viewing ray's direct light, relative to what its
// sources would send unoccluded, in a scene of so many lights. Points drawn from many lights err by
// so much for all viewing rays of a pixel together.
CertifiedSettings certified_settings(double error, size_t lights, int viewing_rays = 1);

class CertifiedDirect final : public DirectLight {
 public:
  // occluders: of the scene.
  CertifiedDirect(const PreparedScene& scene, std::shared_ptr<const Occluders> occluders,
                  const CertifiedSettings& settings);

  std::unique_ptr<DirectLightScratch> make_scratch() const override;
  WalkedPart walked_part() const override { return WalkedPart::specular; }
  bool tells_variance() const override { return true; }
  void begin(const SampleRequest& request, DirectLightScratch& scratch) const override;
  void queue(WaveHits& wave, DirectLightScratch& scratch, RadianceBatch& out,
             Counters& counters) const override;
  void flush(DirectLightScratch& scratch, RadianceBatch& out, Counters& counters) const override;
  void weigh(SeenEmission& seen) const override;

 private:
  struct Scratch;

  CertifiedOptions options_for(const SampleRequest& request) const;
  void queue_hit(const WaveHits& wave, size_t i, Scratch& s, RadianceBatch& out,
                 Counters& counters) const;
  float weight_of(const Walk& walk, const Vertex& v) const;
  float weight_against(const CertifiedSource& source, const Walk& walk) const;
  float weight_of_miss(const Walk& walk, uint32_t primitive) const;

  const PreparedScene& scene_;
  std::shared_ptr<const Occluders> occluders_;
  CertifiedSettings settings_;
  CertifiedLights lights_;
  SourceSampler sampler_;
  // Lights that get rays of their own: on opaque surfaces, and where light goes through.
  std::vector<uint32_t> at_opaque_, at_transmitting_;
};

}  // namespace troffer
