#include "methods/methods.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "base/error.h"
#include "certified/certified_direct.h"
#include "certified/imaged_direct.h"
#include "certified/staged_direct.h"
#include "gather/cells_indirect.h"
#include "kj92/bintree_direct.h"
#include "kj92/radiosity_indirect.h"
#include "light/sky_patches.h"
#include "methods/path.h"
#include "methods/path_forecast.h"
#include "methods/paths_indirect.h"
#include "transport/fixed_direct.h"
#include "transport/wave_integrator.h"

namespace troffer {

namespace {

// Allowed error of direct light beyond the first surface: at cells and at what gloss shows. At
// least 0.1, because many cells average out and gloss carries only a part of the light.
double error_beyond_first(const MethodInput& in) {
  constexpr double least_error = 0.1;
  return std::max(in.settings.error, least_error);
}
CertifiedSettings settings_beyond_first(const MethodInput& in) {
  constexpr int few_points = 8;
  CertifiedSettings s = certified_settings(error_beyond_first(in), in.scene.scene.lights.size());
  s.gloss_samples = few_points;
  return s;
}

// Settings of direct light at the first viewing rays of a pixel. In coarse pictures a hit gets
// `draws` light samples if certificates would cost it more rays. Their noise is below the allowed
// error there.
CertifiedSettings settings_of_first(const MethodInput& in) {
  constexpr double coarse = 0.2;
  constexpr int draws = 32;
  CertifiedSettings s =
      certified_settings(in.settings.error, in.scene.scene.lights.size(), in.settings.viewing_rays);
  if (in.cells != nullptr && in.cells->view != nullptr && in.settings.error >= coarse)
    s.draws = draws;
  return s;
}

// Settings of direct light beyond the first surface. In pictures, light samples replace
// certificates where those cost more, and from error `coarse` on fewer samples do. Measuring points
// keep certificates: they share cells, so all of them would have the same noise.
CertifiedSettings drawn_beyond(const MethodInput& in, double coarse) {
  constexpr int draws = 16, few_draws = 8;  // powers of two stratify best
  CertifiedSettings s = settings_beyond_first(in);
  if (in.cells->view != nullptr) s.draws = in.settings.error >= coarse ? few_draws : draws;
  return s;
}
// Settings at the further viewing rays of a pixel, each of which is a small part of it, and at what
// gloss shows along any viewing ray.
CertifiedSettings settings_of_further(const MethodInput& in) {
  CertifiedSettings s = drawn_beyond(in, 0.1);
  s.matte_draw_factor = 2;
  return s;
}
// Settings at cells. A cell averages eight or more hits, so few samples suffice from a smaller
// error on.
CertifiedSettings settings_of_cells(const MethodInput& in) {
  return drawn_beyond(in, 0.02);
}

// Allowed error of a picture by paths. Pictures by cells reach about half of the asked error, so
// paths also have to do better than asked.
double error_by_paths(double asked) {
  return 0.75 * asked;
}
int most_by_paths(const MethodSettings& s) {
  constexpr int most = 1 << 14;
  return s.most_viewing_rays > 0 ? s.most_viewing_rays : most;
}

// Allowed error of gathered light, stricter than the asked error, down to 1 %. Pixels that share a
// fit err alike, which is visible as stains where the same noise of single pixels is not.
double error_of_gather(double asked) {
  constexpr double as_asked = 0.01;
  return std::sqrt(asked * std::min(asked, as_asked));
}

// Cells, and the records of a picture; null where stopped before they were whole.
struct GatheredCells {
  std::shared_ptr<const Cells> cells;
  std::shared_ptr<const GatherRecords> records;  // null also where no picture is made
  bool is_whole = false;
};

GatheredCells make_gathered_cells(const MethodInput& in, const DirectLight& direct,
                                  double most_cells) {
  TROFFER_CHECK(in.cells != nullptr);
  const auto part = [&](double first, double last) -> std::function<void(double)> {
    if (!in.cells->progress) return nullptr;
    return [&in, first, last](double f) { in.cells->progress(first + (last - first) * f); };
  };
  GatheredCells made;
  std::unique_ptr<Cells> cells =
      make_cells(in.scene, direct, in.cells->pilot,
                 {in.settings.threads, in.cells->seed, error_beyond_first(in), in.settings.error,
                  most_cells, in.cells->group, in.cells->points, in.cells->enough},
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

// Returns the forecast for path tracing, or nothing where paths must not replace cells: indirect
// light chosen explicitly, no picture, or cells kept in a store.
std::optional<PathForecast> forecast(const MethodInput& in) {
  const CellInput& cells = *in.cells;
  if (in.settings.indirect != Indirect::automatic || cells.view == nullptr ||
      cells.store != nullptr)
    return std::nullopt;
  const int most = most_by_paths(in.settings);
  const PathForecast f = forecast_paths(in.scene, *cells.view, error_by_paths(in.settings.error),
                                        most, cells.seed, in.cells->counters);
  // Near the limit of viewing rays, many pixels would stop before they reach the asked error.
  if (4 * f.viewing_rays > most) return std::nullopt;
  return f;
}

std::unique_ptr<Integrator> make_paths(const MethodInput& in, const PathForecast& forecast) {
  return std::make_unique<PathIntegrator>(
      in.scene, PathOptions{in.settings.depth, false,
                            sampling_by_paths(forecast, error_by_paths(in.settings.error),
                                              most_by_paths(in.settings))});
}

// Direct light alone, with refinement. The error of a pixel comes from what its many further rays
// hit, so each of them may err by more in its own light. They use light samples where certificates
// cost more.
std::unique_ptr<Integrator> make_refined_direct(const MethodInput& in,
                                                const std::shared_ptr<const Occluders>& occluders,
                                                std::unique_ptr<DirectLight> first) {
  constexpr double more = 3;
  constexpr int few_draws = 8;  // a power of two stratifies best
  CertifiedSettings s =
      certified_settings(std::min(more * in.settings.error, 1.0), in.scene.scene.lights.size());
  s.draws = few_draws;
  std::unique_ptr<DirectLight> further = std::make_unique<CertifiedDirect>(in.scene, occluders, s);
  return std::make_unique<WaveIntegrator>(
      in.scene,
      std::make_unique<StagedDirect>(std::move(first), std::move(further),
                                     uint32_t(in.settings.viewing_rays)),
      nullptr, true);
}

std::unique_ptr<Integrator> make_path(const MethodInput& in) {
  return std::make_unique<PathIntegrator>(
      in.scene, PathOptions{in.settings.depth, in.settings.is_direct_only()});
}

std::unique_ptr<Integrator> make_certified(const MethodInput& in) {
  // Without lights the search for cells would run to its limit.
  const bool keeps_cells = in.cells != nullptr && in.cells->store != nullptr;
  if (in.scene.scene.lights.empty() && !keeps_cells) return make_path(in);
  std::optional<PathForecast> paths;
  const bool takes_cells =
      needs_cells(Method::certified, in.settings.indirect) && !in.settings.measures_by_paths;
  if (takes_cells) paths = forecast(in);
  if (paths && paths->rays_for_cells < 0) return make_paths(in, *paths);
  const CertifiedSettings settings = settings_of_first(in);
  const std::shared_ptr<const Occluders> occluders = occluders_for(in);
  std::unique_ptr<DirectLight> direct =
      std::make_unique<CertifiedDirect>(in.scene, occluders, settings);
  std::unique_ptr<IndirectLight> indirect;
  if (in.settings.measures_by_paths) {
    add_images(in, {{direct, settings}});
    indirect = std::make_unique<PathsIndirect>(in.scene, direct->images());
    return std::make_unique<WaveIntegrator>(in.scene, std::move(direct), std::move(indirect));
  }
  if (takes_cells) {
    const CertifiedSettings at_cells = settings_of_cells(in);
    std::unique_ptr<DirectLight> of_cells =
        std::make_unique<CertifiedDirect>(in.scene, occluders, at_cells);
    const CertifiedSettings drawn = settings_of_further(in);
    std::unique_ptr<DirectLight> further;
    if (drawn.draws > 0) further = std::make_unique<CertifiedDirect>(in.scene, occluders, drawn);
    add_images(in, {{direct, settings}, {of_cells, at_cells}, {further, drawn}});
    const double most_cells = paths ? paths->rays_for_cells / rays_of_cell : in.cells->most_cells;
    const GatheredCells made = make_gathered_cells(in, *of_cells, most_cells);
    if (made.cells && in.cells->enough != nullptr)
      in.cells->quick = make_quick(in, occluders, made.cells, made.records);
    if (!made.is_whole) return paths && !in.cells->stop.load() ? make_paths(in, *paths) : nullptr;
    indirect = std::make_unique<CellsIndirect>(made.cells, made.records);
    if (!further) further = std::move(of_cells);
    constexpr auto all = std::numeric_limits<uint32_t>::max();
    const uint32_t samples = in.cells->view != nullptr ? uint32_t(in.settings.viewing_rays) : all;
    return std::make_unique<WaveIntegrator>(
        in.scene, std::make_unique<StagedDirect>(std::move(direct), std::move(further), samples),
        std::move(indirect));
  }
  if (in.settings.is_direct_only() && in.settings.is_refined)
    return make_refined_direct(in, occluders, std::move(direct));
  return std::make_unique<WaveIntegrator>(in.scene, std::move(direct), nullptr);
}

// The bintrees sample selected patches like lights.
std::unique_ptr<Integrator> make_kj92(const MethodInput& in) {
  TROFFER_CHECK(in.radiosity != nullptr);
  std::unique_ptr<IndirectLight> indirect;
  if (!in.settings.is_direct_only())
    indirect = std::make_unique<RadiosityIndirect>(in.scene, *in.radiosity);
  return std::make_unique<WaveIntegrator>(
      in.scene, std::make_unique<BintreeDirect>(in.scene, *in.radiosity, in.settings.trees),
      std::move(indirect));
}

std::unique_ptr<Integrator> make_fixed(const MethodInput& in) {
  return std::make_unique<WaveIntegrator>(
      in.scene, std::make_unique<FixedDirect>(in.scene, in.settings.shadow_rays), nullptr);
}

// With many lights most are sampled, not certified, so that their number stops mattering.
double certified_rays(const MethodSettings& s, size_t lights) {
  constexpr size_t most = 256;
  return double(certified_settings(s.error, lights).shadow_rays) * double(std::min(lights, most));
}
double kj92_rays(const MethodSettings& s, size_t lights) {
  return double(s.trees.tree.most_rays) * double(lights);
}
double fixed_rays(const MethodSettings& s, size_t lights) {
  return double(s.shadow_rays) * double(lights);
}
double path_rays(const MethodSettings&, size_t) {
  return 1;
}

}  // namespace

// Rows in the order of the constants of Method and Indirect.
struct MethodTable {
  static const std::array<MethodRow, 4> methods;
  static const std::array<IndirectRow, 4> indirects;

  template <class Kind, class Rows>
  static std::optional<Kind> find(const Rows& rows, std::string_view name) {
    for (uint8_t i = 0; i < rows.size(); ++i)
      if (rows[i].name == name) return Kind(i);
    return std::nullopt;
  }
};

// Limit of rays per tile. Stop requests are checked between tiles, so scenes with many sources have
// smaller tiles.
constexpr double most_rays_of_tile = 1 << 22;
// The same for `certified`, where few sources get rays.
constexpr double most_certified_rays_of_tile = 1 << 25;

const std::array<MethodRow, 4> MethodTable::methods{{
    {
        .name = "certified",
        .make = make_certified,
        .rays_per_sample = certified_rays,
        .usual_indirect = Indirect::cells,
        .widest_tile = 8,  // keeps clusters of hits small in space
        .most_rays_per_tile = most_certified_rays_of_tile,
        .has_noise_of_batch = true,
        .uses_typical_luminance = true,
        .refinement = 4,
        .measures_to_error = true,
        .measuring_samples_per_direct = 32,
    },
    {
        .name = "kj92",
        .make = make_kj92,
        .rays_per_sample = kj92_rays,
        .usual_indirect = Indirect::radiosity,
        .always_needs_radiosity = true,
        .is_same_in_crops = false,  // compared with published results of the same crop
        // One sample contains all rays that the bintrees ask for.
        .usual_measuring_samples = 256,
    },
    {
        .name = "fixed",
        .make = make_fixed,
        .rays_per_sample = fixed_rays,
        .is_direct_only = true,
        .most_rays_per_tile = most_rays_of_tile,
        .rays_of_measuring_sample = 16,  // one set of shadow rays to every source
    },
    {
        .name = "path",
        .make = make_path,
        .rays_per_sample = path_rays,
    },
}};

const std::array<IndirectRow, 4> MethodTable::indirects{{
    {.name = "auto"},
    {.name = "none"},
    {.name = "radiosity", .needs_radiosity = true},
    {.name = "cells", .needs_cells = true},
}};

std::optional<Method> Method::find(std::string_view name) {
  return MethodTable::find<Method>(MethodTable::methods, name);
}
std::string Method::names() {
  std::string names;
  for (size_t i = 0; i < MethodTable::methods.size(); ++i) {
    if (i > 0) names += i + 1 == MethodTable::methods.size() ? " or " : ", ";
    names += MethodTable::methods[i].name;
  }
  return names;
}
const MethodRow& Method::row() const {
  return MethodTable::methods[row_];
}
std::optional<Indirect> Indirect::find(std::string_view name) {
  return MethodTable::find<Indirect>(MethodTable::indirects, name);
}
const IndirectRow& Indirect::row() const {
  return MethodTable::indirects[row_];
}

Indirect chosen_indirect(Method method, Indirect indirect) {
  return indirect == Indirect::none ? indirect : method.row().usual_indirect;
}

bool needs_radiosity(Method method, Indirect indirect) {
  return method.row().always_needs_radiosity ||
         chosen_indirect(method, indirect).row().needs_radiosity;
}

bool needs_cells(Method method, Indirect indirect) {
  return chosen_indirect(method, indirect).row().needs_cells;
}

std::unique_ptr<Integrator> make_integrator(Method method, const MethodInput& input) {
  return method.row().make(input);
}

}  // namespace troffer
