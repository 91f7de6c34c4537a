// Direct light by certified visibility: the structure of the 1992 method, with shadow flags that
// are proved.
//
// Hits of a batch are lit together (certified_lights.h), without shadow rays except where a facet
// list is incomplete. Environment lights are sources like others. Point, spot and distant lights,
// and rough transmitting surfaces, get a fixed number of shadow rays (source_sampler.h).
//
// Unbiased. Hits are clustered and found occluders are reused within a batch, so the noise of a
// result depends on the batch; its mean does not. References: docs/method/certified.md.
#pragma once

#include <memory>

#include "certified/certified_lights.h"
#include "transport/direct_light.h"
#include "transport/source_sampler.h"

namespace troffer {

// Accuracy and sample counts of CertifiedDirect; certified_settings() derives them from one error.
struct CertifiedSettings {
  CertifiedOptions estimator;
  double error = 0.01;     // allowed error, relative to unoccluded light
  int shadow_rays = 64;    // per source and viewing ray, where there are no certificates
  int gloss_samples = 32;  // points per source at which gloss and textures are evaluated
  int viewing_rays = 1;    // per pixel; they share the light samples
  int draws = 0;  // light samples per hit that may replace certificates of few lights; 0: none
  int matte_draw_factor = 1;  // factor on `draws` for clusters without glossy hits
};

// Returns settings for a standard error of a viewing ray's direct light, relative to the unoccluded
// light of all sources. `lights`: number of lights in the scene. For sampled lights, the error is
// that of all viewing rays of a pixel together.
CertifiedSettings certified_settings(double error, size_t lights, int viewing_rays = 1);

class CertifiedDirect final : public DirectLight {
 public:
  // occluders: those of `scene`, which must outlive this object.
  CertifiedDirect(const PreparedScene& scene, std::shared_ptr<const Occluders> occluders,
                  const CertifiedSettings& settings);

  std::unique_ptr<DirectLightScratch> make_scratch() const override;
  WalkedPart walked_part() const override { return WalkedPart::specular; }
  bool estimates_variance() const override { return true; }
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
  // Lights that get shadow rays of their own: at opaque hits, and at transmitting ones.
  std::vector<uint32_t> at_opaque_, at_transmitting_;
};

}  // namespace troffer
