// Unidirectional path tracing, the reference for every other method (`--method path`).
// Next-event estimation chooses one light by a light tree, or resamples among few rectangular
// lights (resampled_direct.h), and samples it by solid angle. It is combined with BSDF sampling by
// the power heuristic [1]; Russian roulette ends paths. Unbiased except for the depth limit.
// Forecasts and audits use it as well (path_forecast.h, paths_indirect.h).
//
// References: [1] Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, ch. 9.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "gather/cells.h"
#include "transport/integrator.h"
#include "transport/light_tree_direct.h"
#include "transport/mirror_images.h"
#include "transport/resampled_direct.h"

namespace troffer {

// How paths sample lights. Unused where resampled_direct.h suits the scene.
struct LightSampling {
  uint32_t samples_at_first = 1;  // at the first surface that scatters; later ones take one
  // Chooses lights by what arrives from them. Null: the light tree chooses.
  std::shared_ptr<const LearnedLights> learned = nullptr;
};

struct PathOptions {
  int depth = -1;               // most scatterings (0: emission, 1: direct light); -1: no limit
  bool is_direct_only = false;  // only light scattered once, not counting mirrors and glass
  PixelSampling sampling = {};
  // Leaves out light that reaches a sensor straight from sources, or by way of the mirrors of
  // `images`.
  bool leaves_out_direct_at_sensors = false;
  // Mirrors in which matte surfaces sample lights as if these were seen directly. Null: the scene's
  // relays, which no path meets. Paths find light in other mirrors only by hitting it.
  std::shared_ptr<const MirrorImages> images = nullptr;
  // Cells at which paths end: the first matte reflection after a scattering reads the irradiance
  // there, if the ray is longer than a few cells. Null: paths end by roulette alone.
  std::shared_ptr<const Cells> cells = nullptr;
  LightSampling lights = {};
};

class PathIntegrator final : public Integrator {
 public:
  PathIntegrator(const PreparedScene& scene, const PathOptions& options)
      : scene_(scene),
        options_(options),
        tree_(scene, {LightTreeDirect::Competition::all, options.lights.samples_at_first,
                      options.lights.learned}) {
    if (ResampledDirect::suits(scene)) few_lights_.emplace(scene);
    if (!options_.images && !options_.is_direct_only)
      options_.images = MirrorImages::of_relays(scene);
    if (!options_.images) return;
    for (const MirrorImages::Image& image : options_.images->all())
      lit_images_.emplace_back(*image.scene,
                               LightTreeDirect::Options{LightTreeDirect::Competition::none});
  }

  std::unique_ptr<IntegratorScratch> make_scratch() const override;
  PixelSampling sampling() const override { return options_.sampling; }
  void radiance(const ViewingRays& rays, IntegratorScratch& scratch, RadianceBatch& out,
                Counters& counters) const override;
  void irradiance(const SensorBatch& sensors, IntegratorScratch& scratch, RadianceBatch& out,
                  Counters& counters) const override;

 private:
  struct Scratch;

  void follow(Scratch& scratch, Coherence first, RadianceBatch& out, Counters& counters) const;
  void arrive(Scratch& scratch, RadianceBatch& out) const;
  size_t end_at_cells(Scratch& scratch, size_t alive, RadianceBatch& out) const;
  bool ends_at_cell(Walk& walk, const Vertex& vertex, Bsdf& bsdf, RadianceBatch& out) const;
  void shade(Scratch& scratch, RadianceBatch& out, Counters& counters) const;
  void add_images(Scratch& scratch, RadianceBatch& out, Counters& counters) const;
  void add_emission(const Walk& walk, const Vertex& vertex, RadianceBatch& out) const;
  void add_miss(const Walk& walk, RadianceBatch& out) const;
  void add_seen(const Walk& walk, uint32_t light, Rgb radiance, float weight,
                RadianceBatch& out) const;
  bool step_from(Walk& walk, const Vertex& vertex, const Bsdf& bsdf, const Vec2& direction) const;
  void step_on(Scratch& scratch) const;
  float weight_of(const Walk& walk, const Vertex& vertex) const;
  bool is_last(const Walk& walk) const;

  const PreparedScene& scene_;
  PathOptions options_;
  LightTreeDirect tree_;
  std::optional<ResampledDirect> few_lights_;  // replaces the tree where it is set
  std::vector<LightTreeDirect> lit_images_;    // one for each of options_.images
};

// Returns a function that makes path tracers with these options and a way of sampling lights.
inline auto paths_by_light_sampling(const PreparedScene& scene, const PathOptions& options) {
  return [&scene, options](const LightSampling& lights) -> std::unique_ptr<Integrator> {
    PathOptions with = options;
    with.lights = lights;
    return std::make_unique<PathIntegrator>(scene, with);
  };
}

}  // namespace troffer
