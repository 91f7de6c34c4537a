#include "base/merge_region.h"

#include <algorithm>
#include <cmath>

namespace troffer {

namespace {

// A merged polygon may lose this share of its width.
constexpr double width_share = 0x1p-10;
// Corners turn left by more than this (sine of the angle).
constexpr double least_turn = 1e-9;

double cross2(const Vec2d& a, const Vec2d& b) {
  return a.x * b.y - a.y * b.x;
}

// x lies within `limit` of the segment from p to q, between its ends.
bool is_on_segment(const Vec2d& x, const Vec2d& p, const Vec2d& q, double limit) {
  const Vec2d e = q - p, d = x - p;
  const double square = dot(e, e), along = dot(e, d), across = cross2(e, d);
  return along > 0 && along < square && across * across <= limit * limit * square;
}

bool turns_left(const Vec2d& p, const Vec2d& q, const Vec2d& r) {
  const Vec2d e = q - p, f = r - q;
  return cross2(e, f) > least_turn * std::sqrt(dot(e, e) * dot(f, f));
}

}  // namespace

RegionMerger::RegionMerger(size_t most_corners)
    : most_corners_(std::min(most_corners, most_merged_corners)) {}

// The one simple loop of edges with a piece on the left only; false if there is no such.
bool RegionMerger::find_boundary(std::vector<uint32_t>& loop) {
  boundary_next_.assign(points.size(), none);
  size_t edges = 0;
  uint32_t start = none;
  for (size_t p = 0; p < pieces.size(); ++p) {
    const std::span<const uint32_t> c = pieces[p];
    for (size_t i = 0; i < c.size(); ++i) {
      const uint32_t from = c[i], to = c[i + 1 == c.size() ? 0 : i + 1];
      if (table_.find(from, to) == EdgeTable::many) return false;
      if (table_.find(to, from) != none) continue;
      if (boundary_next_[from] != none) return false;
      boundary_next_[from] = start = to;
      ++edges;
    }
  }
  loop.clear();
  if (start == none) return false;
  for (uint32_t v = start; loop.size() < edges; v = boundary_next_[v]) {
    if (v == none || (v == start && !loop.empty())) return false;
    loop.push_back(v);
  }
  return boundary_next_[loop.back()] == start;
}

// Pieces that all turn the same way cover each place as often as their boundary winds around it: a
// simple convex boundary is covered once, and nothing beyond it.
bool RegionMerger::merge_all() {
  std::vector<uint32_t>& loop = loop_;
  if (!find_boundary(loop)) return false;
  const size_t n = loop.size();
  const auto at = [&](size_t i) -> const Vec2d& { return points[loop[i % n]]; };
  double twice = 0, perimeter = 0;
  for (size_t i = 0; i < n; ++i) {
    const Vec2d e = at(i + 1) - at(i);
    twice += cross2(at(i) - at(0), at(i + 1) - at(0));
    perimeter += std::sqrt(dot(e, e));
  }
  const double limit = std::min(tolerance_, width_share * twice / perimeter);
  std::array<size_t, most_merged_corners> corners{};
  size_t count = 0;
  for (size_t i = 0; i < n; ++i) {
    if (is_on_segment(at(i), at(i + n - 1), at(i + 1), limit)) continue;
    if (count == most_corners_) return false;
    corners[count++] = i;
  }
  if (count < 3) return false;
  std::array<uint32_t, most_merged_corners> outline{};
  for (size_t k = 0; k < count; ++k) {
    const size_t from = corners[k], to = corners[(k + 1) % count] + (k + 1 == count ? n : 0);
    const Vec2d &p = at(from), &q = at(to);
    for (size_t i = from + 1; i < to; ++i)
      if (!is_on_segment(at(i), p, q, limit)) return false;
    // every corner lies on the left of every edge: a polygon that winds around once
    if (!turns_left(p, q, at(corners[(k + 2) % count]))) return false;
    for (size_t i = 0; i < count; ++i)
      if (cross2(q - p, at(corners[i]) - p) < 0 && corners[i] != to % n) return false;
    outline[k] = loop[from];
  }
  merged.add({outline.data(), count});
  std::fill(of_piece.begin(), of_piece.end(), 0u);
  return true;
}

void RegionMerger::start() {
  const size_t n = pieces.size();
  table_.clear(pieces.corners.size());
  parts_.assign(n, {});
  next_piece_.assign(n, none);
  links_.clear();
  round_ = 0;
  alive_ = n;
  for (uint32_t p = 0; p < n; ++p) {
    Part& part = parts_[p];
    part.last_piece = p;
    const std::span<const uint32_t> c = pieces[p];
    for (size_t i = 0; i < c.size(); ++i) {
      const uint32_t from = c[i], to = c[i + 1 == c.size() ? 0 : i + 1];
      part.loop.add(from, {});
      part.area += 0.5 * cross2(points[from] - points[c[0]], points[to] - points[c[0]]);
      table_.insert(from, to, p);
    }
  }
}

void RegionMerger::append(Chain& to, uint32_t point) {
  links_.push_back({point, none});
  const auto link = uint32_t(links_.size() - 1);
  append(to, Chain{link, link});
}

void RegionMerger::append(Chain& to, const Chain& from) {
  if (from.head == none) return;
  if (to.head == none)
    to.head = from.head;
  else
    links_[to.tail].next = from.head;
  to.tail = from.tail;
}

bool RegionMerger::is_straight(const Vec2d& p, const Vec2d& q, const Chain& chain, double limit) {
  for (uint32_t i = chain.head; i != none; i = links_[i].next) {
    if (visits_left_ == 0) return false;
    --visits_left_;
    if (!is_on_segment(points[links_[i].point], p, q, limit)) return false;
  }
  return true;
}

// Leaves corners out that lie on a straight edge. False if the rest is not convex or too much.
bool RegionMerger::simplify(const LongLoop& loop, double area, ShortLoop& out) {
  const size_t n = loop.count;
  const auto at = [&](size_t i) -> const Vec2d& { return points[loop.corners[i % n]]; };
  double perimeter = 0;
  for (size_t i = 0; i < n; ++i) {
    const Vec2d e = at(i + 1) - at(i);
    perimeter += std::sqrt(dot(e, e));
  }
  const double limit = std::min(tolerance_, width_share * 2 * area / perimeter);
  std::array<size_t, 2 * most_merged_corners> kept{};
  size_t count = 0;
  for (size_t i = 0; i < n; ++i)
    if (!is_on_segment(at(i), at(i + n - 1), at(i + 1), limit)) kept[count++] = i;
  if (count < 3 || count > most_corners_) return false;
  const auto end_of = [&](size_t k) { return k + 1 < count ? kept[k + 1] : kept[0] + n; };
  for (size_t k = 0; k < count; ++k) {
    const size_t from = kept[k], to = end_of(k);
    const Vec2d &p = at(from), &q = at(to);
    if (!turns_left(p, q, at(kept[(k + 2) % count]))) return false;
    if (to == from + 1) continue;
    for (size_t i = from; i < to; ++i) {
      if (i > from && !is_on_segment(at(i), p, q, limit)) return false;
      if (!is_straight(p, q, loop.chains[i % n], limit)) return false;
    }
  }
  out.count = 0;
  for (size_t k = 0; k < count; ++k) {
    Chain chain = loop.chains[kept[k]];
    for (size_t i = kept[k] + 1; i < end_of(k); ++i) {
      append(chain, loop.corners[i % n]);
      append(chain, loop.chains[i % n]);
    }
    out.add(loop.corners[kept[k]], chain);
  }
  return true;
}

// Merges part a with what lies across one of its edges. is_blocked is set where that has been
// merged in this round already.
bool RegionMerger::try_merge(uint32_t a, uint32_t edge, bool& is_blocked) {
  const ShortLoop& l = parts_[a].loop;
  const uint32_t from = l.corners[edge], to = l.corners[(edge + 1) % l.count];
  if (table_.find(from, to) != a) return false;
  const uint32_t b = table_.find(to, from);
  if (b >= EdgeTable::many || b == a) return false;
  if (parts_[b].last_round == round_) {
    is_blocked = true;
    return false;
  }
  const ShortLoop& m = parts_[b].loop;
  uint32_t j = 0;
  while (j < m.count && !(m.corners[j] == to && m.corners[(j + 1) % m.count] == from)) ++j;
  if (j == m.count) return false;
  LongLoop loop;
  for (uint32_t k = 1; k < l.count; ++k)
    loop.add(l.corners[(edge + k) % l.count], l.chains[(edge + k) % l.count]);
  for (uint32_t k = 1; k < m.count; ++k)
    loop.add(m.corners[(j + k) % m.count], m.chains[(j + k) % m.count]);
  ShortLoop merged_loop;
  const double area = parts_[a].area + parts_[b].area;
  if (!simplify(loop, area, merged_loop)) return false;

  for (const ShortLoop* old : {&l, &m})
    for (uint32_t i = 0; i < old->count; ++i)
      table_.erase(old->corners[i], old->corners[(i + 1) % old->count]);
  const uint32_t kept = std::min(a, b), lost = std::max(a, b);
  Part& part = parts_[kept];
  part.loop = merged_loop;
  part.area = area;
  part.last_round = round_;
  part.is_single = false;
  next_piece_[part.last_piece] = lost;
  part.last_piece = parts_[lost].last_piece;
  parts_[lost].is_alive = parts_[lost].is_single = false;
  --alive_;
  for (uint32_t i = 0; i < merged_loop.count; ++i)
    table_.insert(merged_loop.corners[i], merged_loop.corners[(i + 1) % merged_loop.count], kept);
  return true;
}

// Pairs of triangles, those with the longest edges between them first.
void RegionMerger::merge_halves() {
  struct Pair {
    double length2;
    uint32_t a, edge, b;
  };
  std::vector<Pair> pairs;
  for (uint32_t a = 0; a < parts_.size(); ++a) {
    const ShortLoop& l = parts_[a].loop;
    if (l.count != 3) continue;
    for (uint32_t e = 0; e < 3; ++e) {
      const uint32_t from = l.corners[e], to = l.corners[(e + 1) % 3];
      const uint32_t b = table_.find(to, from);
      if (b >= EdgeTable::many || b <= a || parts_[b].loop.count != 3) continue;
      const Vec2d d = points[to] - points[from];
      pairs.push_back({dot(d, d), a, e, b});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& p, const Pair& q) { return p.length2 > q.length2; });
  round_ = 1;
  for (const Pair& p : pairs) {
    bool is_blocked = false;
    if (parts_[p.a].is_single && parts_[p.b].is_single) try_merge(p.a, p.edge, is_blocked);
  }
}

// Merges across edges of a kind until nothing more can be merged; false if nothing was.
bool RegionMerger::merge_rounds(Edges edges) {
  const size_t before = alive_;
  active_.clear();
  for (uint32_t p = 0; p < parts_.size(); ++p)
    if (parts_[p].is_alive) active_.push_back(p);
  const auto is_meant = [&](const ShortLoop& l, uint32_t i) {
    const Vec2d d = points[l.corners[(i + 1) % l.count]] - points[l.corners[i]];
    return edges == Edges::all ||
           (std::abs(dot(d, axis_)) >= std::abs(cross2(d, axis_))) == (edges == Edges::along_x);
  };
  while (!active_.empty()) {
    ++round_;
    next_active_.clear();
    const auto queue = [&](uint32_t p) {
      if (parts_[p].last_queued == round_) return;
      parts_[p].last_queued = round_;
      next_active_.push_back(p);
    };
    for (const uint32_t a : active_) {
      if (!parts_[a].is_alive || parts_[a].last_round == round_) continue;
      bool is_blocked = false, is_merged = false;
      for (uint32_t e = 0; e < parts_[a].loop.count && !is_merged; ++e) {
        if (!is_meant(parts_[a].loop, e)) continue;
        const uint32_t from = parts_[a].loop.corners[e];
        const uint32_t b =
            table_.find(parts_[a].loop.corners[(e + 1) % parts_[a].loop.count], from);
        is_merged = try_merge(a, e, is_blocked);
        if (is_merged) queue(std::min(a, b));
      }
      if (!is_merged && is_blocked) queue(a);
    }
    active_.swap(next_active_);
  }
  return alive_ < before;
}

void RegionMerger::merge_rows(bool is_x_first) {
  constexpr int most_cycles = 16;
  for (int i = 0; i < most_cycles; ++i) {
    const bool first = merge_rounds(is_x_first ? Edges::along_y : Edges::along_x);
    const bool second = merge_rounds(is_x_first ? Edges::along_x : Edges::along_y);
    if (!first && !second) break;
  }
  merge_rounds(Edges::all);
}

void RegionMerger::write(const std::vector<Part>& parts, const std::vector<uint32_t>& next_piece) {
  for (uint32_t p = 0; p < parts.size(); ++p) {
    if (!parts[p].is_alive) continue;
    for (uint32_t i = p; i != none; i = next_piece[i]) of_piece[i] = uint32_t(merged.size());
    merged.add({parts[p].loop.corners.data(), parts[p].loop.count});
  }
}

void RegionMerger::run(double tolerance) {
  tolerance_ = tolerance;
  const size_t n = pieces.size();
  merged.corners.clear();
  merged.first.assign(1, 0);
  of_piece.assign(n, 0);
  table_.clear(pieces.corners.size());
  for (uint32_t p = 0; p < n; ++p) {
    const std::span<const uint32_t> c = pieces[p];
    for (size_t i = 0; i < c.size(); ++i) table_.insert(c[i], c[i + 1 == c.size() ? 0 : i + 1], p);
  }
  if (n > 1 && merge_all()) return;
  if (n <= 2) {
    for (uint32_t p = 0; p < n; ++p) {
      of_piece[p] = p;
      merged.add(pieces[p]);
    }
    return;
  }
  // rows along the longest edge of the boundary
  double longest = 0;
  axis_ = {1, 0};
  for (size_t p = 0; p < n; ++p) {
    const std::span<const uint32_t> c = pieces[p];
    for (size_t i = 0; i < c.size(); ++i) {
      const uint32_t from = c[i], to = c[i + 1 == c.size() ? 0 : i + 1];
      const Vec2d e = points[to] - points[from];
      if (table_.find(to, from) != none || dot(e, e) <= longest) continue;
      longest = dot(e, e);
      axis_ = e;
    }
  }
  visits_left_ = 64 * n + 10000;
  start();
  merge_halves();
  merge_rows(true);
  if (alive_ > 2) {
    const size_t alive = alive_;
    best_parts_.swap(parts_);
    best_next_piece_.swap(next_piece_);
    visits_left_ = 64 * n + 10000;
    start();
    merge_halves();
    merge_rows(false);
    if (alive_ >= alive) return write(best_parts_, best_next_piece_);
  }
  write(parts_, next_piece_);
}

}  // namespace troffer
