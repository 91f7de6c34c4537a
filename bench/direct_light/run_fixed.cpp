#include <ctime>

#include "methods.h"
#include "shadow_rays.h"

namespace troffer::bench {

double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

void Answers::reset(size_t pairs) {
  visible.assign(pairs, 0);
  variance.assign(pairs, 0);
  unoccluded.clear();
  kinds.clear();
  counters = {};
  rays = 0;
  seconds = 0;
}

void run_fixed(const Pairs& pairs, uint32_t n, Traversal traversal, uint64_t seed, Answers& out) {
  constexpr size_t most_waiting = 2048;  // rays; they fit into the second-level cache
  const bool is_single = traversal == Traversal::single;
  const RayOrder order = is_single ? RayOrder::as_drawn : RayOrder::compact;
  ShadowRays m;
  std::vector<size_t> waiting;
  out.reset(pairs.size());
  const double start = thread_seconds();
  const auto flush = [&] {
    m.is_hidden.resize(m.rays.size());
    pairs.scene.prepared.tracer.occluded(m.rays, m.is_hidden,
                                         is_single ? Coherence::none : Coherence::coherent);
    for (size_t p = 0; p < waiting.size(); ++p) {
      float all = 0, seen = 0;
      for (size_t i = p * n; i < (p + 1) * n; ++i) {
        all += m.weights[i];
        seen += m.is_hidden[i] != 0 ? 0.0f : m.weights[i];
      }
      out.visible[waiting[p]] = seen / all;
    }
    out.rays += m.rays.size();
    m.clear();
    waiting.clear();
  };
  for (size_t t = 0; t < pairs.tiles.size(); ++t) {
    const Tile& tile = pairs.tiles[t];
    for (size_t s = 0; s < pairs.scene.sources.size(); ++s)
      for (size_t r = 0; r < tile.size(); ++r) {
        const HitPoint hit{tile.positions[r], tile.normals[r], tile.origins[r]};
        const uint64_t stream = stream_of(tile, r, s, seed);
        const FlatSource& source = pairs.scene.sources[s];
        const bool is_any =
            is_near(source, hit.position)
                ? add_shadow_rays_by_angle(source, *pairs.scene.pieces[s], hit, stream, n, order, m)
                : add_shadow_rays(source, hit, stream, 0, n, order, false, m);
        if (!is_any) {
          if (pairs.unoccluded[pairs.index(t, s, r)] > 0) out.visible[pairs.index(t, s, r)] = 0.5f;
          continue;
        }
        waiting.push_back(pairs.index(t, s, r));
        if (m.rays.size() >= most_waiting) flush();
      }
  }
  flush();
  out.seconds = thread_seconds() - start;
}

}  // namespace troffer::bench
