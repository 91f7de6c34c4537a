#include "radiosity/patch_shots.h"

#include "base/random.h"
#include "base/units.h"
#include "radiosity/source_contributions.h"

namespace troffer {

namespace {

constexpr size_t most_row_bytes = 256u << 20;
// A patch's row serves all of its shots, which together send more than the first: rays are as many
// as if it sent so much more.
constexpr float expected_growth = 1.6f;

}  // namespace

PatchShots::PatchShots(const Tracer& tracer, RadiositySolution& solution, int threads)
    : solution_(solution),
      rows_(solution.mesh, tracer, threads, most_row_bytes),
      seen_(solution.mesh.points.size(), 0.0f),
      has_shot_(solution.mesh.patches.size(), 0) {
  shot_.unoccluded.assign(seen_.size(), 0);
  shot_.received.assign(seen_.size(), 0);
}

bool PatchShots::shoot(uint32_t patch, const Rgb& power, std::span<const float> unshot_at,
                       const StopFlag& stop, Rgb& radiance) {
  RadiositySolution& s = solution_;
  shot_.blocks.clear();
  radiance = {};
  Shooter shooter = patch_shooter(s.mesh, patch, Rgb{1});
  if (!(shooter.area() > 0)) return true;
  radiance = power / (pi_f * shooter.area());
  set_parts(shooter, s.mesh, patch, unshot_at);
  const uint32_t source = s.light_count + patch;
  const Rgb all = s.shot_radiance[patch] + radiance;
  if (!rows_.shoot(patch, shooter, expected_growth * luminance(all), ray_budget(s, source),
                   hash_of(s.options.seed, source, s.shots), stop, has_shot_[patch] == 0, seen_,
                   shot_))
    return false;
  s.shot_radiance[patch] = all;
  has_shot_[patch] = 1;
  return true;
}

}  // namespace troffer
