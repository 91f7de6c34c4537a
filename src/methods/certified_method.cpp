#include "methods/certified_method.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/error.h"
#include "certified/imaged_direct.h"
#include "certified/staged_direct.h"
#include "gather/cells_indirect.h"
#include "light/sky_patches.h"
#include "methods/cell_way.h"
#include "methods/gather_trial.h"
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

// Returns the callback of a part of the preparation's progress.
std::function<void(double)> part_of_progress(const MethodInput& in, double first, double last) {
  if (!in.cells->progress) return nullptr;
  return [&in, first, last](double f) { in.cells->progress(first + (last - first) * f); };
}

// Makes the cells of the plan; null after a stop, or if there are too many. direct: direct light at
// cells. last: their share of the preparation's progress.
std::shared_ptr<const Cells> cells_of(const MethodPlan& plan, const MethodInput& in,
                                      const DirectLight& direct, double last) {
  TROFFER_CHECK(in.cells != nullptr);
  std::unique_ptr<Cells> cells = make_cells(
      in.scene, direct, in.cells->pilot,
      {in.settings.threads, in.cells->seed, error_beyond_first(in), in.settings.error,
       plan.most_cells, plan.rays_for_direct, in.cells->group, in.cells->points, in.cells->enough},
      in.cells->store, part_of_progress(in, 0, last), in.cells->stop, in.cells->counters);
  if (!cells) return nullptr;
  in.cells->statistics = cells->statistics();
  if (in.cells->points.most_rays > 0)
    cells->resolve_narrow_where_worth_it(in.cells->pilot.places, in.cells->seed,
                                         in.cells->counters);
  return cells;
}

GatherOptions gather_options(const MethodInput& in, const Cells& cells) {
  return {error_of_gather(in.settings.error), cells.statistics().typical, in.settings.threads,
          in.cells->seed, in.cells->group};
}

// Gathers from cells for the picture. Returns null after a stop.
std::shared_ptr<const GatherRecords> gather(const MethodInput& in, const Cells& cells) {
  return GatherRecords::make(cells, *in.cells->view, gather_options(in, cells),
                             part_of_progress(in, 0.4, 1), in.cells->stop, in.cells->counters);
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

// Surfaces that certificates are proved against: those of the scene, and of its images in flat
// mirrors if there are any.
struct Occlusion {
  std::shared_ptr<const Occluders> scene;
  std::shared_ptr<const MirrorImages> images;
  std::vector<std::shared_ptr<const Occluders>> of_images;
};
Occlusion occlusion_for(const MethodInput& in, bool has_images) {
  Occlusion o{occluders_for(in), has_images ? MirrorImages::make(in.scene) : nullptr, {}};
  if (o.images)
    for (const MirrorImages::Image& image : o.images->all())
      o.of_images.push_back(
          std::make_shared<const Occluders>(image.scene->scene, &image.scene->glass));
  return o;
}

std::unique_ptr<DirectLight> make_direct(const MethodInput& in, const Occlusion& by,
                                         const CertifiedSettings& settings) {
  auto direct = std::make_unique<CertifiedDirect>(in.scene, by.scene, settings);
  if (!by.images) return direct;
  return std::make_unique<ImagedDirect>(std::move(direct), by.images, by.of_images, settings);
}

// Makes an integrator of the same light by few draws of lights and few gather rays.
std::unique_ptr<Integrator> make_quick(const MethodInput& in, const Occlusion& by,
                                       const std::shared_ptr<const Cells>& cells,
                                       const std::shared_ptr<const GatherRecords>& records) {
  constexpr int few_draws = 4;  // a power of two: stratified best
  CertifiedSettings settings = settings_beyond_first(in);
  settings.draws = few_draws;
  return std::make_unique<WaveIntegrator>(in.scene, make_direct(in, by, settings),
                                          std::make_unique<CellsIndirect>(cells, records));
}

// Makes a path tracer that samples as the forecast says, or to the usual number of samples.
std::unique_ptr<Integrator> make_paths(const MethodPlan& plan, const MethodInput& in) {
  if (!plan.forecast)
    return std::make_unique<PathIntegrator>(
        in.scene, PathOptions{in.settings.depth, in.settings.is_direct_only()});
  PathOptions options;
  options.depth = in.settings.depth;
  options.sampling = sampling_by_paths(*plan.forecast, error_by_paths(in.settings.error),
                                       most_by_paths(in.settings.most_viewing_rays));
  options.lights = plan.forecast->lights;
  return std::make_unique<PathIntegrator>(in.scene, options);
}

// Adds the choice and its reasons to the decisions.
void tell_choice(const MethodInput& in, CellWay way, const PathForecast& cached,
                 bool is_cached_possible, const GatherTrial& trial) {
  std::string reason =
      is_cached_possible
          ? fmt::format(
                "they would take {:.3g} viewing rays per pixel with {} light samples each{}, "
                "and {:.3g} million rays",
                cached.viewing_rays, cached.lights.samples_at_first,
                cached.lights.learned ? " of learned lights" : "", cached.rays * 1e-6)
          : fmt::format("they would take more than a quarter of {} viewing rays per pixel",
                        most_by_paths(in.settings.most_viewing_rays));
  if (trial.cost > 0)
    reason += fmt::format(
        "; gathers {:.3g} million, of which {:.3g} to gather and {:.3g} for first viewing rays",
        trial.cost * 1e-6, trial.of_gathers * 1e-6, trial.of_first * 1e-6);
  in.cells->decisions.push_back({"paths that end at cells",
                                 way == CellWay::cached_paths ? "for the whole picture" : "no",
                                 std::move(reason)});
  if (way == CellWay::paths)
    in.cells->decisions.push_back(
        {"all light", "path tracing instead", "cells would not clearly cost less"});
}

// Returns path tracing, plain or with the options `to_cells`, if test paths and gathers in a few
// windows of the picture show that it costs less; null otherwise. cached: forecast of paths to the
// cells. gathers: the integrator that reads the records of `reflected`.
std::unique_ptr<Integrator> paths_if_cheaper(const MethodPlan& plan, const MethodInput& in,
                                             PathOptions to_cells, const PathForecast& cached,
                                             const Integrator& gathers, CellsIndirect& reflected) {
  const double error = error_by_paths(in.settings.error);
  const int most = most_by_paths(in.settings.most_viewing_rays);
  const bool is_cached_possible = cached.is_within(most);
  if (!is_cached_possible && !plan.forecast) {
    tell_choice(in, CellWay::gathers, cached, false, {});
    return nullptr;
  }
  const Cells& cells = *to_cells.cells;
  const GatherTrial trial =
      try_gathers({gathers, reflected, cells, *in.cells->view, gather_options(in, cells),
                   std::max(in.settings.viewing_rays, 1), error, cached},
                  in.cells->stop, in.cells->counters);
  if (!(trial.cost > 0)) return nullptr;
  const CellWay way =
      cheapest_way(plan.forecast ? std::optional(plan.forecast->rays) : std::nullopt,
                   is_cached_possible ? std::optional(cached.rays) : std::nullopt, trial.cost);
  tell_choice(in, way, cached, is_cached_possible, trial);
  switch (way) {
    case CellWay::cached_paths:
      to_cells.sampling = sampling_by_paths(cached, error, most);
      return std::make_unique<PathIntegrator>(in.scene, to_cells);
    case CellWay::paths:
      return make_paths(plan, in);
    case CellWay::gathers:
      break;
  }
  return nullptr;
}

// Makes cells and their gathers, then the integrator that reads them.
std::unique_ptr<Integrator> make_by_cells(const MethodPlan& plan, const MethodInput& in) {
  const Occlusion by = occlusion_for(in, true);
  std::unique_ptr<DirectLight> at_cells = make_direct(in, by, plan.at_cells);
  const bool is_picture = in.cells->view != nullptr;
  const std::shared_ptr<const Cells> cells = cells_of(plan, in, *at_cells, is_picture ? 0.4 : 1);
  if (!cells) {
    if (!plan.forecast || in.cells->stop.load()) return nullptr;
    in.cells->decisions.push_back(
        {"all light", "path tracing instead", "there were more cells than planned"});
    return make_paths(plan, in);
  }
  std::unique_ptr<DirectLight> further =
      plan.further.draws > 0 ? make_direct(in, by, plan.further) : std::move(at_cells);
  constexpr auto all = std::numeric_limits<uint32_t>::max();
  const uint32_t samples = is_picture ? uint32_t(in.settings.viewing_rays) : all;
  PathOptions to_cells;
  to_cells.depth = in.settings.depth;
  to_cells.cells = cells;
  std::optional<PathForecast> cached;
  if (plan.may_end_paths_at_cells) {
    std::shared_ptr<const LearnedLights> learned = plan.learned_lights;
    cached = forecast(in, to_cells, learned);
    to_cells.lights = cached->lights;
  }
  auto indirect = std::make_unique<CellsIndirect>(cells, nullptr);
  CellsIndirect& reflected = *indirect;
  auto gathers = std::make_unique<WaveIntegrator>(
      in.scene,
      std::make_unique<StagedDirect>(make_direct(in, by, plan.first), std::move(further), samples),
      std::move(indirect), false,
      is_picture ? std::make_unique<PathIntegrator>(in.scene, to_cells) : nullptr);
  if (cached)
    if (std::unique_ptr<Integrator> paths =
            paths_if_cheaper(plan, in, to_cells, *cached, *gathers, reflected))
      return paths;
  std::shared_ptr<const GatherRecords> records;
  if (is_picture) records = gather(in, *cells);
  if (in.cells->enough != nullptr) in.cells->quick = make_quick(in, by, cells, records);
  if (is_picture && !records) return nullptr;
  reflected.set_records(std::move(records));
  return gathers;
}

}  // namespace

MethodPlan plan_cached_path(const MethodInput& in) {
  MethodPlan plan;
  plan.light = PlannedLight::cells;
  plan.at_cells = settings_of_cells(in);
  plan.parts.push_back({"all light", "path tracing to the first cell", "asked for"});
  return plan;
}

std::unique_ptr<Integrator> make_cached_path(const MethodPlan& plan, const MethodInput& in) {
  const CertifiedDirect at_cells(in.scene, occluders_for(in), plan.at_cells);
  const std::shared_ptr<const Cells> cells = cells_of(plan, in, at_cells, 1);
  if (!cells) return nullptr;
  PathOptions options;
  options.depth = in.settings.depth;
  options.cells = cells;
  return std::make_unique<PathIntegrator>(in.scene, options);
}

std::unique_ptr<Integrator> make_certified(const MethodPlan& plan, const MethodInput& in) {
  switch (plan.light) {
    case PlannedLight::path_tracing:
      return make_paths(plan, in);
    case PlannedLight::cells:
      return make_by_cells(plan, in);
    case PlannedLight::sensor_paths: {
      std::unique_ptr<DirectLight> first = make_direct(in, occlusion_for(in, true), plan.first);
      auto reflected = std::make_unique<PathsIndirect>(in.scene, first->images());
      return std::make_unique<WaveIntegrator>(in.scene, std::move(first), std::move(reflected));
    }
    case PlannedLight::staged_direct: {
      const Occlusion by = occlusion_for(in, false);
      return std::make_unique<WaveIntegrator>(
          in.scene,
          std::make_unique<StagedDirect>(make_direct(in, by, plan.first),
                                         make_direct(in, by, plan.further),
                                         uint32_t(in.settings.viewing_rays)),
          nullptr, true);
    }
    case PlannedLight::direct:
      return std::make_unique<WaveIntegrator>(
          in.scene, make_direct(in, occlusion_for(in, false), plan.first), nullptr);
    case PlannedLight::radiosity:
      break;
  }
  TROFFER_CHECK(false);
  return nullptr;
}

}  // namespace troffer
