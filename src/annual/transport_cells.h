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

#include "base/parallel.h"
#include "cells/cell_map.h"
#include "gather/gather_walks.h"
#include "transport/prepared_scene.h"

namespace troffer {

// A cell that a row sees, and the share of the row's irradiance that its irradiance brings.
struct CellLink {
  uint32_t cell = 0;
  Rgb weight;
};

// A way out of the scene that a row sees by mirrors, glass or gloss: irradiance per π × radiance.
struct OutsideLink {
  Vec3 direction;
  Rgb weight;
};

// Links of all rows, one row after the other.
template <class Link>
class LinkRows {
 public:
  void add(std::span<const Link> links) {
    links_.insert(links_.end(), links.begin(), links.end());
    begin_.push_back(links_.size());
  }
  size_t size() const { return begin_.size() - 1; }
  std::span<const Link> all() const { return links_; }
  std::span<const Link> of(size_t row) const {
    return std::span(links_).subspan(begin_[row], begin_[row + 1] - begin_[row]);
  }

 private:
  std::vector<size_t> begin_{0};
  std::vector<Link> links_;
};

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

struct TransportRays {
  int of_sensor = 64;                       // gather rays of a sensor
  int of_near_cell = 48, of_far_cell = 16;  // rays of cells that sensors see, and of others
};

class TransportCells {
 public:
  // Traces all rays. Incomplete once `stop` is set.
  TransportCells(const PreparedScene& scene, std::span<const CellHit> sensors,
                 const TransportRays& rays, uint64_t seed, int threads, const StopFlag& stop);

  size_t cell_count() const { return cells_->size(); }
  // Cells below this number are seen by sensors.
  size_t near_count() const { return near_; }
  std::span<const CellHit> hits(size_t cell) const { return places_.of(cell); }
  const LinkRows<CellLink>& sensors() const { return sensors_; }
  const LinkRows<CellLink>& rows() const { return rows_; }
  const LinkRows<OutsideLink>& sensors_outside() const { return sensors_outside_; }
  const LinkRows<OutsideLink>& rows_outside() const { return rows_outside_; }
  // True if all links are grey, so that luminances suffice.
  bool is_grey() const { return is_grey_; }
  // Factor of direct light at a place by its coat (bsdf/bsdf.h), 1 without one.
  float coat_factor(const CellHit& hit, float cosine) const;

 private:
  const PreparedScene& scene_;
  GatherWalks walks_;
  std::unique_ptr<CellMap> cells_;
  CellPlaces places_;
  size_t near_ = 0;
  bool is_grey_ = true;
  LinkRows<CellLink> sensors_, rows_;
  LinkRows<OutsideLink> sensors_outside_, rows_outside_;
};

}  // namespace troffer
