// Direct light by a fixed number of shadow rays to every source, and chains of mirrors and clear
// glass: the baseline of classical distribution ray tracing, with Owen-scrambled Sobol points.
// Diffuse surfaces use shadow rays alone; glossy ones also one sample of their own lobe, combined
// by the power heuristic. Unbiased for light that reaches surfaces straight from sources.
#pragma once

#include <memory>

#include "integrate/integrator.h"
#include "integrate/source_sampler.h"

namespace troffer {

struct FixedOptions {
  int shadow_rays = 64;  // per source and viewing ray; powers of two are stratified best
};

class FixedIntegrator final : public Integrator {
 public:
  FixedIntegrator(const PreparedScene& scene, const FixedOptions& options);

  std::unique_ptr<IntegratorScratch> make_scratch() const override;
  void radiance(const ViewingRays& rays, IntegratorScratch& scratch, RadianceBatch& out,
                Counters& counters) const override;
  void irradiance(const SensorBatch& sensors, IntegratorScratch& scratch, RadianceBatch& out,
                  Counters& counters) const override;

 private:
  struct Scratch;

  void sample_sources(const Walk& walk, const Vertex& vertex, const Bsdf& bsdf, Scratch& scratch,
                      RadianceBatch& out, Counters& counters) const;
  void add_emission(const Walk& walk, const Vertex& vertex, RadianceBatch& out) const;

  const PreparedScene& scene_;
  FixedOptions options_;
  SourceSampler sampler_;
};

}  // namespace troffer
