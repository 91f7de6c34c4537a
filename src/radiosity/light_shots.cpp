#include "radiosity/light_shots.h"

#include <algorithm>

#include "base/frame.h"
#include "base/random.h"
#include "base/warp.h"
#include "radiosity/source_contributions.h"

namespace troffer {

namespace {

constexpr uint32_t purpose_open = 3;

// Traces rays that start like the shooter's light; returns the share that leaves the scene.
OpenShare open_share_of(const Shooter& shooter, const Tracer& tracer, uint32_t rays_wanted,
                        uint64_t stream) {
  std::vector<double> sums;
  double sum = 0;
  for (const LightPrimitive& p : shooter.pieces) sums.push_back(sum += double(p.power));
  if (!(sum > 0)) return {};
  std::vector<Ray> rays;
  for (uint32_t k = 0; k < rays_wanted; ++k) {
    const SobolGroup group(stream, purpose_open, k);
    const Vec2 u = group.get2(), v = group.get2(2);
    const double x = (k + 0.5) / rays_wanted * sum;
    const auto i = std::min(size_t(std::upper_bound(sums.begin(), sums.end(), x) - sums.begin()),
                            sums.size() - 1);
    const LightPrimitive& p = shooter.pieces[i];
    const Vec3 at = point_on(p, u);
    Vec3 normal = Vec3(p.normal);
    if (p.shape == PrimitiveShape::sphere)
      normal = (at - p.centroid) * ((p.is_inside_out ? -1 : 1) / p.radius);
    if (p.is_two_sided && k % 2 == 1) normal = -normal;
    Ray r;
    r.origin = at + normal * shooter.offset;
    r.direction = Frame(normal).to_world(cosine_hemisphere_from_square(v));
    rays.push_back(r);
  }
  std::vector<Hit> hits(rays.size());
  tracer.closest(rays, hits);
  double leaving = 0;
  for (const Hit& h : hits) leaving += h.is_valid() ? 0 : 1;
  return open_share(leaving / rays_wanted, rays_wanted, leaving == 0);
}

}  // namespace

LightShots::LightShots(const Tracer& tracer, const LightPrimitives& primitives,
                       const RadiositySolution& solution, int threads)
    : tracer_(tracer),
      lights_(primitives),
      solution_(solution),
      threads_(threads),
      transfers_(solution.mesh.points.size()),
      scratch_(size_t(thread_count(threads))) {
  constexpr uint32_t size = 128;
  const size_t points = transfers_.size();
  for (uint32_t first = 0; first < points; first += size)
    chunks_.push_back({first, uint32_t(std::min<size_t>(points, first + size)), 0});
}

LightShot LightShots::shoot(uint32_t light, bool is_closed, const StopFlag& stop) {
  constexpr uint32_t most_open_rays = 1 << 20;
  const uint32_t open_rays =
      std::clamp(most_open_rays / std::max(1u, solution_.light_count), 64u, 4096u);
  const Shooter shooter = light_shooter(lights_, light);
  LightShot shot;
  shot.has_surface = !shooter.pieces.empty();
  if (!shot.has_surface) return shot;
  for (const LightPrimitive& p : shooter.pieces) shot.power += double(p.power);
  const uint64_t stream = light_stream(solution_.options, light);
  if (!is_closed) shot.open = open_share_of(shooter, tracer_, open_rays, stream);
  find_transfers(shooter, light, stream, stop);
  return shot;
}

void LightShots::find_transfers(const Shooter& shooter, uint32_t light, uint64_t stream,
                                const StopFlag& stop) {
  const RayBudget budget = ray_budget(solution_, light);
  parallel_for_slots(chunks_.size(), threads_, [&](size_t index, size_t slot) {
    if (stop.load(std::memory_order_relaxed)) return;
    Chunk& c = chunks_[index];
    const std::span<Transfer> transfers(transfers_.data() + c.first, c.last - c.first);
    c.rays += transfer(shooter, {solution_.mesh.points.data() + c.first, transfers.size()}, tracer_,
                       budget, stream, c.first, transfers, scratch_[slot]);
    for (Transfer& t : transfers)
      if (!is_finite(t.unoccluded)) t = {};
  });
}

uint64_t LightShots::rays() const {
  uint64_t sum = 0;
  for (const Chunk& c : chunks_) sum += c.rays;
  return sum;
}

}  // namespace troffer
