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

namespace {

// Sorted edges whose lower vertex is in [first, end). `begin` has the index of each vertex's first
// edge among all edges.
void edges_from(const PolygonList& polygons, const std::vector<uint32_t>& begin, size_t first,
                size_t end, std::vector<PolygonEdge>& edges) {
  edges.resize(begin[end] - begin[first]);
  std::vector<uint32_t> next(begin.begin() + std::ptrdiff_t(first),
                             begin.begin() + std::ptrdiff_t(end));
  for (uint32_t& n : next) n -= begin[first];
  for (uint32_t p = 0; p < polygons.size(); ++p) {
    const std::span<const uint32_t> c = polygons[p];
    for (size_t i = 0; i < c.size(); ++i) {
      const uint32_t from = c[i], to = c[i + 1 == c.size() ? 0 : i + 1];
      const uint32_t low = std::min(from, to);
      if (from == to || low < first || low >= end) continue;
      edges[next[low - first]++] = {low, std::max(from, to), p, from < to};
    }
  }
  for (size_t v = first; v < end; ++v)
    std::sort(edges.begin() + (begin[v] - begin[first]),
              edges.begin() + (begin[v + 1] - begin[first]),
              [](const PolygonEdge& a, const PolygonEdge& b) {
                return a.high != b.high ? a.high < b.high : a.polygon < b.polygon;
              });
}

// Index of the first edge of each lower vertex, and the total number.
std::vector<uint32_t> edge_begins(const PolygonList& polygons, size_t vertex_count) {
  std::vector<uint32_t> begin(vertex_count + 1, 0);
  for (size_t p = 0; p < polygons.size(); ++p) {
    const std::span<const uint32_t> c = polygons[p];
    for (size_t i = 0; i < c.size(); ++i) {
      const uint32_t from = c[i], to = c[i + 1 == c.size() ? 0 : i + 1];
      if (from != to) ++begin[std::min(from, to) + 1];
    }
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  return begin;
}

}  // namespace

std::vector<PolygonEdge> sorted_edges(const PolygonList& polygons, size_t vertex_count) {
  std::vector<PolygonEdge> edges;
  edges_from(polygons, edge_begins(polygons, vertex_count), 0, vertex_count, edges);
  return edges;
}

void for_each_edge(const PolygonList& polygons, size_t vertex_count, const EdgeVisitor& visit) {
  constexpr size_t least_part = 1 << 20, most_parts = 16;
  const std::vector<uint32_t> begin = edge_begins(polygons, vertex_count);
  const size_t part = std::max(least_part, begin.back() / most_parts);
  std::vector<PolygonEdge> edges;
  for (size_t first = 0; first < vertex_count;) {
    size_t end = first + 1;
    while (end < vertex_count && begin[end + 1] - begin[first] <= part) ++end;
    edges_from(polygons, begin, first, end, edges);
    for_each_edge(edges, visit);
    first = end;
  }
}

void for_each_edge(std::span<const PolygonEdge> sorted, const EdgeVisitor& visit) {
  for (size_t i = 0; i < sorted.size();) {
    size_t end = i + 1;
    while (end < sorted.size() && sorted[end].low == sorted[i].low &&
           sorted[end].high == sorted[i].high)
      ++end;
    visit(sorted.subspan(i, end - i));
    i = end;
  }
}

}  // namespace troffer
