#include "base/merge_region.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace troffer {

namespace {

// Share of its width that a merged polygon may lose.
constexpr double width_share = 0x1p-10;
// Least sine of the left turn at a corner.
constexpr double least_turn = 1e-9;

double cross2(const Vec2d& a, const Vec2d& b) {
  return a.x * b.y - a.y * b.x;
}

// True if x lies within `limit` of the segment from p to q, between its ends.
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

// Finds the loop of edges with a piece only on their left. Returns false if it is not one simple
// loop.
bool RegionMerger::find_boundary(std::vector<uint32_t>& loop) {
  boundary_.next.assign(points.size(), none);
  size_t edges = 0;
  uint32_t start = none;
  for (size_t p = 0; p < pieces.size(); ++p) {
    const std::span<const uint32_t> c = pieces[p];
    for (size_t i = 0; i < c.size(); ++i) {
      const uint32_t from = c[i], to = c[i + 1 == c.size() ? 0 : i + 1];
      if (table_.find(from, to) == EdgeTable::many) return false;
      if (table_.find(to, from) != none) continue;
      if (boundary_.next[from] != none) return false;
      boundary_.next[from] = start = to;
      ++edges;
    }
  }
  loop.clear();
  if (start == none) return false;
  for (uint32_t v = start; loop.size() < edges; v = boundary_.next[v]) {
    if (v == none || (v == start && !loop.empty())) return false;
    loop.push_back(v);
  }
  return boundary_.next[loop.back()] == start;
}

// Tries to merge all pieces at once. Pieces of equal orientation cover each point as often as their
// boundary winds around it, so a simple convex boundary is covered exactly once.
bool RegionMerger::merge_all() {
  std::vector<uint32_t>& loop = boundary_.loop;
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
    // every corner lies left of every edge, so the polygon winds around once
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
  now_.parts.assign(n, {});
  now_.next_piece.assign(n, none);
  chains_.links.clear();
  rounds_.number = 0;
  now_.alive = n;
  for (uint32_t p = 0; p < n; ++p) {
    Part& part = now_.parts[p];
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
  chains_.links.push_back({point, none});
  const auto link = uint32_t(chains_.links.size() - 1);
  append(to, Chain{link, link});
}

void RegionMerger::append(Chain& to, const Chain& from) {
  if (from.head == none) return;
  if (to.head == none)
    to.head = from.head;
  else
    chains_.links[to.tail].next = from.head;
  to.tail = from.tail;
}

bool RegionMerger::is_straight(const Vec2d& p, const Vec2d& q, const Chain& chain, double limit) {
  for (uint32_t i = chain.head; i != none; i = chains_.links[i].next) {
    if (chains_.visits_left == 0) return false;
    --chains_.visits_left;
    if (!is_on_segment(points[chains_.links[i].point], p, q, limit)) return false;
  }
  return true;
}

// Omits corners that lie on a straight edge. Returns false if the rest is not convex or has too
// many corners.
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

// Merges part a with its neighbour across one edge. Sets is_blocked if the neighbour has already
// been merged in this round.
bool RegionMerger::try_merge(uint32_t a, uint32_t edge, bool& is_blocked) {
  const ShortLoop& l = now_.parts[a].loop;
  const uint32_t from = l.corners[edge], to = l.corners[(edge + 1) % l.count];
  if (table_.find(from, to) != a) return false;
  const uint32_t b = table_.find(to, from);
  if (b >= EdgeTable::many || b == a) return false;
  if (now_.parts[b].last_round == rounds_.number) {
    is_blocked = true;
    return false;
  }
  const ShortLoop& m = now_.parts[b].loop;
  uint32_t j = 0;
  while (j < m.count && !(m.corners[j] == to && m.corners[(j + 1) % m.count] == from)) ++j;
  if (j == m.count) return false;
  LongLoop loop;
  for (uint32_t k = 1; k < l.count; ++k)
    loop.add(l.corners[(edge + k) % l.count], l.chains[(edge + k) % l.count]);
  for (uint32_t k = 1; k < m.count; ++k)
    loop.add(m.corners[(j + k) % m.count], m.chains[(j + k) % m.count]);
  ShortLoop merged_loop;
  const double area = now_.parts[a].area + now_.parts[b].area;
  if (!simplify(loop, area, merged_loop)) return false;

  for (const ShortLoop* old : {&l, &m})
    for (uint32_t i = 0; i < old->count; ++i)
      table_.erase(old->corners[i], old->corners[(i + 1) % old->count]);
  const uint32_t kept = std::min(a, b), lost = std::max(a, b);
  Part& part = now_.parts[kept];
  part.loop = merged_loop;
  part.area = area;
  part.last_round = rounds_.number;
  part.is_single = false;
  now_.next_piece[part.last_piece] = lost;
  part.last_piece = now_.parts[lost].last_piece;
  now_.parts[lost].is_alive = now_.parts[lost].is_single = false;
  --now_.alive;
  for (uint32_t i = 0; i < merged_loop.count; ++i)
    table_.insert(merged_loop.corners[i], merged_loop.corners[(i + 1) % merged_loop.count], kept);
  return true;
}

// Merges pairs of triangles, those with the longest common edges first.
void RegionMerger::merge_halves() {
  struct Pair {
    double length2;
    uint32_t a, edge, b;
  };
  std::vector<Pair> pairs;
  for (uint32_t a = 0; a < now_.parts.size(); ++a) {
    const ShortLoop& l = now_.parts[a].loop;
    if (l.count != 3) continue;
    for (uint32_t e = 0; e < 3; ++e) {
      const uint32_t from = l.corners[e], to = l.corners[(e + 1) % 3];
      const uint32_t b = table_.find(to, from);
      if (b >= EdgeTable::many || b <= a || now_.parts[b].loop.count != 3) continue;
      const Vec2d d = points[to] - points[from];
      pairs.push_back({dot(d, d), a, e, b});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& p, const Pair& q) { return p.length2 > q.length2; });
  rounds_.number = 1;
  for (const Pair& p : pairs) {
    bool is_blocked = false;
    if (now_.parts[p.a].is_single && now_.parts[p.b].is_single) try_merge(p.a, p.edge, is_blocked);
  }
}

// Merges across edges of one kind until nothing more merges. Returns false if nothing merged.
bool RegionMerger::merge_rounds(Edges edges) {
  const size_t before = now_.alive;
  rounds_.active.clear();
  for (uint32_t p = 0; p < now_.parts.size(); ++p)
    if (now_.parts[p].is_alive) rounds_.active.push_back(p);
  const auto is_meant = [&](const ShortLoop& l, uint32_t i) {
    const Vec2d d = points[l.corners[(i + 1) % l.count]] - points[l.corners[i]];
    return edges == Edges::all || (std::abs(dot(d, rounds_.axis)) >=
                                   std::abs(cross2(d, rounds_.axis))) == (edges == Edges::along_x);
  };
  while (!rounds_.active.empty()) {
    ++rounds_.number;
    rounds_.next_active.clear();
    const auto queue = [&](uint32_t p) {
      if (now_.parts[p].last_queued == rounds_.number) return;
      now_.parts[p].last_queued = rounds_.number;
      rounds_.next_active.push_back(p);
    };
    for (const uint32_t a : rounds_.active) {
      if (!now_.parts[a].is_alive || now_.parts[a].last_round == rounds_.number) continue;
      bool is_blocked = false, is_merged = false;
      for (uint32_t e = 0; e < now_.parts[a].loop.count && !is_merged; ++e) {
        if (!is_meant(now_.parts[a].loop, e)) continue;
        const uint32_t from = now_.parts[a].loop.corners[e];
        const uint32_t b =
            table_.find(now_.parts[a].loop.corners[(e + 1) % now_.parts[a].loop.count], from);
        is_merged = try_merge(a, e, is_blocked);
        if (is_merged) queue(std::min(a, b));
      }
      if (!is_merged && is_blocked) queue(a);
    }
    rounds_.active.swap(rounds_.next_active);
  }
  return now_.alive < before;
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

void RegionMerger::write(const Partition& partition) {
  const std::vector<Part>& parts = partition.parts;
  for (uint32_t p = 0; p < parts.size(); ++p) {
    if (!parts[p].is_alive) continue;
    for (uint32_t i = p; i != none; i = partition.next_piece[i])
      of_piece[i] = uint32_t(merged.size());
    merged.add({parts[p].loop.corners.data(), parts[p].loop.count});
  }
}

Vec2d RegionMerger::longest_boundary_edge() const {
  double longest = 0;
  Vec2d edge{1, 0};
  for (size_t p = 0; p < pieces.size(); ++p) {
    const std::span<const uint32_t> c = pieces[p];
    for (size_t i = 0; i < c.size(); ++i) {
      const uint32_t from = c[i], to = c[i + 1 == c.size() ? 0 : i + 1];
      const Vec2d e = points[to] - points[from];
      if (table_.find(to, from) != none || dot(e, e) <= longest) continue;
      longest = dot(e, e);
      edge = e;
    }
  }
  return edge;
}

void RegionMerger::merge_in_rows(bool is_x_first) {
  chains_.visits_left = 64 * pieces.size() + 10000;
  start();
  merge_halves();
  merge_rows(is_x_first);
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
  rounds_.axis = longest_boundary_edge();
  merge_in_rows(true);
  if (now_.alive > 2) {
    std::swap(best_, now_);
    merge_in_rows(false);
    if (now_.alive >= best_.alive) return write(best_);
  }
  write(now_);
}

}  // namespace troffer
