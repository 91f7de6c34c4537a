#include "methods/certified_method.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "certified/imaged_direct.h"
#include "certified/staged_direct.h"
#include "gather/cells_indirect.h"
#include "light/sky_patches.h"
#include "methods/path.h"
#include "methods/paths_indirect.h"
#include "transport/wave_integrator.h"

namespace troffer {

namespace {

// Allowed error of gathered light, stricter than the asked error, down to 1 %. Pixels that share a
// fit err alike, which is visible as stains where the same noise of single pixels is not.
double error_of_gather(double asked) {
  constexpr double as_asked = 0.01;
  return std::sqrt(asked * std::min(asked, as_asked));
}

// Cells and the records of a picture; null if a stop came before they were complete.
struct GatheredCells {
  std::shared_ptr<const Cells> cells;
  std::shared_ptr<const GatherRecords> records;  // null also without a picture
  bool is_whole = false;
};

// Makes the cells of the plan and gathers from them. direct: direct light at cells.
GatheredCells gather(const MethodPlan& plan, const MethodInput& in, const DirectLight& direct) {
  TROFFER_CHECK(in.cells != nullptr);
  const auto part = [&](double first, double last) -> std::function<void(double)> {
    if (!in.cells->progress) return nullptr;
    return [&in, first, last](double f) { in.cells->progress(first + (last - first) * f); };
  };
  GatheredCells made;
  std::unique_ptr<Cells> cells =
      make_cells(in.scene, direct, in.cells->pilot,
                 {in.settings.threads, in.cells->seed, error_beyond_first(in), in.settings.error,
                  plan.most_cells, in.cells->group, in.cells->points, in.cells->enough},
                 in.cells->store, part(0, 0.4), in.cells->stop, in.cells->counters);
  if (!cells) return made;
  in.cells->statistics = cells->statistics();
  if (in.cells->points.most_rays > 0)
    cells->resolve_narrow_where_worth_it(in.cells->pilot.places, in.cells->seed,
                                         in.cells->counters);
  made.cells = std::move(cells);
  if (in.cells->view != nullptr) {
    const GatherOptions options{error_of_gather(in.settings.error),
                                made.cells->statistics().typical, in.settings.threads,
                                in.cells->seed, in.cells->group};
    made.records = GatherRecords::make(*made.cells, *in.cells->view, options, part(0.4, 1),
                                       in.cells->stop, in.cells->counters);
  }
  made.is_whole = in.cells->view == nullptr || made.records != nullptr;
  return made;
}

// One stage of direct light and its settings.
struct Stage {
  std::unique_ptr<DirectLight>& direct;
  CertifiedSettings settings;
};
// Adds lights seen in flat mirrors to all given stages, which share the images.
void add_images(const MethodInput& in, std::initializer_list<Stage> stages) {
  const std::shared_ptr<const MirrorImages> images = MirrorImages::make(in.scene);
  if (!images) return;
  std::vector<std::shared_ptr<const Occluders>> occluders;
  for (const MirrorImages::Image& image : images->all())
    occluders.push_back(std::make_shared<const Occluders>(image.scene->scene, &image.scene->glass));
  for (const Stage& s : stages)
    if (s.direct)
      s.direct = std::make_unique<ImagedDirect>(std::move(s.direct), images, occluders, s.settings);
}

// Makes an integrator of the same light by few draws of lights and few gather rays.
std::unique_ptr<Integrator> make_quick(const MethodInput& in,
                                       const std::shared_ptr<const Occluders>& occluders,
                                       const std::shared_ptr<const Cells>& cells,
                                       const std::shared_ptr<const GatherRecords>& records) {
  constexpr int few_draws = 4;  // a power of two: stratified best
  CertifiedSettings settings = settings_beyond_first(in);
  settings.draws = few_draws;
  std::unique_ptr<DirectLight> direct =
      std::make_unique<CertifiedDirect>(in.scene, occluders, settings);
  add_images(in, {{direct, settings}});
  return std::make_unique<WaveIntegrator>(in.scene, std::move(direct),
                                          std::make_unique<CellsIndirect>(cells, records));
}

// Returns the occluders for certificates: those of the scene, or none if no light can have a
// certificate.
std::shared_ptr<const Occluders> occluders_for(const MethodInput& in) {
  const std::vector<Light>& lights = in.scene.scene.lights;
  const bool is_asked = std::any_of(lights.begin(), lights.end(), [](const Light& light) {
    return has_surface(light.kind) || has_sky_patches(light.kind);
  });
  if (!is_asked) return std::make_shared<const Occluders>(Scene());
  return std::make_shared<const Occluders>(in.scene.scene, &in.scene.glass);
}

// Makes a path tracer that samples as the forecast says, or to the usual number of samples.
std::unique_ptr<Integrator> make_paths(const MethodPlan& plan, const MethodInput& in) {
  if (!plan.forecast)
    return std::make_unique<PathIntegrator>(
        in.scene, PathOptions{in.settings.depth, in.settings.is_direct_only()});
  return std::make_unique<PathIntegrator>(
      in.scene, PathOptions{in.settings.depth, false,
                            sampling_by_paths(*plan.forecast, error_by_paths(in.settings.error),
                                              most_by_paths(in.settings.most_viewing_rays))});
}

// Makes cells and their gathers, then the integrator that reads them.
std::unique_ptr<Integrator> make_by_cells(const MethodPlan& plan, const MethodInput& in,
                                          const std::shared_ptr<const Occluders>& occluders,
                                          std::unique_ptr<DirectLight> first) {
  std::unique_ptr<DirectLight> at_cells =
      std::make_unique<CertifiedDirect>(in.scene, occluders, plan.at_cells);
  std::unique_ptr<DirectLight> further;
  if (plan.further.draws > 0)
    further = std::make_unique<CertifiedDirect>(in.scene, occluders, plan.further);
  add_images(in, {{first, plan.first}, {at_cells, plan.at_cells}, {further, plan.further}});
  const GatheredCells made = gather(plan, in, *at_cells);
  if (made.cells && in.cells->enough != nullptr)
    in.cells->quick = make_quick(in, occluders, made.cells, made.records);
  if (!made.is_whole)
    return plan.forecast && !in.cells->stop.load() ? make_paths(plan, in) : nullptr;
  if (!further) further = std::move(at_cells);
  constexpr auto all = std::numeric_limits<uint32_t>::max();
  const uint32_t samples = in.cells->view != nullptr ? uint32_t(in.settings.viewing_rays) : all;
  return std::make_unique<WaveIntegrator>(
      in.scene, std::make_unique<StagedDirect>(std::move(first), std::move(further), samples),
      std::make_unique<CellsIndirect>(made.cells, made.records));
}

}  // namespace

std::unique_ptr<Integrator> make_certified(const MethodPlan& plan, const MethodInput& in) {
  if (plan.light == PlannedLight::path_tracing) return make_paths(plan, in);
  const std::shared_ptr<const Occluders> occluders = occluders_for(in);
  std::unique_ptr<DirectLight> first =
      std::make_unique<CertifiedDirect>(in.scene, occluders, plan.first);
  switch (plan.light) {
    case PlannedLight::cells:
      return make_by_cells(plan, in, occluders, std::move(first));
    case PlannedLight::sensor_paths: {
      add_images(in, {{first, plan.first}});
      auto reflected = std::make_unique<PathsIndirect>(in.scene, first->images());
      return std::make_unique<WaveIntegrator>(in.scene, std::move(first), std::move(reflected));
    }
    case PlannedLight::staged_direct: {
      auto further = std::make_unique<CertifiedDirect>(in.scene, occluders, plan.further);
      return std::make_unique<WaveIntegrator>(
          in.scene,
          std::make_unique<StagedDirect>(std::move(first), std::move(further),
                                         uint32_t(in.settings.viewing_rays)),
          nullptr, true);
    }
    case PlannedLight::direct:
      return std::make_unique<WaveIntegrator>(in.scene, std::move(first), nullptr);
    case PlannedLight::path_tracing:
    case PlannedLight::radiosity:
      break;
  }
  TROFFER_CHECK(false);
  return nullptr;
}

}  // namespace troffer
