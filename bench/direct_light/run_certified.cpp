#include "base/random.h"
#include "integrate/shadow_world.h"
#include "methods.h"
#include "shadow/certified_cluster.h"

namespace troffer::bench {

namespace {

void take(const Pairs& pairs, size_t tile, size_t source, std::span<const uint32_t> members,
          std::span<const SourceVisibility> answers, Answers& out) {
  for (size_t i = 0; i < members.size(); ++i) {
    const SourceVisibility& a = answers[i];
    const size_t at = pairs.index(tile, source, members[i]);
    out.kinds[at] = a.answer;
    if (a.answer == ShadowAnswer::below) continue;
    out.visible[at] = a.visible;
    out.variance[at] = a.variance;
    out.unoccluded[at] = a.unoccluded;
  }
}

void take_rays(const Pairs& pairs, size_t tile, std::span<const uint32_t> members,
               std::span<const RayAnswer> rays, Answers& out) {
  for (const RayAnswer& r : rays) {
    const size_t at = pairs.index(tile, r.tag, members[r.member]);
    const float unoccluded = out.unoccluded[at];
    out.rays += r.rays;
    out.visible[at] += r.light / unoccluded;
    out.variance[at] += r.light_variance / (unoccluded * unoccluded);
  }
}

}  // namespace

// The one place that drives the estimator.
void run_certified(const Pairs& pairs, const CertifiedOptions& options, uint64_t seed,
                   Answers& out) {
  const DirectScene& scene = pairs.scene;
  out.reset(pairs.size());
  out.unoccluded.assign(pairs.size(), 0);
  out.kinds.assign(pairs.size(), ShadowAnswer::below);
  const double start = thread_seconds();
  CertifiedEstimator estimator(options);
  ShadowWorld world(scene.prepared.scene, scene.occluders, scene.prepared.tracer);
  ReceiverClusters clusters;
  std::vector<ShadowReceiver> receivers;
  std::vector<SourceVisibility> answers;
  std::vector<FoundFacets> found;
  for (size_t t = 0; t < pairs.tiles.size(); ++t) {
    const Tile& tile = pairs.tiles[t];
    cluster_receivers(tile.positions, tile.normals, scene.reach, clusters);
    found.assign(scene.sources.size(), {});
    for (size_t c = 0; c < clusters.size(); ++c) {
      const auto members = clusters.members(c);
      receivers.clear();
      for (const uint32_t m : members)
        receivers.push_back({tile.positions[m], tile.normals[m], tile.normals[m], tile.origins[m],
                             stream_of(tile, m, 0, seed)});
      answers.resize(members.size());
      estimator.begin_cluster(receivers);
      for (size_t s = 0; s < scene.sources.size(); ++s) {
        const SourceTerms terms{hash_of(s, 7u), float(scene.radiance[s]), uint32_t(s), nullptr};
        estimator.evaluate(scene.sources[s], terms, world, found[s], answers);
        take(pairs, t, s, members, answers, out);
      }
      take_rays(pairs, t, members, estimator.end_cluster(world), out);
    }
  }
  out.seconds = thread_seconds() - start;
  out.counters = estimator.counters();
}

}  // namespace troffer::bench
