// Cells: small parts of surfaces, made where rays hit, that share one value of irradiance.
//
// A hit belongs to the cell of its voxel (of the scene's cell size, half of it where the ray came
// from near, or twice as large and more where it came from far away), of the side of space that its
// normal points to, and, among several of the same voxel, to the first that it is compatible with:
// in one plane with it or on one curved surface, and, where something stands in the voxel, seen
// from it. So neither the two sides of a thin wall share a cell, nor the boards of a shelf, nor two
// rooms that stand on one floor.
//
// Where light straight from sources nearby differs much within a voxel (a lamp close to a wall),
// there are cells of half its size in place of one, and of half that, and so on.
//
// Cells are made one after the other in the order of add(), and never change: the same cells for
// any number of threads. A copy can be added to without a change to those it was copied from.
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
// No map has smaller ones: within reach of float positions their voxels have numbers.
constexpr float least_cell = 1e-6f;
// Hits of a cell that are kept: those from which its rays start and at which it is lit.
constexpr size_t hits_per_cell = 8;
// … of one to which a picture's own rays come (CellMap::add, is_asked). Light changes much within a
// cell at the edge of a shadow, and some pictures get theirs from few cells.
constexpr size_t hits_of_asked_cell = 32;

// A voxel's outline on the plane of a surface in it, the surface's normal, and how far above it
// rays set out.
struct CellOutline {
  std::array<Vec3, 4> corners;
  Vec3 normal;
  float offset = 0;
};

class CellMap {
 public:
  // Whether one value of irradiance is too little for a piece of surface; is_asked: that the
  // picture looks at.
  using IsUneven = std::function<bool(const CellOutline&, bool is_asked)>;

  // size: of voxels, metres. The tracer must outlive it.
  CellMap(const Tracer& tracer, float size);

  float size_of_cells() const { return size_; }
  // Light from nearer than this comes from half cells.
  float near() const { return 3 * size_; }
  size_t size() const { return anchors_.size(); }
  size_t bytes() const;

  // The cell of what a ray of this length has hit, or no_cell. Any number of threads may call it
  // while nothing is added.
  uint32_t find(const CellHit& hit, float distance) const;
  // The finest one there of those seen from no nearer than near(), or no_cell.
  uint32_t find_from_afar(const CellHit& hit) const;
  // Asks for the memory that find() will read, in two steps, so that it is there when many others
  // have been asked for meanwhile: of which voxel, and of what is in that. The voxel's key is for
  // find(), too, of the same hit and distance.
  uint64_t expect_voxel(const CellHit& hit, float distance) const;
  void expect_cell(uint64_t voxel) const;
  uint32_t find(const CellHit& hit, float distance, uint64_t voxel) const;
  // As find(), made if there is none. is_asked: by one of the rays that the picture will send.
  uint32_t add(const CellHit& hit, float distance, bool is_asked = false);
  // Of cells that are made from here on; any number of halvings, up to a limit.
  void halve_where(IsUneven is_uneven) { is_uneven_ = std::move(is_uneven); }
  // From here on the cells that there are keep the hits that they have.
  void freeze() { frozen_ = anchors_.size(); }
  size_t frozen() const { return frozen_; }

  // Of one cell; empty after forget_hits(), and where there are smaller ones in its place.
  std::span<const CellHit> hits(size_t cell) const {
    if (hits_.empty()) return {};
    const Hits& h = hits_[cell];
    return h.more == no_cell ? std::span(h.hits.data(), size_t(h.count))
                             : std::span<const CellHit>(more_hits_[h.more]);
  }
  const Vec3& position(size_t cell) const { return anchors_[cell].position; }
  // Whether it is known from here on which cells are narrow: of a thing about as narrow as the cell
  // (a slat, a bar, a lip), or bent as much (a thin pillar). Light differs from one side of it to
  // the other, and from here the one is seen, from there the other.
  void look_closely(bool looks, int threads);
  bool is_narrow(size_t cell) const { return anchors_[cell].is_narrow; }
  // Whether a cell that were made of what a ray of this length has hit would be narrow.
  bool would_be_narrow(const CellHit& hit, float distance) const;
  void forget_hits() {
    hits_ = {};
    more_hits_ = {};
  }

 private:
  // Rays that are so many sizes long see cells that are twice as wide, of twice as many four times.
  // Of interiors in which most rays go from wall to wall they are those of some 4 times the usual
  // length, or more where a coarse picture has larger cells.
  static constexpr float sizes_of_far = 64;
  static constexpr int32_t most_doublings = 12;

  friend struct CellMapParts;  // cell_store.cpp: to and from bytes

  struct Anchor {
    Vec3 position, normal;
    uint32_t next = no_cell;  // of the same voxel
    float size = 0;
    bool is_divided = false;  // something stands in the voxel: sight decides
    bool is_halved = false;   // no cell: smaller ones are in its place
    bool is_narrow = false;   // so far as that is looked at
  };
  struct Hits {
    std::array<CellHit, hits_per_cell> hits;
    uint32_t count = 0;
    uint32_t more = no_cell;  // where all of them are, if they are more
  };
  struct Slot {
    uint64_t key = 0;
    uint32_t first = no_cell;
  };
  // Where a search ended.
  struct Found {
    uint32_t cell = no_cell, last = no_cell;
  };

  size_t first_slot(uint64_t key) const { return key & (slots_.size() - 1); }
  size_t slot_of(uint64_t key) const;
  Found search(uint32_t first, const CellHit& hit) const;
  bool sees(const Anchor& a, const CellHit& hit) const;
  bool is_divided(const CellHit& hit, const CellOutline& outline, float size) const;
  bool ends_both_ways(const Vec3& position, const Vec3& normal, float size) const;
  // Voxels of level k are 2^-k times as wide. Light from near by is that of half cells. Where most
  // of what is asked for is in a gap of a few centimetres, cells are some millimetres wide, but a
  // room around it is not to be millions of them.
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
  std::vector<Slot> slots_;  // open addressing; a power of two of them
  bool looks_closely_ = false;
  size_t used_ = 0;
  size_t frozen_ = 0;  // cells from 0 that get no more hits
  IsUneven is_uneven_;
};

}  // namespace troffer
