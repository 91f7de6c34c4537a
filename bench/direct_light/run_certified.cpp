#include "base/random.h"
#include "certified/shadow_world.h"
#include "methods.h"
#include "shadow/receiver_clusters.h"

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
    out.rays += a.rays;
  }
}

}  // namespace

// Works like certified/certified_lights.cpp.
void run_certified(const Pairs& pairs, const CertifiedOptions& options, uint64_t seed,
                   Answers& out) {
  const DirectScene& scene = pairs.scene;
  out.reset(pairs.size());
  out.unoccluded.assign(pairs.size(), 0);
  out.kinds.assign(pairs.size(), ShadowAnswer::below);
  const double start = thread_seconds();
  CertifiedMemory memory;
  ShadowWorld world(scene.prepared.scene, scene.occluders, scene.prepared.tracer);
  ReceiverClusters clusters;
  std::vector<ShadowReceiver> receivers;
  ShadowCluster cluster;
  std::vector<LightRequest> requests;
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
      cluster.set(receivers);
      requests.clear();
      for (size_t k = 0; k < scene.sources.size(); ++k)
        requests.push_back(
            {&scene.sources[k], nullptr, hash_of(k, 7u), float(scene.radiance[k]), &found[k]});
      certified_light(cluster, requests, nullptr, world, options, memory,
                      [&](uint32_t source, std::span<const SourceVisibility> answers) {
                        take(pairs, t, source, members, answers, out);
                      });
    }
  }
  out.seconds = thread_seconds() - start;
  out.counters = memory.counters;
}

}  // namespace troffer::bench
