#include "shadow/receiver_clusters.h"

#include <algorithm>
#include <cmath>

namespace troffer {

namespace {

struct Seed {
  Vec3 position, normal;
  float magnitude;
  bool is_flat;
  uint32_t count;
};

bool is_coplanar(const Seed& s, const Vec3& p, const Vec3& n) {
  return length_squared(n - s.normal) < 1e-13f &&
         std::abs(dot(Vec3d(s.normal), Vec3d(p) - Vec3d(s.position))) <= 2e-7 * double(s.magnitude);
}

float largest_coordinate(const Vec3& p) {
  return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

}  // namespace

void cluster_receivers(std::span<const Vec3> positions, std::span<const Vec3> normals, float reach,
                       ReceiverClusters& out) {
  const auto n = uint32_t(positions.size());
  std::vector<Seed> seeds;
  std::vector<uint32_t> cluster(n);
  // planes first: a cluster that begins flat stays flat
  for (uint32_t i = 0; i < n; ++i) {
    uint32_t c = 0;
    while (c < seeds.size() && !is_coplanar(seeds[c], positions[i], normals[i])) ++c;
    if (c == seeds.size())
      seeds.push_back(
          {positions[i], normals[i], std::max(largest_coordinate(positions[i]), 1e-3f), true, 0});
    ++seeds[c].count;
    cluster[i] = c;
  }
  // receivers that share their plane with few others form curved clusters
  constexpr uint32_t alone = 4;
  std::vector<Seed> curved;
  std::vector<uint32_t> joined(seeds.size(), 0);
  const auto flat_clusters = uint32_t(seeds.size());
  for (uint32_t c = 0; c < flat_clusters; ++c) {
    joined[c] = c;
    if (seeds[c].count >= alone) continue;
    uint32_t k = 0;
    while (k < curved.size() && (dot(curved[k].normal, seeds[c].normal) < 0.94f ||
                                 length(curved[k].position - seeds[c].position) > reach))
      ++k;
    if (k == curved.size()) curved.push_back(seeds[c]);
    joined[c] = flat_clusters + k;
  }
  std::vector<uint32_t> counts(flat_clusters + curved.size() + 1, 0);
  for (uint32_t i = 0; i < n; ++i) {
    cluster[i] = joined[cluster[i]];
    ++counts[cluster[i] + 1];
  }
  for (size_t c = 1; c < counts.size(); ++c) counts[c] += counts[c - 1];
  out.order.resize(n);
  std::vector<uint32_t> next(counts.begin(), counts.end() - 1);
  for (uint32_t i = 0; i < n; ++i) out.order[next[cluster[i]]++] = i;
  out.starts.assign(1, 0);
  for (size_t c = 1; c < counts.size(); ++c)
    if (counts[c] > counts[c - 1]) out.starts.push_back(counts[c]);
}

}  // namespace troffer
