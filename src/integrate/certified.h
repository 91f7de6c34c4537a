// Light straight from sources by certified visibility, indirect light from the radiosity
// preprocessing: the structure of the method of 1992 with shadow flags that are proved.
//
// Hits of a batch are treated together for every source (certified_lights.h), without rays but
// where no list of facets is complete. A fixed number of shadow rays (source_sampler.h) does what
// has no certificates: finely meshed curved sources, and rough surfaces that transmit. Mirrors,
// glass and gloss spawn viewing rays, shaded likewise where they arrive. Direct light is unbiased;
// indirect light is as good as the radiosity solution.
// References: docs/certified.md.
#pragma once

#include <memory>
#include <optional>

#include "integrate/certified_lights.h"
#include "integrate/certified_patches.h"
#include "integrate/integrator.h"
#include "integrate/radiosity_light.h"
#include "integrate/source_sampler.h"
#include "integrate/surface_scattering.h"

namespace troffer {

struct CertifiedSettings {
  CertifiedOptions estimator;
  double error = 0.01;     // allowed, relative to unoccluded light
  int shadow_rays = 64;    // per source and viewing ray where there are no certificates
  int gloss_samples = 32;  // points of a source at which gloss and textures are looked at
};

// Settings for an allowed standard error of a viewing ray's direct light, relative to what its
// sources would send unoccluded, in a scene of so many lights.
CertifiedSettings certified_settings(double error, size_t lights);

class CertifiedIntegrator final : public Integrator {
 public:
  // `radiosity` of the scene, of a selection by certified_selection(); without it there is no
  // indirect light. Throws EnvironmentError if memory runs out.
  CertifiedIntegrator(const PreparedScene& scene, std::optional<RadiosityLight> radiosity,
                      const CertifiedSettings& settings);

  std::unique_ptr<IntegratorScratch> make_scratch() const override;
  // Hits of a batch are clustered, and found occluders are remembered within it: the noise of the
  // result, though not its mean, depends on what is in the batch.
  void radiance(const ViewingRays& rays, IntegratorScratch& scratch, RadianceBatch& out,
                Counters& counters) const override;
  // Indirect light by one ray per sample, distributed by cosine, which takes the radiosity of the
  // surface that it meets.
  void irradiance(const SensorBatch& sensors, IntegratorScratch& scratch, RadianceBatch& out,
                  Counters& counters) const override;

 private:
  struct Scratch;

  void add_emission(const Walk& walk, const Vertex& v, RadianceBatch& out) const;
  float emission_weight(const Walk& walk, const Vertex& v) const;
  void light(const Walk& walk, const Vertex& v, const SurfaceScattering& scattering, Scratch& s,
             RadianceBatch& out, Counters& counters) const;
  void add_indirect(const Walk& walk, const Hit& hit, const Vertex& v,
                    const SurfaceScattering& scattering, Scratch& s, RadianceBatch& out) const;
  void gather(const SensorBatch& sensors, Scratch& s, RadianceBatch& out, Counters& counters) const;

  const PreparedScene& scene_;
  std::optional<RadiosityLight> radiosity_;
  CertifiedSettings settings_;
  Occluders occluders_;
  CertifiedLights lights_;
  CertifiedPatches patches_;
  SourceSampler sampler_;
};

}  // namespace troffer
