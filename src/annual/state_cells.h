// Changes that one state of a window group makes in the cells and rows that all states share
// (transport_cells.h): differences of shared rows, and cells of its own, with their rows. Own cells
// lie on surfaces that only this state shows, and on all else that only it sees, such as the ground
// behind its windows.
#pragma once

#include <span>
#include <vector>

#include "annual/transport_cells.h"

namespace troffer {

class StateCells {
 public:
  // Traces all rays. region: of the state. Incomplete once `stop` is set.
  StateCells(const TransportCells& shared, const PreparedScene& scene, const RayRegions& regions,
             size_t region, const TransportRays& rays, uint64_t seed, int threads,
             const StopFlag& stop);

  // Own cells. In links their numbers follow those of the shared cells.
  size_t cell_count() const { return map_.size(); }
  size_t near_count() const { return near_; }  // own cells below this number are seen by sensors
  std::span<const CellHit> hits(size_t own_cell) const { return places_.of(own_cell); }
  const SightRows& rows() const { return rows_; }                        // of own cells
  const SightRows& more_of_rows() const { return more_of_rows_; }        // to add to shared rows
  const SightRows& more_of_sensors() const { return more_of_sensors_; }  // to add to sensors' rows
  bool is_grey() const { return is_grey_; }                              // with the shared links
  float coat_factor(const CellHit& hit, float cosine) const {
    return coat_factor_at(walks_, hit, cosine);
  }

 private:
  SightRows differences(const RayLog& log, size_t rows, int threads, const StopFlag& stop);
  void trace_rows(const TransportRays& rays, size_t end_of_all, int rounds, uint64_t seed,
                  int threads, const StopFlag& stop);
  std::vector<uint32_t> cells_of(const CellsSeen& seen);

  const TransportCells& shared_;
  const RayRegions& regions_;
  size_t region_;
  GatherWalks walks_;
  CellMap map_;
  CellPlaces places_;
  size_t near_ = 0;
  bool is_grey_ = true;
  SightRows rows_, more_of_rows_, more_of_sensors_;
};

}  // namespace troffer
