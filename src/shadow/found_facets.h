// What a source's shadows have taught so far: the facets that rays met, and that lists stay too
// long.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vec.h"

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

  // A cluster about `centre` within `radius` had lists that stayed too long; and whether one has,
  // that close.
  void note_over_budget(const Vec3d& centre, double radius) {
    over_budget_.push_back({centre, radius});
  }
  bool is_over_budget_at(const Vec3d& centre, double radius) const;
  bool is_over_budget() const { return !over_budget_.empty(); }

  // What pilots say of rays straight to the source (direct_rays.h): for all clusters alike, so that
  // rays of a pixel's hits on several of them share a sequence.
  struct Dense {
    double open_share = 0.5;
    double rays = 0;  // of a receiver; 0: nobody has looked yet

    bool is_known() const { return rays > 0; }
    // Where much is open no single facet hides it all.
    bool is_partly_open() const { return is_known() && open_share > 0.05; }
  };
  Dense dense;
  // Whether anything that rises over the source's plane comes within rounding of the source: rays
  // must then look at it to its end.
  enum class Rim : uint8_t { unknown, none, some };
  Rim rim = Rim::unknown;

 private:
  struct Place {
    Vec3d centre;
    double radius;
  };
  std::vector<Place> over_budget_;
  std::vector<Entry> entries_;
};

}  // namespace troffer
