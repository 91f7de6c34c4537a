// The method of 1992: ray tracing for what is seen and for mirrors and gloss, the general radiosity
// value for indirect and minor light, and shadow rays, adaptively, to the sources that were
// selected.
//
// At a vertex the diffuse part of the surface sends on (a) the general value of its patch,
// interpolated, (b) the light of its patch's treated sources, sampled by bintrees. The specular
// part spawns a viewing ray, which is shaded likewise where it arrives; rough gloss is sampled by
// rays to the lights as well, and the two are combined. Biased by design: where rays go, and when
// they stop, depends on what rays found; what the preprocessing missed, probe rays may miss too.
// References: [1] Kok & Jansen, "Adaptive Sampling of Area Light Sources in Ray Tracing Including
//   Diffuse Interreflection", Eurographics '92.
#pragma once

#include <memory>
#include <vector>

#include "integrate/integrator.h"
#include "integrate/radiosity_light.h"
#include "integrate/tree_sampling.h"
#include "integrate/walk.h"
#include "radiosity/solution.h"
#include "select/source_selection.h"

namespace troffer {

struct Kj92Options {
  TreeSamplingOptions sampling;
  bool is_direct_only = false;  // only light that reaches surfaces straight from lights
};

class Kj92Integrator final : public Integrator {
 public:
  // Solution and selection belong to the scene; all three must outlive the integrator.
  Kj92Integrator(const PreparedScene& scene, const RadiositySolution& solution,
                 const SourceSelection& selection, const Kj92Options& options);

  std::unique_ptr<IntegratorScratch> make_scratch() const override;
  // Patterns are reused from ray to ray in the order given and forgotten at the beginning: the
  // result depends on what is in the batch, and in which order.
  void radiance(const ViewingRays& rays, IntegratorScratch& scratch, RadianceBatch& out,
                Counters& counters) const override;
  // Direct light by a tree for every light; indirect light by one ray per sample, distributed by
  // cosine, which takes the radiosity of the surface that it meets.
  void irradiance(const SensorBatch& sensors, IntegratorScratch& scratch, RadianceBatch& out,
                  Counters& counters) const override;

 private:
  struct Scratch;
  std::span<const TreatedSource> treated_at(const RadiosityPlace& place) const;
  bool is_treated(uint32_t place_note, uint32_t light) const;
  void add_emission(const Walk& walk, const Vertex& v, RadianceBatch& out) const;
  void shade(const Walk& walk, const RadiosityPlace& place, const Vertex& v,
             const SurfaceScattering& s, const NeighbourRecords* neighbours, Scratch& scratch,
             RadianceBatch& out, Counters& counters) const;
  bool spawn(Walk& walk, const Vertex& v, const SurfaceScattering& s) const;

  const PreparedScene& scene_;
  const RadiositySolution& solution_;
  const SourceSelection& selection_;
  RadiosityLight radiosity_;
  Kj92Options options_;
  std::vector<TreeSource> sources_;
  std::vector<uint32_t> index_of_source_;
  std::vector<TreatedSource> everywhere_;  // all lights, probed: off the mesh
};

}  // namespace troffer
