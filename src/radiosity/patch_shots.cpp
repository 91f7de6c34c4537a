#include "radiosity/patch_shots.h"

#include <algorithm>

#include "base/random.h"
#include "base/units.h"
#include "radiosity/source_contributions.h"
#include "radiosity/stored_list.h"

namespace troffer {

namespace {

constexpr size_t most_row_bytes = 256u << 20;
// Factor on the first shot's radiance that determines the number of rays. A patch's row serves all
// of its shots, which together send more than the first.
constexpr float expected_growth = 1.6f;

}  // namespace

PatchShots::PatchShots(const Tracer& tracer, RadiositySolution& solution, int threads)
    : solution_(solution),
      rows_(solution.mesh, tracer, threads, most_row_bytes),
      seen_(rows_.receivers().slots(), 0.0f),
      has_shot_(solution.mesh.patches.size(), 0) {
  shot_.unoccluded.assign(seen_.size(), 0);
  shot_.received.assign(seen_.size(), 0);
}

bool PatchShots::shoot(uint32_t patch, const Rgb& power, std::span<const float> unshot_at,
                       std::span<const float> least_listed, const StopFlag& stop, Rgb& radiance) {
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
                   hash_of(s.options.seed, source, s.shots), stop, has_shot_[patch] == 0,
                   {least_listed, hidden_importance * luminance(radiance)}, seen_, shot_))
    return false;
  limit();
  s.shot_radiance[patch] = all;
  has_shot_[patch] = 1;
  return true;
}

// Limits the form factors of a point to a hemisphere. Coincident or nearly coincident surfaces of
// several meshes can exceed it; the patches' contributions are then scaled down.
void PatchShots::limit() {
  constexpr float most = 1.03f;  // tolerates the usual error of form factors
  for (const uint32_t index : shot_.blocks) {
    const ReceiverBlock& b = rows_.receivers().blocks[index];
    float most_seen = 0;  // includes padding slots, which see nothing
    for (uint32_t i = 0; i < slots_of(b); ++i)
      most_seen = std::max(most_seen, seen_[b.first_slot + i]);
    if (most_seen <= most) continue;
    for (uint32_t slot = b.first_slot; slot < b.first_slot + b.count; ++slot) {
      if (seen_[slot] <= most) continue;
      shot_.unoccluded[slot] *= most / seen_[slot];
      shot_.received[slot] *= most / seen_[slot];
    }
  }
}

}  // namespace troffer
