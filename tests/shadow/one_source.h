// One source and one cluster, prepared for any stage of certified visibility.
#pragma once

#include <vector>

#include "brute_force.h"

namespace troffer::test {

inline std::vector<ShadowReceiver> receivers_on_floor(int side, float spacing) {
  std::vector<ShadowReceiver> r;
  for (int i = 0; i < side * side; ++i) {
    const Vec3 p{spacing * float(i % side), spacing * float(i / side), 0}, up{0, 0, 1};
    r.push_back({p, up, up, p + up * 4e-6f, hash_of(uint64_t(i), 3u)});
  }
  return r;
}

// A square of one metre, two metres above the floor.
inline FlatSource ceiling_source() {
  return {{{-0.5, -0.5, 2}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}}, {}};
}

struct OneSource {
  explicit OneSource(std::vector<ShadowReceiver> r, FlatSource s = ceiling_source())
      : receivers(std::move(r)), source(std::move(s)), sums(receivers.size()) {
    cluster.set(receivers);
    unoccluded_light(cluster, source, unoccluded);
    wanted_points.assign(receivers.size(), 0);
    for (uint32_t i = 0; i < receivers.size(); ++i) members.push_back(i);
    queue.sources.push_back(ray_source());
  }
  OneSource(const OneSource&) = delete;
  OneSource& operator=(const OneSource&) = delete;

  SourceTask task() {
    return {options, cluster, request_for(source, found), 0, unoccluded, nullptr, wanted_points};
  }
  SourceResults results() { return {sums, queue, counters}; }
  RaySource ray_source() {
    RaySource s;
    s.point = source.plane.origin;
    s.normal = source.plane.normal;
    s.tolerance = 1e-5;
    s.found = &found;
    return s;
  }
  MaskFrame frame() const { return {source.plane, options.lattice, false, cluster.hull.centre}; }
  FacetList list_of(const MaskFrame& frame, const std::vector<Quad>& facets) const {
    FacetList list;
    for (const Quad& q : facets) list.add(frame, q);
    list.finish();
    return list;
  }

  std::vector<ShadowReceiver> receivers;
  FlatSource source;
  CertifiedOptions options;
  ShadowCluster cluster;
  FoundFacets found;
  std::vector<float> unoccluded;
  std::vector<uint32_t> wanted_points, members;
  std::vector<CellSum> sums;
  RayQueue queue;
  CertifiedCounters counters;
};

}  // namespace troffer::test
