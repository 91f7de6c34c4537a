// Cells of one replicate, with the rays that join sensors to cells and cells to each other. It is
// the matrix of the light transport without its right-hand sides (reflected_light.h).
//
// Each replicate makes its own cells from its own rays, so replicates are independent draws of the
// whole calculation. Lengths are in metres.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "annual/link_rows.h"
#include "annual/ray_log.h"
#include "annual/ray_regions.h"
#include "base/parallel.h"
#include "cells/cell_map.h"
#include "gather/gather_walks.h"
#include "transport/prepared_scene.h"

namespace troffer {

// Places on cells where their rays and direct light start: for each cell, a random choice among all
// rays that hit it. Cells' own hits (cells/cell_map.h) are the first ones, which would be those of
// the first sensors and so lie on one part of the cell.
class CellPlaces {
 public:
  explicit CellPlaces(uint64_t seed) : seed_(seed) {}
  // Adds a ray's hit of a cell.
  void add(uint32_t cell, const CellHit& hit);
  size_t size() const { return cells_.size(); }
  std::span<const CellHit> of(size_t cell) const {
    const Places& p = cells_[cell];
    return std::span(p.hits).first(std::min(size_t(p.seen), p.hits.size()));
  }

 private:
  struct Places {
    std::array<CellHit, hits_per_cell> hits;
    uint32_t seen = 0;  // rays that hit the cell
  };
  uint64_t seed_;
  std::vector<Places> cells_;
};

// Factor of direct light at a place by its coat (bsdf/bsdf.h), 1 without one.
float coat_factor_at(const GatherWalks& walks, const CellHit& hit, float cosine);

struct TransportRays {
  int of_sensor = 64;                       // gather rays of a sensor
  int of_near_cell = 48, of_far_cell = 16;  // rays of cells that sensors see, and of others
};

// Cells are followed for so many rounds; further ones then number a few per cent of all at most.
constexpr int most_cell_rounds = 12;
constexpr size_t most_transport_cells = size_t(1) << 20;
constexpr size_t cell_tasks_at_a_time = 4096;

// Makes the rows of some cells: `count` of them from number `first` on, from copies of their
// places, which change as further rays hit cells.
class CellTasks {
 public:
  CellTasks(const CellPlaces& places, size_t first, size_t count);
  // The tasks, for so many rays per cell below number `near`, and from there on. number: added to
  // the number of a cell in its random stream.
  std::vector<CellTask> tasks(const TransportRays& rays, size_t near, uint64_t seed,
                              size_t number) const;

 private:
  size_t first_;
  std::vector<std::vector<CellHit>> from_;
};

class TransportCells {
 public:
  // Traces all rays, and logs those that meet `regions`, which are widened by the size of a cell,
  // or may do so. Incomplete once `stop` is set.
  TransportCells(const PreparedScene& scene, std::span<const CellHit> sensors,
                 const TransportRays& rays, const RayRegions& regions, uint64_t seed, int threads,
                 const StopFlag& stop);

  size_t cell_count() const { return cells_->size(); }
  const CellMap& map() const { return *cells_; }
  // Cells below this number are seen by sensors.
  size_t near_count() const { return near_; }
  std::span<const CellHit> hits(size_t cell) const { return places_.of(cell); }
  const SightRows& sensors() const { return sensors_; }
  const SightRows& rows() const { return rows_; }
  const RayLog& sensor_log() const { return sensor_log_; }
  const RayLog& row_log() const { return row_log_; }
  // True if all links are grey, so that luminances suffice.
  bool is_grey() const { return is_grey_; }
  // Factor of direct light at a place by its coat (bsdf/bsdf.h), 1 without one.
  float coat_factor(const CellHit& hit, float cosine) const {
    return coat_factor_at(walks_, hit, cosine);
  }

 private:
  void trace_rows(const TransportRays& rays, uint64_t seed, int threads, const StopFlag& stop);
  void see_log(RayLog& log, int threads, const StopFlag& stop) const;

  GatherWalks walks_;
  std::unique_ptr<CellMap> cells_;
  CellPlaces places_;
  size_t near_ = 0;
  bool is_grey_ = true;
  SightRows sensors_, rows_;
  RayLog sensor_log_, row_log_;
};

}  // namespace troffer
