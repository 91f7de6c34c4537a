// Rows of links: which cells, and which ways out of the scene, a sensor or a cell sees. They form
// the sparse matrix of light transport. Used by transport_cells.h and state_cells.h.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gather/cell_rays.h"

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

// Sorts links by cell and adds up those to the same cell.
void merge_links(std::vector<CellLink>& links);

// Rows with their ways out of the scene.
struct SightRows {
  LinkRows<CellLink> cells;
  LinkRows<OutsideLink> outside;

  size_t size() const { return cells.size(); }
  void add_empty() {
    cells.add({});
    outside.add({});
  }
};

// True if all links treat all channels alike.
bool are_grey(const LinkRows<CellLink>& rows);

// Appends one row per task of `seen`, which is ordered by task. cells: cell of each hit; hits whose
// cell is no_cell are left out. scales: null, or receives the factor on each row that keeps its sum
// below one, as the balance of light needs it; then rows are scaled by it.
void add_rows(const CellsSeen& seen, std::span<const CellTask> tasks,
              std::span<const uint32_t> cells, std::vector<float>* scales, SightRows& rows);

}  // namespace troffer
