#include "radiosity/source_contributions.h"

#include <algorithm>

#include "base/random.h"

namespace troffer {

uint64_t light_stream(const RadiosityOptions& options, uint32_t light) {
  return hash_of(options.seed, light);
}

RayBudget ray_budget(const RadiositySolution& s, uint32_t source) {
  RayBudget b;
  b.max_rays = std::max(1, s.options.max_rays);
  b.tolerance = std::max(1e-6f, s.options.tolerance);
  b.reference = s.mean_irradiance;
  if (s.is_light(source)) {
    b.whole_rays = s.options.light_rays;
    b.whole_from = s.options.light_share;
  }
  return b;
}

Shooter whole_patch_shooter(const RadiositySolution& s, uint32_t patch) {
  Shooter shooter = patch_shooter(s.mesh, patch, s.shot_radiance[patch]);
  const Patch& p = s.mesh.patches[patch];
  std::vector<float> sent;
  for (uint32_t i = p.first_point; i < p.last_point; ++i)
    sent.push_back(luminance(s.mesh.points[i].reflectance * s.irradiance(i)));
  set_parts(shooter, s.mesh, patch, sent);
  return shooter;
}

void source_contributions(const Tracer& tracer, const LightPrimitives& primitives,
                          const RadiositySolution& s, uint32_t source,
                          std::span<const uint32_t> points, std::span<StoredContribution> out,
                          TransferScratch& scratch) {
  const bool is_light = s.is_light(source);
  const Shooter shooter =
      is_light ? light_shooter(primitives, source) : whole_patch_shooter(s, s.patch_of(source));
  scratch.transfers.assign(points.size(), {});
  if (!shooter.pieces.empty())
    transfer_to(
        shooter, s.mesh.points, points, tracer, ray_budget(s, source),
        is_light ? light_stream(s.options, source) : hash_of(s.options.seed, source, ~uint64_t(0)),
        scratch.transfers, scratch);
  for (size_t i = 0; i < points.size(); ++i) {
    const Transfer& t = scratch.transfers[i];
    out[i] = {source, t.unoccluded * t.visibility, t.unoccluded};
  }
}

}  // namespace troffer
