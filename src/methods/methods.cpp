#include "methods/methods.h"

#include <algorithm>
#include <array>
#include <optional>

#include "base/error.h"
#include "kj92/bintree_direct.h"
#include "kj92/radiosity_indirect.h"
#include "methods/certified_method.h"
#include "methods/path.h"
#include "transport/fixed_direct.h"
#include "transport/wave_integrator.h"

namespace troffer {

namespace {

MethodPlan plan_path(const MethodInput& in) {
  MethodPlan plan;
  plan.parts.push_back({"all light", "path tracing",
                        in.settings.is_direct_only() ? "direct light alone" : "asked for"});
  return plan;
}
std::unique_ptr<Integrator> make_path(const MethodPlan&, const MethodInput& in) {
  return std::make_unique<PathIntegrator>(
      in.scene, PathOptions{in.settings.depth, in.settings.is_direct_only()});
}

MethodPlan plan_kj92(const MethodInput& in) {
  MethodPlan plan;
  plan.light = PlannedLight::radiosity;
  plan.parts.push_back({"direct light", "bintrees over selected sources",
                        "sources and their classes come from the radiosity solution"});
  plan.parts.push_back(
      {"reflected light", in.settings.is_direct_only() ? "none" : "radiosity, interpolated", ""});
  return plan;
}
// The bintrees sample selected patches like lights.
std::unique_ptr<Integrator> make_kj92(const MethodPlan&, const MethodInput& in) {
  TROFFER_CHECK(in.radiosity != nullptr);
  std::unique_ptr<IndirectLight> indirect;
  if (!in.settings.is_direct_only())
    indirect = std::make_unique<RadiosityIndirect>(in.scene, *in.radiosity);
  return std::make_unique<WaveIntegrator>(
      in.scene, std::make_unique<BintreeDirect>(in.scene, *in.radiosity, in.settings.trees),
      std::move(indirect));
}

MethodPlan plan_fixed(const MethodInput& in) {
  MethodPlan plan;
  plan.light = PlannedLight::direct;
  plan.parts.push_back({"direct light",
                        std::to_string(in.settings.shadow_rays) + " shadow rays to every source",
                        ""});
  return plan;
}
std::unique_ptr<Integrator> make_fixed(const MethodPlan&, const MethodInput& in) {
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
  static const std::array<MethodRow, 5> methods;
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

const std::array<MethodRow, 5> MethodTable::methods{{
    {
        .name = "certified",
        .plan = plan_certified,
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
        .plan = plan_kj92,
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
        .plan = plan_fixed,
        .make = make_fixed,
        .rays_per_sample = fixed_rays,
        .is_direct_only = true,
        .most_rays_per_tile = most_rays_of_tile,
        .rays_of_measuring_sample = 16,  // one set of shadow rays to every source
    },
    {
        .name = "path",
        .plan = plan_path,
        .make = make_path,
        .rays_per_sample = path_rays,
    },
    {
        .name = "cached-path",
        .plan = plan_cached_path,
        .make = make_cached_path,
        .rays_per_sample = path_rays,
        .usual_indirect = Indirect::cells,
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

MethodPlan plan_method(Method method, const MethodInput& input) {
  return method.row().plan(input);
}

std::unique_ptr<Integrator> make_integrator(Method method, const MethodPlan& plan,
                                            const MethodInput& input) {
  return method.row().make(plan, input);
}

std::unique_ptr<Integrator> make_integrator(Method method, const MethodInput& input) {
  return make_integrator(method, plan_method(method, input), input);
}

}  // namespace troffer
