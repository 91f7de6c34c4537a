// Hash table from directed edges between numbered vertices to the polygon on their left. Used by
// RegionMerger, whose polygons change while it runs. Edges with more than one polygon are marked
// and stay so.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace troffer {

// Open addressing; grows as needed.
class EdgeTable {
 public:
  static constexpr uint32_t none = 0xffffffffu, many = 0xfffffffeu;

  // Empties the table and reserves room for that many edges.
  void clear(size_t edges);
  // Returns the polygon; `none`; or `many` if the edge has had more than one at a time.
  uint32_t find(uint32_t from, uint32_t to) const;
  void insert(uint32_t from, uint32_t to, uint32_t polygon);
  // Removes an edge. An edge with `many` stays so.
  void erase(uint32_t from, uint32_t to);

 private:
  static constexpr uint64_t no_key = ~uint64_t(0);
  size_t slot(uint64_t key) const;
  std::vector<std::pair<uint64_t, uint32_t>> entries_;
  size_t used_ = 0;
};

}  // namespace troffer
