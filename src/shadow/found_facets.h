// What a source's shadows have taught so far: the facets that rays met, and that lists stay too
// long.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace troffer {

// Occluders of one source that rays met: kept from cluster to cluster by the caller.
class FoundFacets {
 public:
  struct Entry {
    uint32_t id;
    uint32_t hits;
  };
  // Rays met these facets; sorts them.
  void add(std::vector<uint32_t>& ids);
  // Keeps the `most` most hit, and halves the counts.
  void trim(size_t most);
  const std::vector<Entry>& entries() const { return entries_; }
  bool is_hopeless = false;  // a cluster's lists stayed too long
  // Whether anything that rises over the source's plane comes within rounding of the source: rays
  // must then look at it to its end.
  enum class Rim : uint8_t { unknown, none, some };
  Rim rim = Rim::unknown;

 private:
  std::vector<Entry> entries_;
};

}  // namespace troffer
