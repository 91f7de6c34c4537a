#include "app/render_statistics.h"

#include <nlohmann/json.hpp>

#include "app/process.h"
#include "app/up_json.h"

namespace troffer {

namespace {

// Returns the name of a rendering's end, for the statistics.
const char* name_of(RenderEnd end) {
  switch (end) {
    case RenderEnd::complete:
      return "complete";
    case RenderEnd::good_enough:
      return "error_limit";
    case RenderEnd::out_of_time:
      return "time_limit";
    case RenderEnd::stopped:
      break;
  }
  return "signal";
}

nlohmann::ordered_json plan_json(const MethodPlan& plan) {
  nlohmann::ordered_json j = {{"parts", nlohmann::ordered_json::array()}};
  for (const PlannedPart& p : plan.parts)
    j["parts"].push_back({{"part", p.part}, {"choice", p.choice}, {"reason", p.reason}});
  if (plan.forecast)
    j["forecast"] = {{"paths_per_pixel", plan.forecast->viewing_rays},
                     {"light_samples", plan.forecast->lights.samples_at_first},
                     {"learned_lights", plan.forecast->lights.learned != nullptr},
                     {"rays_by_paths", plan.forecast->rays},
                     {"rays_for_cells", plan.forecast->rays_for_cells}};
  return j;
}

// Work that costs.h weighs, besides viewing rays.
nlohmann::ordered_json work_json(const Counters& n) {
  return {{"extension_rays", n.extension_rays},
          {"shadow_rays", n.shadow_rays},
          {"clusters", n.clusters},
          {"masks", n.masks},
          {"mask_facets", n.mask_facets},
          {"points", n.points}};
}

nlohmann::ordered_json preparation_json(const Counters& n) {
  nlohmann::ordered_json j = work_json(n);
  j["viewing_rays"] = n.viewing_rays;
  j["pairs"] = n.lit_certified + n.masked + n.mixed;
  j["nan_samples"] = n.nan_samples;
  return j;
}

}  // namespace

std::string statistics_json(const RenderCommand& c, const RenderResult& result,
                            const RenderSeconds& t, double total, const UpDecision& up) {
  const RenderStatistics& s = result.statistics;
  const Counters& n = s.counters;
  nlohmann::ordered_json j;
  j["version"] = TROFFER_VERSION;
  j["method"] = c.method;
  j["width"] = s.width;
  j["height"] = s.height;
  j["threads"] = thread_count(c.options.threads);
  if (c.options.group != nullptr) j["processes"] = c.options.group->size();
  j["viewing_rays"] = n.viewing_rays;
  j["surrogate_samples"] = n.surrogates;
  j["shadow_rays"] = n.shadow_rays;
  j["shadow_rays_per_viewing_ray"] =
      n.viewing_rays > 0 ? double(n.shadow_rays) / double(n.viewing_rays) : 0.0;
  j["lit_certified"] = n.lit_certified;
  j["dark_certified"] = n.dark_certified;
  j["masked"] = n.masked;
  j["mixed"] = n.mixed;
  j["nan_samples"] = n.nan_samples;
  j["preparation"] = preparation_json(s.preparation);
  j["viewing_error"] = {{"relative_rms", s.viewing_errors.relative_rms},
                        {"share_above_1_percent", s.viewing_errors.share_above}};
  j["seconds"] = {{"import", t.import},
                  {"build", t.build},
                  {"preprocess", s.preprocess_seconds},
                  {"render", t.render},
                  {"write", t.write},
                  {"total", total},
                  {"preprocess_cpu", t.preprocess_cpu},
                  {"render_cpu", t.render_cpu},
                  {"total_cpu", cpu_seconds()}};
  if (s.is_by_paths) j["by_paths"] = true;
  if (s.cells.cells > 0)
    j["cells"] = {{"count", s.cells.cells},
                  {"size", s.cells.size},
                  {"rays", s.cells.rays},
                  {"entries", s.cells.entries},
                  {"rounds", s.cells.rounds},
                  {"iterations", s.cells.iterations},
                  {"unresolved", s.cells.unresolved},
                  {"memory_mb", s.cells.bytes / 1e6},
                  {"seconds", s.cells.seconds}};
  j["peak_memory_mb"] = peak_memory_mb();
  j["extension_rays"] = n.extension_rays;
  j["work"] = work_json(n);
  j["plan"] = plan_json(s.plan);
  j["spp"] = c.options.spp;
  j["max_spp"] = most_viewing_rays(c.options).in_pixel;
  j["seed"] = c.options.seed;
  j["up"] = up_json(up);
  j["is_complete"] = result.is_complete;
  j["ended_by"] = name_of(result.end);
  j["estimated_error"] = s.estimated_error;
  j["share_done"] = s.share_done;
  j["gaps_filled"] = s.gaps_filled;
  j["unsampled"] = s.unsampled;
  return j.dump(2) + "\n";
}

}  // namespace troffer
