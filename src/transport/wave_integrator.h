// Integrator made of walks, a DirectLight and an IndirectLight. All methods except path tracing use
// it.
//
// Viewing rays, and the rays that mirrors, glass and gloss spawn, are followed in waves:
//
//     walks → hits → vertices, or beyond the scene     trace/, vertex.h
//       → emission that they hit                       SeenEmission, DirectLight::weigh
//       → hits at which light is computed              WaveHits, a few dozen at a time
//       → light straight from sources                  DirectLight::queue
//       → light that was reflected before              IndirectLight::queue
//       → next walks
//     at the end of the wave: DirectLight::flush, IndirectLight::flush
//
// A sensor (Integrator::irradiance) is a hit without a walk.
#pragma once

#include <memory>

#include "transport/direct_light.h"
#include "transport/indirect_light.h"
#include "transport/integrator.h"

namespace troffer {

class WaveIntegrator final : public Integrator {
 public:
  // indirect: may be null; otherwise direct->walked_part() must be `specular`. has_surrogates
  // applies without indirect light: the emission that viewing rays hit then serves refinement as
  // known radiance. cheaper: Integrator::cheaper(); may be null.
  WaveIntegrator(const PreparedScene& scene, std::unique_ptr<DirectLight> direct,
                 std::unique_ptr<IndirectLight> indirect, bool has_surrogates = false,
                 std::unique_ptr<const Integrator> cheaper = nullptr);

  std::unique_ptr<IntegratorScratch> make_scratch() const override;
  void radiance(const ViewingRays& rays, IntegratorScratch& scratch, RadianceBatch& out,
                Counters& counters) const override;
  const Integrator* cheaper() const override { return cheaper_.get(); }
  bool has_surrogates() const override {
    return indirect_ ? indirect_->is_known() : has_surrogates_;
  }
  void surrogate_radiance(const ViewingRays& rays, IntegratorScratch& scratch, RadianceBatch& out,
                          Counters& counters) const override;
  void irradiance(const SensorBatch& sensors, IntegratorScratch& scratch, RadianceBatch& out,
                  Counters& counters) const override;

 private:
  struct Scratch;

  void begin(const SampleRequest& request, Scratch& s, RadianceBatch& out) const;
  void arrive(size_t first, size_t last, Scratch& s, RadianceBatch& out) const;
  void see_through_panes(const Walk& walk, const Vertex& v, Scratch& s) const;
  // True if the walk left a rough surface only to look for emission.
  bool ends_here(const Walk& walk) const {
    return walk.is_last || (!indirect_ && walk.scatterings > 0);
  }
  void see_lights_at_infinity(const Walk& walk, Scratch& s) const;
  void add_emission(Scratch& s, RadianceBatch& out) const;
  void scatter(Scratch& s, RadianceBatch& out) const;
  void step_on(Scratch& s) const;
  void flush(Scratch& s, RadianceBatch& out, Counters& counters) const;

  const PreparedScene& scene_;
  std::unique_ptr<DirectLight> direct_;
  std::unique_ptr<IndirectLight> indirect_;
  bool has_surrogates_;
  std::unique_ptr<const Integrator> cheaper_;
};

}  // namespace troffer
