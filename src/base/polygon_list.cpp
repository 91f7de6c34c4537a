#include "base/polygon_list.h"

#include <algorithm>
#include <numeric>

namespace troffer {

std::vector<uint32_t> weld(std::span<const Vec3> positions) {
  std::vector<uint32_t> order(positions.size()), welded(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto less = [&](uint32_t i, uint32_t j) {
    const Vec3 &a = positions[i], &b = positions[j];
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    return a.z < b.z;
  };
  std::sort(order.begin(), order.end(), less);
  for (size_t i = 0; i < order.size(); ++i)
    welded[order[i]] = i > 0 && !less(order[i - 1], order[i]) ? welded[order[i - 1]] : order[i];
  return welded;
}

std::vector<PolygonEdge> sorted_edges(const PolygonList& polygons, size_t vertex_count) {
  const auto for_each = [&](const auto& act) {
    for (uint32_t p = 0; p < polygons.size(); ++p) {
      const std::span<const uint32_t> c = polygons[p];
      for (size_t i = 0; i < c.size(); ++i) {
        const uint32_t from = c[i], to = c[i + 1 == c.size() ? 0 : i + 1];
        if (from != to) act(PolygonEdge{std::min(from, to), std::max(from, to), p, from < to});
      }
    }
  };
  // Dealt to their low vertices, then sorted there.
  std::vector<uint32_t> begin(vertex_count + 1, 0);
  for_each([&](const PolygonEdge& e) { ++begin[e.low + 1]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<PolygonEdge> edges(begin.back());
  std::vector<uint32_t> next(begin.begin(), begin.end() - 1);
  for_each([&](const PolygonEdge& e) { edges[next[e.low]++] = e; });
  for (size_t v = 0; v < vertex_count; ++v)
    std::sort(edges.begin() + begin[v], edges.begin() + begin[v + 1],
              [](const PolygonEdge& a, const PolygonEdge& b) {
                return a.high != b.high ? a.high < b.high : a.polygon < b.polygon;
              });
  return edges;
}

}  // namespace troffer
