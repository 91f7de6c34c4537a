// Directed edges between numbered vertices -> the polygon on their left, while polygons change.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace troffer {

// A hash table with open addressing; it grows as needed.
class EdgeTable {
 public:
  static constexpr uint32_t none = 0xffffffffu, many = 0xfffffffeu;

  // Empties it, with room for so many edges.
  void clear(size_t edges);
  // The polygon; none; or many, where more than one has been there at a time.
  uint32_t find(uint32_t from, uint32_t to) const;
  void insert(uint32_t from, uint32_t to, uint32_t polygon);
  // What has been of many stays so.
  void erase(uint32_t from, uint32_t to);

 private:
  static constexpr uint64_t no_key = ~uint64_t(0);
  size_t slot(uint64_t key) const;
  std::vector<std::pair<uint64_t, uint32_t>> entries_;
  size_t used_ = 0;
};

}  // namespace troffer
