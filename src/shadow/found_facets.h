// Memory of one source's shadows from cluster to cluster: the facets that rays hit, the places
// where facet lists were over budget, and the result of pilot rays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace troffer {

// Occluders of one source that rays hit. The caller keeps one per source. Not thread safe.
class FoundFacets {
 public:
  struct Entry {
    uint32_t id;
    uint32_t hits;
  };
  // Counts hits of these facets. Sorts `ids`.
  void add(std::vector<uint32_t>& ids);
  // Keeps the `most` facets with most hits and halves their counts.
  void trim(size_t most);
  const std::vector<Entry>& entries() const { return entries_; }

  // Notes that lists were over budget for a cluster of `radius` around `centre`. is_over_budget_at
  // is true for clusters close to such a place. Metres.
  void note_over_budget(const Vec3d& centre, double radius) {
    over_budget_.push_back({centre, radius});
  }
  bool is_over_budget_at(const Vec3d& centre, double radius) const;
  bool is_over_budget() const { return !over_budget_.empty(); }

  // Result of pilot rays straight to the source (direct_rays.h). It is the same for all clusters,
  // because the viewing rays of a pixel share a sequence across clusters.
  struct DirectRayPlan {
    double open_share = 0.5;
    double rays = 0;  // per receiver; 0: no pilot rays yet

    bool is_known() const { return rays > 0; }
    // True if so much is open that no single facet can hide all of it.
    bool is_partly_open() const { return is_known() && open_share > 0.05; }
  };
  DirectRayPlan dense;
  // Whether an object on the front side of the source's plane comes within rounding distance of
  // the source. If so, shadow rays must not stop short of the source.
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
