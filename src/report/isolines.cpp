#include "report/isolines.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace troffer {

namespace {

// A side between two neighbouring cells: the first cell, and true if the second is above it (else
// to its right).
struct Side {
  int column, row;
  bool is_up;
  auto operator<=>(const Side&) const = default;
};

Vec2d crossing(const ValueGrid& g, const Side& s, double level) {
  const double a = g.at(s.column, s.row);
  const double b = g.at(s.column + (s.is_up ? 0 : 1), s.row + (s.is_up ? 1 : 0));
  const double t = (level - a) / (b - a);
  return {s.column + 0.5 + (s.is_up ? 0 : t), s.row + 0.5 + (s.is_up ? t : 0)};
}

using Segment = std::pair<Side, Side>;

// Adds the segments within one square; (c, r) is its lower left corner. In a saddle two segments
// cross the square, and the value in its middle decides how they connect.
void add_square(const ValueGrid& g, int c, int r, double level, std::vector<Segment>& out) {
  const std::array<double, 4> v{g.at(c, r), g.at(c + 1, r), g.at(c + 1, r + 1), g.at(c, r + 1)};
  if (!std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); })) return;
  const std::array<Side, 4> sides{Side{c, r, false}, Side{c + 1, r, true}, Side{c, r + 1, false},
                                  Side{c, r, true}};
  std::vector<size_t> crossed;
  for (size_t k = 0; k < 4; ++k)
    if ((v[k] >= level) != (v[(k + 1) % 4] >= level)) crossed.push_back(k);
  if (crossed.size() == 2) out.emplace_back(sides[crossed[0]], sides[crossed[1]]);
  if (crossed.size() != 4) return;
  const bool is_middle_high = (v[0] + v[1] + v[2] + v[3]) / 4 >= level;
  const size_t first = is_middle_high == (v[0] >= level) ? 0 : 3;
  out.emplace_back(sides[first], sides[(first + 1) % 4]);
  out.emplace_back(sides[(first + 2) % 4], sides[(first + 3) % 4]);
}

class Joiner {
 public:
  explicit Joiner(const std::vector<Segment>& segments)
      : segments_(segments), is_used_(segments.size(), false) {
    for (size_t i = 0; i < segments.size(); ++i) {
      at_[segments[i].first].push_back(i);
      at_[segments[i].second].push_back(i);
    }
  }
  // Joins segments to lines. Open lines start at one of their ends.
  std::vector<std::vector<Side>> lines() {
    std::vector<std::vector<Side>> out;
    for (const bool is_open : {true, false})
      for (size_t i = 0; i < segments_.size(); ++i) {
        const auto& [a, b] = segments_[i];
        if (is_used_[i]) continue;
        if (is_open && at_[a].size() == 2 && at_[b].size() == 2) continue;
        out.push_back(line_from(at_[b].size() == 1 ? b : a));
      }
    return out;
  }

 private:
  std::vector<Side> line_from(Side at) {
    std::vector<Side> line{at};
    while (const auto next = unused_at(at)) {
      is_used_[*next] = true;
      const auto& [a, b] = segments_[*next];
      at = a == at ? b : a;
      line.push_back(at);
    }
    return line;
  }
  std::optional<size_t> unused_at(const Side& s) {
    for (const size_t i : at_[s])
      if (!is_used_[i]) return i;
    return std::nullopt;
  }

  const std::vector<Segment>& segments_;
  std::vector<bool> is_used_;
  std::map<Side, std::vector<size_t>> at_;
};

}  // namespace

std::vector<Line> isolines(const ValueGrid& grid, double level) {
  std::vector<Segment> segments;
  for (int r = 0; r + 1 < grid.rows; ++r)
    for (int c = 0; c + 1 < grid.columns; ++c) add_square(grid, c, r, level, segments);
  std::vector<Line> lines;
  for (const std::vector<Side>& sides : Joiner(segments).lines()) {
    Line line;
    for (const Side& s : sides) line.push_back(crossing(grid, s, level));
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace troffer
