// Merges convex polygons of one plane that share whole edges: the two-dimensional part of
// merge_polygons.h, which is its only user.
//
// First it tries to merge all of them to one polygon. Otherwise it merges pairs: halves of
// quadrilaterals first, then rows, then rows of rows, so that merged parts have similar sizes. Both
// row directions are tried.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/edge_table.h"
#include "base/polygon_list.h"
#include "base/vec.h"

namespace troffer {

// Largest number of corners, of merged polygons and of their pieces.
constexpr size_t most_merged_corners = 12;

class RegionMerger {
 public:
  explicit RegionMerger(size_t most_corners);

  // Input: the pieces of the current region, whose corners index `points`. Each is convex,
  // counterclockwise and has a positive area.
  std::vector<Vec2d> points;
  PolygonList pieces;

  // Merges. Omits vertices within `tolerance` of the merged polygon's edge and within 2^-10 of its
  // width (area by half the perimeter). Output: `merged`, and for each piece the polygon that
  // covers it. Deterministic; O(n log n) for grids.
  void run(double tolerance);
  PolygonList merged;
  std::vector<uint32_t> of_piece;

 private:
  static constexpr uint32_t none = EdgeTable::none;

  // Vertices omitted along an edge: a linked list in chains_.links.
  struct Chain {
    uint32_t head = none, tail = none;
  };
  struct Link {
    uint32_t point, next;
  };
  template <size_t capacity>
  struct Loop {
    uint32_t count = 0;
    std::array<uint32_t, capacity> corners;
    std::array<Chain, capacity> chains;  // from corner i to the next
    void add(uint32_t corner, Chain chain) {
      corners[count] = corner;
      chains[count++] = chain;
    }
  };
  using ShortLoop = Loop<most_merged_corners>;
  using LongLoop = Loop<2 * most_merged_corners>;
  struct Part {
    ShortLoop loop;
    double area = 0;
    // end of the list in next_piece, which starts at the part's own number
    uint32_t last_piece = 0;
    uint32_t last_round = 0, last_queued = 0;
    bool is_alive = true, is_single = true;
  };
  struct Partition {
    std::vector<Part> parts;
    std::vector<uint32_t> next_piece;  // next piece of the same part
    size_t alive = 0;                  // number of parts
  };
  enum class Edges : uint8_t { along_x, along_y, all };

  bool merge_all();
  bool find_boundary(std::vector<uint32_t>& loop);
  void start();
  void merge_halves();
  void merge_rows(bool is_x_first);
  bool merge_rounds(Edges edges);
  bool try_merge(uint32_t a, uint32_t edge, bool& is_blocked);
  bool simplify(const LongLoop& loop, double area, ShortLoop& out);
  bool is_straight(const Vec2d& p, const Vec2d& q, const Chain& chain, double limit);
  void append(Chain& to, const Chain& from);
  void append(Chain& to, uint32_t point);
  void merge_in_rows(bool is_x_first);
  Vec2d longest_boundary_edge() const;
  void write(const Partition& partition);

  size_t most_corners_;
  double tolerance_ = 0;
  EdgeTable table_;
  Partition now_, best_;
  struct Chains {
    std::vector<Link> links;
    size_t visits_left = 0;  // budget of visited links
  } chains_;
  struct Rounds {
    uint32_t number = 0;
    std::vector<uint32_t> active, next_active;  // parts
    Vec2d axis;                                 // axis of the rows
  } rounds_;
  struct Boundary {
    std::vector<uint32_t> next, loop;
  } boundary_;
};

}  // namespace troffer
