// Polygons over shared vertices, and their common edges. Used by merge_polygons.h and for
// adjacency.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/vec.h"

namespace troffer {

// Corners of polygon i are corners[first[i]] to corners[first[i + 1] - 1], in order: indices into
// positions that the caller keeps.
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

// Returns an index for each vertex; vertices at the same place share the index of one of them.
std::vector<uint32_t> weld(std::span<const Vec3> positions);

// Edge of one polygon between vertices low < high. is_forward: the polygon runs from low to high.
struct PolygonEdge {
  uint32_t low, high;
  uint32_t polygon;
  bool is_forward;
};

// Returns all edges except those from a vertex to itself, sorted by low, high and polygon, so that
// common edges are adjacent. O(n log n) at worst; linear if few polygons meet at a vertex.
std::vector<PolygonEdge> sorted_edges(const PolygonList& polygons, size_t vertex_count);

// Calls visit for each pair of vertices with the edges between them, in the same order. Edges are
// made in parts, so large lists need little memory.
using EdgeVisitor = std::function<void(std::span<const PolygonEdge>)>;
void for_each_edge(const PolygonList& polygons, size_t vertex_count, const EdgeVisitor& visit);
void for_each_edge(std::span<const PolygonEdge> sorted, const EdgeVisitor& visit);

}  // namespace troffer
