#include "report/plane_cells.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace troffer {

namespace {

constexpr double angle = 0.2718;      // rad; rotation of the plane: walls hardly ever stand at that
                                      // angle
constexpr double least_step = 1e-6;   // m, between heights of slabs
constexpr double least_width = 1e-4;  // m; least width of a cell: coordinates are floats of some
                                      // metres

Vec2d turned(const Vec2d& p, double by) {
  const double c = std::cos(by), s = std::sin(by);
  return {c * p.x - s * p.y, s * p.x + c * p.y};
}

struct SlabLine {
  Vec2d low, high;  // low.y < high.y
  int turn = 0;     // change of cover from left to right
  int body = 0;     // change of solid from left to right
  uint8_t kind = 0;
  size_t number = 0;
  double x_at(double y) const {
    return low.x + (high.x - low.x) * ((y - low.y) / (high.y - low.y));
  }
};

std::vector<SlabLine> lines_of(const std::vector<PlaneSegment>& segments) {
  std::vector<SlabLine> lines;
  for (size_t i = 0; i < segments.size(); ++i) {
    const Vec2d a = turned(segments[i].a, angle), b = turned(segments[i].b, angle);
    if (!(std::abs(a.y - b.y) > least_step)) continue;
    const bool is_up = a.y < b.y;
    const bool is_rim = (segments[i].kind & segment_outline) != 0;
    // The face lies to the left of its outline, so an outline that rises ends it.
    const int end = is_up ? -1 : 1;
    lines.push_back({is_up ? a : b, is_up ? b : a, is_rim ? end : 0, segments[i].is_solid ? end : 0,
                     segments[i].kind, i});
  }
  return lines;
}

// Heights of all end points and crossings, ascending.
std::vector<double> heights_of(const std::vector<SlabLine>& lines) {
  std::vector<double> heights;
  std::vector<size_t> order(lines.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](size_t a, size_t b) { return lines[a].low.y < lines[b].low.y; });
  for (size_t i = 0; i < order.size(); ++i) {
    const SlabLine& a = lines[order[i]];
    heights.push_back(a.low.y);
    heights.push_back(a.high.y);
    for (size_t k = i + 1; k < order.size() && lines[order[k]].low.y < a.high.y; ++k) {
      const SlabLine& b = lines[order[k]];
      const double y0 = b.low.y, y1 = std::min(a.high.y, b.high.y);
      const double d0 = a.x_at(y0) - b.low.x, d1 = a.x_at(y1) - b.x_at(y1);
      if ((d0 < 0) != (d1 < 0)) heights.push_back(y0 + (y1 - y0) * (d0 / (d0 - d1)));
    }
  }
  std::sort(heights.begin(), heights.end());
  std::vector<double> apart;
  for (const double h : heights)
    if (apart.empty() || h > apart.back() + least_step) apart.push_back(h);
  return apart;
}

// A cell that may continue in the next slab.
struct Growing {
  size_t left, right;  // indices of lines
  size_t cell;
  double bottom_left, bottom_right, top_left, top_right;  // x at the ends of the slab
};

class Builder {
 public:
  explicit Builder(const std::vector<PlaneSegment>& segments) : lines_(lines_of(segments)) {}

  PlaneCells build() {
    const std::vector<double> heights = heights_of(lines_);
    std::vector<size_t> by_low(lines_.size());
    for (size_t i = 0; i < by_low.size(); ++i) by_low[i] = i;
    std::sort(by_low.begin(), by_low.end(),
              [&](size_t a, size_t b) { return lines_[a].low.y < lines_[b].low.y; });
    std::vector<size_t> active;
    size_t next = 0;
    for (size_t i = 0; i + 1 < heights.size(); ++i) {
      const double middle = 0.5 * (heights[i] + heights[i + 1]);
      while (next < by_low.size() && lines_[by_low[next]].low.y <= middle)
        active.push_back(by_low[next++]);
      std::erase_if(active, [&](size_t k) { return lines_[k].high.y < middle; });
      add_slab(heights[i], heights[i + 1], active);
    }
    for (PlaneCell& c : out_.cells)
      for (Vec2d& p : c.corners) p = turned(p, -angle);
    for (PlaneCell& c : out_.cells) finish(c);
    for (CellContact& c : out_.contacts) {
      c.from = turned(c.from, -angle);
      c.to = turned(c.to, -angle);
    }
    return std::move(out_);
  }

 private:
  static void finish(PlaneCell& c) {
    const auto& p = c.corners;
    const Vec2d d = p[2] - p[0], e = p[3] - p[1];
    c.area = 0.5 * std::abs(d.x * e.y - d.y * e.x);
    c.middle = (p[0] + p[1] + p[2] + p[3]) * 0.25;
  }

  // Returns the cell of the slab below if it continues between the same lines, else a new cell.
  size_t cell_of(double y0, double y1, const Growing& g) {
    const auto below = cell_below_.find({g.left, g.right});
    if (below != cell_below_.end() && out_.cells[below->second].cover == cover_ &&
        out_.cells[below->second].solid == solid_) {
      PlaneCell& c = out_.cells[below->second];
      c.corners[2] = {g.top_right, y1};
      c.corners[3] = {g.top_left, y1};
      return below->second;
    }
    PlaneCell c;
    c.corners = {Vec2d{g.bottom_left, y0}, Vec2d{g.bottom_right, y0}, Vec2d{g.top_right, y1},
                 Vec2d{g.top_left, y1}};
    c.cover = cover_;
    c.solid = solid_;
    out_.cells.push_back(c);
    return out_.cells.size() - 1;
  }

  void add_slab(double y0, double y1, const std::vector<size_t>& active) {
    const double middle = 0.5 * (y0 + y1);
    std::vector<std::pair<double, size_t>> sorted;
    for (const size_t k : active) sorted.emplace_back(lines_[k].x_at(middle), k);
    std::sort(sorted.begin(), sorted.end());
    std::vector<Growing> slab;
    size_t last = no_plane_cell;
    for (size_t i = 0; i < sorted.size();) {
      // Take all segments that coincide here as one border.
      uint8_t kinds = 0;
      const size_t first = i;
      for (; i < sorted.size() && sorted[i].first <= sorted[first].first + least_width; ++i) {
        kinds = uint8_t(kinds | lines_[sorted[i].second].kind);
        cover_ += lines_[sorted[i].second].turn;
        solid_ += lines_[sorted[i].second].body;
      }
      const size_t border = sorted[first].second;
      size_t cell = no_plane_cell;
      if (i < sorted.size()) {
        const SlabLine &l = lines_[sorted[i - 1].second], &r = lines_[sorted[i].second];
        Growing g{sorted[i - 1].second, sorted[i].second, 0,         l.x_at(y0),
                  r.x_at(y0),           l.x_at(y1),       r.x_at(y1)};
        g.cell = cell = cell_of(y0, y1, g);
        slab.push_back(g);
      }
      out_.contacts.push_back({last,
                               cell,
                               kinds,
                               lines_[border].number,
                               {lines_[border].x_at(y0), y0},
                               {lines_[border].x_at(y1), y1}});
      last = cell;
    }
    cover_ = solid_ = 0;
    add_vertical(slab, y0);
    below_ = std::move(slab);
    cell_below_.clear();
    for (const Growing& g : below_) cell_below_.emplace(std::pair{g.left, g.right}, g.cell);
  }

  // Adds contacts between cells of this slab and cells of the slab below it, which no segment
  // separates.
  void add_vertical(const std::vector<Growing>& slab, double y) {
    size_t k = 0;
    for (const Growing& g : slab) {
      while (k < below_.size() && below_[k].top_right <= g.bottom_left) ++k;
      for (size_t i = k; i < below_.size() && below_[i].top_left < g.bottom_right; ++i) {
        const double from = std::max(below_[i].top_left, g.bottom_left);
        const double to = std::min(below_[i].top_right, g.bottom_right);
        if (below_[i].cell != g.cell && to > from)
          out_.contacts.push_back({below_[i].cell, g.cell, 0, 0, {from, y}, {to, y}});
      }
    }
  }

  std::vector<SlabLine> lines_;
  std::vector<Growing> below_;                              // cells of the slab below
  std::map<std::pair<size_t, size_t>, size_t> cell_below_;  // key: the lines at its left and right
  int cover_ = 0, solid_ = 0;                               // samples of the current cell
  PlaneCells out_;
};

}  // namespace

PlaneCells cells_between(const std::vector<PlaneSegment>& segments) {
  return Builder(segments).build();
}

}  // namespace troffer
