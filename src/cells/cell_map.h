// Cache cells: small parts of surfaces, made where rays hit, that share one value of irradiance.
// Rows, direct light and gather rays refer to cells by their numbers. Lengths are in metres.
//
// A hit belongs to a cell of its voxel and of the axis direction to which its normal points most.
// Voxels have the scene's cell size, half of it where the ray came from nearby, twice or more where
// it came from far away. A voxel can hold several cells; a hit takes the first compatible one. A
// cell is compatible if it lies in the plane or on the curved surface of the hit. If something
// stands in the voxel, the cell must also be visible from the hit. Cells therefore never span the
// two sides of a thin wall, two boards of a shelf, or two rooms on one floor.
//
// A cell within which direct light from nearby sources varies much (a lamp close to a wall) is
// replaced by cells of half the size. These may be halved again.
//
// Cells are made in the order of add() and never change, so they are the same for any number of
// threads. Adding to a copy does not change the original.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "cells/cell_hit.h"
#include "trace/tracer.h"

namespace troffer {

constexpr uint32_t no_cell = 0xffffffffu;
// Least cell size of any map, metres. It keeps the numbers of voxels within range.
constexpr float least_cell = 1e-6f;
// Hits that a cell keeps: its rays start there, and direct light is computed there.
constexpr size_t hits_per_cell = 8;
// The same for cells that the picture's own gather rays meet (CellMap::add, is_asked). At the edge
// of a shadow light varies much within a cell, and some pictures get most of their light from few
// cells.
constexpr size_t hits_of_asked_cell = 32;

// Outline of a voxel on the plane of a surface in it, the surface's normal, and the height in
// metres at which rays start.
struct CellOutline {
  std::array<Vec3, 4> corners;
  Vec3 normal;
  float offset = 0;
};

class CellMap {
 public:
  // True if one value of irradiance is too little for a piece of surface. is_asked: the picture
  // looks at it.
  using IsUneven = std::function<bool(const CellOutline&, bool is_asked)>;

  // size: of voxels, metres. The tracer must outlive the map.
  CellMap(const Tracer& tracer, float size);

  float size_of_cells() const { return size_; }
  // Distance in metres below which rays read cells of half the size.
  float near() const { return 3 * size_; }
  size_t size() const { return anchors_.size(); }
  size_t bytes() const;

  // Returns the cell that a ray of this length has hit, or no_cell. Any number of threads may call
  // it while nothing is added.
  uint32_t find(const CellHit& hit, float distance) const;
  // Returns the finest cell there of those for rays no shorter than near(), or no_cell.
  uint32_t find_from_afar(const CellHit& hit) const;
  // Prefetch what find() will read, in two steps: the voxel, and then its first cell. Do each step
  // for many hits, so that the memory has arrived by the next. The key that prefetch_voxel()
  // returns is also for find(), with the same hit and distance.
  uint64_t prefetch_voxel(const CellHit& hit, float distance) const;
  void prefetch_cell(uint64_t voxel) const;
  uint32_t find(const CellHit& hit, float distance, uint64_t voxel) const;
  // Returns the cell as find() does, or makes one. is_asked: the ray is one that the picture will
  // send.
  uint32_t add(const CellHit& hit, float distance, bool is_asked = false);
  // Sets the test by which cells made from here on are halved. Halves are tested again, up to a
  // limit.
  void halve_where(IsUneven is_uneven) { is_uneven_ = std::move(is_uneven); }
  // Stops the existing cells from taking further hits.
  void freeze() { frozen_ = anchors_.size(); }
  size_t frozen() const { return frozen_; }

  // Hits of one cell. Empty after forget_hits(), and for cells that smaller ones replace.
  std::span<const CellHit> hits(size_t cell) const {
    if (hits_.empty()) return {};
    const Hits& h = hits_[cell];
    return h.more == no_cell ? std::span(h.hits.data(), size_t(h.count))
                             : std::span<const CellHit>(more_hits_[h.more]);
  }
  const Vec3& position(size_t cell) const { return anchors_[cell].position; }
  // Switches the marking of narrow cells on or off, for existing and further cells. A cell is
  // narrow on a sub-cell feature, such as a slat, a bar or a lip about as narrow as the cell, or a
  // thin pillar. Light differs between its sides, which are seen from different places.
  void resolve_narrow(bool looks, int threads);
  bool is_narrow(size_t cell) const { return anchors_[cell].is_narrow; }
  // True if a cell made for the hit of a ray of this length would be narrow.
  bool would_be_narrow(const CellHit& hit, float distance) const;
  void forget_hits() {
    hits_ = {};
    more_hits_ = {};
  }

 private:
  // Rays of this many cell sizes read cells twice as wide, those of twice as many cells four times
  // as wide, and so on. Cells are .06 of the median ray length for fine errors, so these rays are
  // about 4 times as long as the median, or more in coarse pictures.
  static constexpr float sizes_of_far = 64;
  static constexpr int32_t most_doublings = 12;

  friend struct CellMapParts;  // cell_store.cpp: reads and writes the members

  struct Anchor {
    Vec3 position, normal;
    uint32_t next = no_cell;  // next cell of the same voxel
    float size = 0;
    bool is_divided = false;  // something stands in the voxel: hits must see the cell
    bool is_halved = false;   // smaller cells replace it
    bool is_narrow = false;   // on a sub-cell feature; only while resolve_narrow() is on
  };
  struct Hits {
    std::array<CellHit, hits_per_cell> hits;
    uint32_t count = 0;
    uint32_t more = no_cell;  // index in more_hits_ of all hits, if they do not fit here
  };
  struct Slot {
    uint64_t key = 0;
    uint32_t first = no_cell;
  };
  // End of a search: the cell, and the last one of the voxel.
  struct Found {
    uint32_t cell = no_cell, last = no_cell;
  };

  size_t first_slot(uint64_t key) const { return key & (slots_.size() - 1); }
  size_t slot_of(uint64_t key) const;
  Found search(uint32_t first, const CellHit& hit) const;
  bool sees(const Anchor& a, const CellHit& hit) const;
  bool is_divided(const CellHit& hit, const CellOutline& outline, float size) const;
  bool ends_both_ways(const Vec3& position, const Vec3& normal, float size) const;
  // Level of the voxels that rays of this length read. Voxels of level k are 2^-k times the cell
  // size wide. Without coarse levels, a picture of a gap of a few centimetres would fill the room
  // around it with millions of cells some millimetres wide.
  int32_t first_level(float distance) const {
    if (distance < near()) return 1;
    int32_t level = 0;
    for (float far = sizes_of_far * size_; distance >= far && level > -most_doublings; far *= 2)
      --level;
    return level;
  }
  float size_at(int32_t level) const { return std::ldexp(size_, -level); }
  uint32_t make(const CellHit& hit, int32_t level, bool is_asked);
  uint32_t add_at(const CellHit& hit, int32_t level, bool is_asked);
  void keep(const CellHit& hit, bool is_asked, Hits& hits);
  void grow();

  const Tracer& tracer_;
  float size_;
  std::vector<Anchor> anchors_;
  std::vector<Hits> hits_;
  std::vector<std::vector<CellHit>> more_hits_;
  std::vector<Slot> slots_;  // open addressing; their number is a power of two
  bool resolves_narrow_ = false;
  size_t used_ = 0;
  size_t frozen_ = 0;  // cells below this number get no more hits
  IsUneven is_uneven_;
};

}  // namespace troffer
