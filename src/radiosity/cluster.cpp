#include "radiosity/cluster.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "base/box.h"
#include "base/random.h"

namespace troffer {

namespace {

Vec3 unit_normal(const BaseGeometry& g, const BaseTriangle& t) {
  const Vec3d a(g.positions[t.vertices[0]]);
  const Vec3d n =
      cross(Vec3d(g.positions[t.vertices[1]]) - a, Vec3d(g.positions[t.vertices[2]]) - a);
  return Vec3(normalize(n));
}

Box box_of(const BaseGeometry& g, const BaseTriangle& t) {
  Box b;
  for (const uint32_t v : t.vertices) b.grow(g.positions[v]);
  return b;
}

// Hash of the grid cell and the nearest signed axis of the normal. A collision joins triangles that
// are far apart, which costs only accuracy.
uint64_t loose_key(const BaseGeometry& g, const BaseTriangle& t, uint32_t group, double size) {
  const Vec3 c = box_of(g, t).centre(), n = unit_normal(g, t), a = abs(n);
  const size_t axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  const auto cell = [&](float x) {
    return uint64_t(int64_t(std::clamp(std::floor(double(x) / size), -1e15, 1e15)));
  };
  return hash_of(t.surface, group, cell(c.x), cell(c.y), cell(c.z), axis * 2 + (n[axis] < 0));
}

}  // namespace

Adjacency::Adjacency(const BaseGeometry& geometry) {
  struct Edge {
    uint64_t key;
    uint32_t triangle;
    uint32_t slot;
  };
  std::vector<Edge> edges;
  neighbours_.assign(6 * geometry.triangles.size(), no_cluster);
  for (uint32_t i = 0; i < geometry.triangles.size(); ++i) {
    const BaseTriangle& t = geometry.triangles[i];
    if (t.is_degenerate) continue;
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t a = t.vertices[k], b = t.vertices[(k + 1) % 3];
      edges.push_back({uint64_t(std::min(a, b)) << 32 | std::max(a, b), i, k});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.key != b.key ? a.key < b.key : a.triangle < b.triangle;
  });
  for (size_t i = 1; i < edges.size(); ++i) {
    const Edge &a = edges[i - 1], &b = edges[i];
    if (a.key != b.key) continue;
    neighbours_[6ull * a.triangle + 2 * a.slot] = b.triangle;
    neighbours_[6ull * b.triangle + 2 * b.slot + 1] = a.triangle;
  }
}

Clusters join_triangles(const BaseGeometry& g, const Adjacency& adjacency,
                        const std::vector<uint8_t>& candidate, const std::vector<uint32_t>& group,
                        const JoinLimits& limits) {
  Clusters out;
  out.label.assign(g.triangles.size(), no_cluster);
  std::unordered_map<uint64_t, uint32_t> cells;
  std::vector<uint32_t> queue;
  for (uint32_t i = 0; i < g.triangles.size(); ++i) {
    if (candidate[i] == 0 || out.label[i] != no_cluster) continue;
    if (limits.is_loose) {
      const uint64_t key = loose_key(g, g.triangles[i], group[i], limits.size);
      const auto [it, is_new] = cells.try_emplace(key, out.count);
      out.count += is_new;
      out.label[i] = it->second;
      continue;
    }
    const Vec3 seed_normal = unit_normal(g, g.triangles[i]);
    Box box = box_of(g, g.triangles[i]);
    out.label[i] = out.count;
    queue.assign(1, i);
    for (size_t head = 0; head < queue.size(); ++head) {
      const uint32_t* near = adjacency.neighbours(queue[head]);
      for (size_t k = 0; k < 6; ++k) {
        const uint32_t j = near[k];
        if (j == no_cluster || candidate[j] == 0 || out.label[j] != no_cluster) continue;
        if (group[j] != group[i]) continue;
        if (double(dot(unit_normal(g, g.triangles[j]), seed_normal)) < limits.cos_angle) continue;
        Box grown = box;
        grown.grow(box_of(g, g.triangles[j]));
        if (double(grown.diagonal()) > limits.size) continue;
        box = grown;
        out.label[j] = out.count;
        queue.push_back(j);
      }
    }
    ++out.count;
  }
  return out;
}

}  // namespace troffer
