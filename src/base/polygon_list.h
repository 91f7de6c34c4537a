// Polygons over shared vertices, as plain lists, and which edges they share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/vec.h"

namespace troffer {

// Polygon i has the corners corners[first[i]] … corners[first[i + 1] - 1], in order around it:
// indices into positions that are kept elsewhere.
struct PolygonList {
  std::vector<uint32_t> corners;
  std::vector<uint32_t> first{0};

  size_t size() const { return first.size() - 1; }
  std::span<const uint32_t> operator[](size_t i) const {
    return {corners.data() + first[i], first[i + 1] - first[i]};
  }
  void add(std::span<const uint32_t> polygon) {
    corners.insert(corners.end(), polygon.begin(), polygon.end());
    first.push_back(uint32_t(corners.size()));
  }
};

// Vertices at the same place get the same number, that of one of them.
std::vector<uint32_t> weld(std::span<const Vec3> positions);

// An edge of one polygon between vertices low < high; is_forward: it runs from low to high.
struct PolygonEdge {
  uint32_t low, high;
  uint32_t polygon;
  bool is_forward;
};

// All edges but those from a vertex to itself, sorted by low, high and polygon: those of several
// polygons stand together. O(n log n) at worst, linear where few polygons meet at a vertex.
std::vector<PolygonEdge> sorted_edges(const PolygonList& polygons, size_t vertex_count);

// Calls visit for each pair of vertices with the edges between them, in the same order. The edges
// are made a part at a time: large lists take little memory.
using EdgeVisitor = std::function<void(std::span<const PolygonEdge>)>;
void for_each_edge(const PolygonList& polygons, size_t vertex_count, const EdgeVisitor& visit);
void for_each_edge(std::span<const PolygonEdge> sorted, const EdgeVisitor& visit);

}  // namespace troffer
