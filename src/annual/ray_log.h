// Rays of rows that may see something else in another state: those that meet the region of a state
// (ray_regions.h). They are traced again in each such state, and only the differences are added to
// the rows that all states share.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "annual/link_rows.h"
#include "annual/ray_regions.h"
#include "gather/gather_walks.h"

namespace troffer {

class RayLog {
 public:
  // Logs rays that meet the regions. takes_all: walks go on at mirrors, glass and gloss, so any ray
  // may see a difference.
  void begin(const RayRegions& regions, bool takes_all) {
    regions_ = regions;
    takes_all_ = takes_all;
    of_region_.resize(regions.size());
  }

  // Adds rays of tasks, whose rows begin with number `first_row`. scales: of the rows (add_rows);
  // empty: 1.
  void add(const GatherWalks& walks, std::span<const CellTask> tasks, std::span<const float> scales,
           size_t first_row);
  // Returns all rays as tasks of one ray each, or those of a region.
  std::vector<CellTask> tasks() const;
  std::vector<CellTask> tasks(size_t region) const;
  // Sets what the rays see in the scene of all rows; one row per ray.
  void set_seen(SightRows seen) { seen_ = std::move(seen); }
  // Returns what must be added to `rows` rows in a state. seen: what the rays of the region see in
  // it; one row per ray.
  SightRows differences(size_t region, const SightRows& seen, size_t rows) const;

 private:
  struct LoggedRay {
    uint32_t row = 0, sample = 0;
    uint64_t stream = 0;
    float weight = 0;  // of what the ray sees, in its row
    CellHit from;
  };

  CellTask task_of(uint32_t ray) const;
  bool is_same(uint32_t ray, std::span<const CellLink> cells,
               std::span<const OutsideLink> outside) const;

  RayRegions regions_;
  bool takes_all_ = false;
  std::vector<LoggedRay> rays_;                   // ordered by row
  std::vector<std::vector<uint32_t>> of_region_;  // indices of rays
  SightRows seen_;
};

}  // namespace troffer
