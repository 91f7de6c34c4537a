#include "methods/method_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/ablation.h"
#include "base/random.h"
#include "base/streams.h"
#include "methods/methods.h"
#include "methods/path.h"
#include "transport/light_training.h"
#include "transport/purposes.h"

namespace troffer {

namespace {

// Settings of direct light at the first viewing rays of a pixel. In coarse pictures a hit gets
// `draws` light samples if certificates would cost it more rays. Their noise is below the allowed
// error there.
CertifiedSettings settings_of_first(const MethodInput& in) {
  constexpr double coarse = 0.2;
  constexpr int draws = 32;
  CertifiedSettings s =
      certified_settings(in.settings.error, in.scene.scene.lights.size(), in.settings.viewing_rays);
  if (in.cells != nullptr && in.cells->view != nullptr && in.settings.error >= coarse &&
      !is_left_out<"light samples at coarse errors">())
    s.draws = draws;
  return s;
}

// Settings of direct light beyond the first surface. In pictures, light samples replace
// certificates where those cost more, and from error `coarse` on fewer samples do. Measuring points
// keep certificates: they share cells, so all of them would have the same noise.
CertifiedSettings drawn_beyond(const MethodInput& in, double coarse) {
  constexpr int draws = 16, few_draws = 8;  // powers of two stratify best
  CertifiedSettings s = settings_beyond_first(in);
  if (in.cells->view != nullptr && !is_left_out<"light samples beyond first hits">())
    s.draws = in.settings.error >= coarse ? few_draws : draws;
  return s;
}
// Settings at the further viewing rays of a pixel, each of which is a small part of it, and at what
// gloss shows along any viewing ray.
CertifiedSettings settings_of_further(const MethodInput& in) {
  CertifiedSettings s = drawn_beyond(in, 0.1);
  if (!is_left_out<"more samples of matte hits">()) s.matte_draw_factor = 2;
  return s;
}
// Settings of the further viewing rays of a picture of direct light alone. The error of a pixel
// comes from what its many further rays hit, so each of them may err by more in its own light.
CertifiedSettings settings_of_further_direct(const MethodInput& in) {
  constexpr double more = 3;
  constexpr int few_draws = 8;  // a power of two stratifies best
  CertifiedSettings s =
      certified_settings(std::min(more * in.settings.error, 1.0), in.scene.scene.lights.size());
  s.draws = few_draws;
  return s;
}

// Returns the i-th batch of viewing rays for learning lights, anywhere in the picture.
ViewingRays rays_to_learn_from(const PictureView& view, uint64_t seed, uint32_t i) {
  constexpr uint32_t size = 256;  // as many as PathIntegrator follows at a time
  const uint64_t stream = hash_of(seed, stream::learned_lights);
  const Vec2 extent{float(view.image.width()), float(view.image.height())};
  ViewingRays rays;
  for (uint32_t j = i * size; j < (i + 1) * size; ++j) {
    const Vec2 at = SobolGroup(stream, purpose_camera, j).get2(0);
    rays.rays.push_back(view.ray(at.x * extent.x, at.y * extent.y));
    rays.streams.push_back(hash_of(stream, uint64_t{j}));
    rays.samples.push_back(0);
  }
  return rays;
}

// True if paths may replace cells or gathers. They may not where indirect light was chosen
// explicitly, without a picture, or where a store keeps the cells.
bool may_be_by_paths(const MethodInput& in) {
  return in.settings.indirect == Indirect::automatic && in.cells->view != nullptr &&
         in.cells->store == nullptr;
}

std::string sampling_in_words(const CertifiedSettings& s) {
  std::string text = fmt::format("certificates and masks, allowed error {:.3g}", s.error);
  if (s.draws > 0) text += fmt::format("; {} light samples where those cost less", s.draws);
  return text;
}

void add_direct_parts(MethodPlan& plan, const MethodInput& in) {
  plan.parts.push_back({"direct light", sampling_in_words(plan.first),
                        fmt::format("{} lights, asked error {:.3g}", in.scene.scene.lights.size(),
                                    in.settings.error)});
}

void plan_cells(MethodPlan& plan, const MethodInput& in) {
  plan.light = PlannedLight::cells;
  plan.first = settings_of_first(in);
  plan.further = settings_of_further(in);
  plan.at_cells = settings_of_cells(in);
  plan.most_cells = in.cells->most_cells;
  if (plan.forecast) {
    // Preparation takes at most half of what path tracing would take, half of it for direct light.
    const double budget = std::min(plan.forecast->rays_for_cells, plan.forecast->rays / 2);
    plan.most_cells = budget / rays_of_cell;
    plan.rays_for_direct = budget / 2;
  }
  add_direct_parts(plan, in);
  plan.parts.push_back({"direct light of further viewing rays", sampling_in_words(plan.further),
                        "each is a small part of its pixel"});
  std::string reason = "the default for reflected light";
  if (plan.forecast)
    reason = fmt::format(
        "paths would take {:.3g} viewing rays per pixel and {:.3g} million rays; paths replace "
        "cells "
        "if there are more than {:.3g}",
        plan.forecast->viewing_rays, plan.forecast->rays * 1e-6, plan.most_cells);
  plan.parts.push_back({"reflected light", "gathered from cells", reason});
}

}  // namespace

// A cell averages eight or more hits, so few samples suffice from a smaller error on, and its hits
// share the samples of the sky.
CertifiedSettings settings_of_cells(const MethodInput& in) {
  CertifiedSettings s = drawn_beyond(in, 0.02);
  if (in.cells->view != nullptr) s.viewing_rays = int(hits_per_cell);
  return s;
}

int most_by_paths(int asked) {
  constexpr int most = 1 << 14;
  return asked > 0 ? asked : most;
}

PathForecast forecast(const MethodInput& in, const PathOptions& options,
                      std::shared_ptr<const LearnedLights>& learned) {
  const PictureView& view = *in.cells->view;
  const uint64_t seed = in.cells->seed;
  LightsToLearn learn;
  if (may_learn_lights(in.scene) && !is_left_out<"learned lights">())
    learn = [&](double budget, Counters& counters) {
      const auto batch = [&](uint32_t i) { return rays_to_learn_from(view, seed, i); };
      if (!learned) learned = learn_lights(in.scene, batch, budget, in.settings.threads, counters);
      return learned;
    };
  return forecast_paths(paths_by_light_sampling(in.scene, options), learn, view,
                        error_by_paths(in.settings.error),
                        most_by_paths(in.settings.most_viewing_rays), seed, in.cells->counters);
}

double error_beyond_first(const MethodInput& in) {
  constexpr double least_error = 0.1;
  return std::max(in.settings.error, least_error);
}

CertifiedSettings settings_beyond_first(const MethodInput& in) {
  constexpr int few_points = 8;
  CertifiedSettings s = certified_settings(error_beyond_first(in), in.scene.scene.lights.size());
  if (!is_left_out<"few samples of gloss">()) s.gloss_samples = few_points;
  return s;
}

MethodPlan plan_certified(const MethodInput& in) {
  MethodPlan plan;
  const bool keeps_cells = in.cells != nullptr && in.cells->store != nullptr;
  if (in.scene.scene.lights.empty() && !keeps_cells) {
    plan.parts.push_back({"all light", "path tracing", "the scene has no light to certify"});
    return plan;
  }
  if (in.settings.measures_by_paths) {
    plan.light = PlannedLight::sensor_paths;
    plan.first = settings_of_first(in);
    add_direct_parts(plan, in);
    plan.parts.push_back({"reflected light", "paths", "few points: cells would cost more"});
    return plan;
  }
  if (needs_cells(Method::certified, in.settings.indirect)) {
    plan.may_end_paths_at_cells = may_be_by_paths(in) && !is_left_out<"cached paths">();
    if (may_be_by_paths(in) && !is_left_out<"paths instead of cells">()) {
      const PathForecast f = forecast(in, {}, plan.learned_lights);
      if (f.is_within(most_by_paths(in.settings.most_viewing_rays))) plan.forecast = f;
    }
    if (plan.forecast && plan.forecast->rays_for_cells < 0) {
      plan.parts.push_back(
          {"all light", "path tracing",
           fmt::format("the asked error takes {:.3g} viewing rays per pixel, {:.3g} million rays "
                       "in all; cells would cost more even if making them were free",
                       plan.forecast->viewing_rays, plan.forecast->rays * 1e-6)});
      return plan;
    }
    plan_cells(plan, in);
    return plan;
  }
  plan.first = settings_of_first(in);
  plan.light = PlannedLight::direct;
  add_direct_parts(plan, in);
  if (in.settings.is_direct_only() && in.settings.is_refined) {
    plan.light = PlannedLight::staged_direct;
    plan.further = settings_of_further_direct(in);
    plan.parts.push_back({"direct light of further viewing rays", sampling_in_words(plan.further),
                          "each is a small part of its pixel"});
  }
  plan.parts.push_back({"reflected light", "none", "not asked for"});
  return plan;
}

std::string as_text(const MethodPlan& plan) {
  std::string text;
  for (const PlannedPart& p : plan.parts)
    text += fmt::format("{}: {}{}\n", p.part, p.choice,
                        p.reason.empty() ? std::string() : " (" + p.reason + ")");
  return text;
}

}  // namespace troffer
