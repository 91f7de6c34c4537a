#include "base/merge_polygons.h"

#include <algorithm>
#include <cmath>

#include "base/disjoint_sets.h"
#include "base/frame.h"
#include "base/merge_region.h"

namespace troffer {

namespace {

// relative to the largest coordinate
constexpr double slab_thickness = 0x1p-21, straightness = 0x1p-22;

double largest_coordinate(const Vec3& p) {
  return double(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}));
}

// Two pieces that share the edge from `low` to `high`.
struct Pair {
  uint32_t a, b, low, high;
};

class PolygonMerger {
 public:
  PolygonMerger(std::span<const Vec3> positions, const PolygonList& pieces, size_t most_corners);
  // Takes the edges between two vertices. Call it for all of them, in order, before merge().
  void look_at(std::span<const PolygonEdge> edges);
  MergedPolygons merge();

 private:
  Vec3d position(uint32_t v) const { return Vec3d(positions_[v]); }
  Vec3d area_of(uint32_t piece) const;
  bool is_coplanar(uint32_t a, uint32_t b) const;
  void add_region(std::span<const uint32_t> members, std::span<const Pair> pairs);
  bool add_flat(std::span<const uint32_t> members, bool only_if_merged);
  void add_alone(uint32_t piece);

  std::span<const Vec3> positions_;
  const PolygonList& pieces_;
  std::vector<Pair> pairs_;  // coplanar neighbours
  DisjointSets regions_;
  std::vector<uint32_t> local_;        // number in the current region, by vertex
  std::vector<uint32_t> flat_pieces_;  // pieces of the current region that merger_ has
  std::vector<uint32_t> vertices_;     // vertices of the current region
  RegionMerger merger_;
  MergedPolygons out_;
};

PolygonMerger::PolygonMerger(std::span<const Vec3> positions, const PolygonList& pieces,
                             size_t most_corners)
    : positions_(positions), pieces_(pieces), regions_(pieces.size()), merger_(most_corners) {}

// Unit normal times area; zero for degenerate pieces. Not stored, because there may be millions.
Vec3d PolygonMerger::area_of(uint32_t piece) const {
  const std::span<const uint32_t> c = pieces_[piece];
  const Vec3d origin = position(c[0]);
  Vec3d sum;
  for (size_t i = 1; i + 1 < c.size(); ++i)
    sum += cross(position(c[i]) - origin, position(c[i + 1]) - origin);
  return is_finite(sum) ? sum * 0.5 : Vec3d{};
}

// Quick test of two neighbours: true if both may belong to one flat region.
bool PolygonMerger::is_coplanar(uint32_t a, uint32_t b) const {
  Vec3d normal = area_of(a);
  const Vec3d other = area_of(b);
  double square = length_squared(normal);
  const double other_square = length_squared(other);
  if (!(square > 0) || !(other_square > 0) || !(dot(normal, other) > 0)) return false;
  if (square < other_square) {
    std::swap(a, b);
    square = other_square;
    normal = other;
  }
  const Vec3 origin = positions_[pieces_[a][0]];
  const double level = largest_coordinate(origin);
  for (const uint32_t v : pieces_[b]) {
    const double height = dot(normal, position(v) - Vec3d(origin));
    const double limit = slab_thickness * std::max(level, largest_coordinate(positions_[v]));
    if (height * height > limit * limit * square) return false;
  }
  return true;
}

void PolygonMerger::look_at(std::span<const PolygonEdge> edges) {
  if (edges.size() != 2) return;
  const PolygonEdge &e = edges[0], &f = edges[1];
  if (e.is_forward == f.is_forward || e.polygon == f.polygon || !is_coplanar(e.polygon, f.polygon))
    return;
  pairs_.push_back({e.polygon, f.polygon, e.low, e.high});
  regions_.join(e.polygon, f.polygon);
}

// Most pieces of curved surfaces have no partner, so the lists hold only those that do.
MergedPolygons PolygonMerger::merge() {
  const auto n = uint32_t(pieces_.size());
  out_.of_piece.assign(n, no_polygon);
  out_.polygons.corners.reserve(pieces_.corners.size());
  out_.polygons.first.reserve(size_t(n) + 1);
  std::vector<bool> is_paired(n, false);
  for (const Pair& p : pairs_) is_paired[p.a] = is_paired[p.b] = true;
  struct Member {
    uint32_t root, piece;
    bool operator<(const Member& m) const {
      return root != m.root ? root < m.root : piece < m.piece;
    }
  };
  std::vector<Member> members;
  for (uint32_t p = 0; p < n; ++p)
    if (is_paired[p]) members.push_back({regions_.find(p), p});
  std::sort(members.begin(), members.end());
  std::sort(pairs_.begin(), pairs_.end(), [&](const Pair& p, const Pair& q) {
    const uint32_t r = regions_.find(p.a), s = regions_.find(q.a);
    return r != s ? r < s : p.low != q.low ? p.low < q.low : p.high < q.high;
  });
  local_.assign(positions_.size(), no_polygon);
  std::vector<uint32_t> region;
  size_t m = 0, first_pair = 0;
  for (uint32_t r = 0; r < n; ++r) {
    if (!is_paired[r]) {
      add_alone(r);
      continue;
    }
    if (regions_.find(r) != r) continue;  // a region's root is its first piece
    region.clear();
    for (; m < members.size() && members[m].root == r; ++m) region.push_back(members[m].piece);
    size_t end = first_pair;
    while (end < pairs_.size() && regions_.find(pairs_[end].a) == r) ++end;
    add_region(region, std::span(pairs_).subspan(first_pair, end - first_pair));
    first_pair = end;
  }
  return std::move(out_);
}

void PolygonMerger::add_alone(uint32_t piece) {
  if (!(length_squared(area_of(piece)) > 0)) return;
  out_.of_piece[piece] = uint32_t(out_.polygons.size());
  out_.polygons.add(pieces_[piece]);
}

void PolygonMerger::add_region(std::span<const uint32_t> members, std::span<const Pair> pairs) {
  if (add_flat(members, false)) return;
  // Neighbours are coplanar but the whole is not: merge pairs, those with the longest edges first.
  std::vector<std::pair<double, const Pair*>> order;
  for (const Pair& p : pairs)
    order.emplace_back(-length_squared(position(p.high) - position(p.low)), &p);
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& p, const auto& q) { return p.first < q.first; });
  for (const auto& [length, p] : order) {
    if (out_.of_piece[p->a] != no_polygon || out_.of_piece[p->b] != no_polygon) continue;
    const uint32_t both[2] = {p->a, p->b};
    add_flat(both, true);
  }
  for (const uint32_t p : members)
    if (out_.of_piece[p] == no_polygon) add_alone(p);
}

// Merges pieces that lie in one plane. Returns false, without any change, if they do not, or with
// only_if_merged if they do not merge to one polygon.
bool PolygonMerger::add_flat(std::span<const uint32_t> members, bool only_if_merged) {
  Vec3d normal;
  for (const uint32_t p : members) normal += area_of(p);
  const double size = length(normal);
  if (!(size > 0)) return false;
  normal = normal * (1 / size);
  const Vec3d origin = position(pieces_[members[0]][0]);
  double largest = 0, lowest = 0, highest = 0;
  for (const uint32_t p : members)
    for (const uint32_t v : pieces_[p]) {
      const double height = dot(normal, position(v) - origin);
      lowest = std::min(lowest, height);
      highest = std::max(highest, height);
      largest = std::max(largest, largest_coordinate(positions_[v]));
    }
  if (!(highest - lowest <= slab_thickness * largest)) return false;

  const Framed frame(normal);
  merger_.points.clear();
  merger_.pieces.corners.clear();
  merger_.pieces.first.assign(1, 0);
  flat_pieces_.clear();
  for (const uint32_t p : members) {
    if (!(dot(area_of(p), normal) > 0)) continue;  // a sliver that rounding has flipped
    flat_pieces_.push_back(p);
    for (const uint32_t v : pieces_[p]) {
      if (local_[v] == no_polygon) {
        local_[v] = uint32_t(merger_.points.size());
        const Vec3d d = position(v) - origin;
        merger_.points.push_back({dot(d, frame.tangent), dot(d, frame.bitangent)});
        vertices_.push_back(v);
      }
      merger_.pieces.corners.push_back(local_[v]);
    }
    merger_.pieces.first.push_back(uint32_t(merger_.pieces.corners.size()));
  }
  merger_.run(straightness * largest);
  const bool is_wanted =
      !only_if_merged || (merger_.merged.size() == 1 && flat_pieces_.size() == members.size());
  if (is_wanted) {
    const auto first = uint32_t(out_.polygons.size());
    for (size_t i = 0; i < flat_pieces_.size(); ++i)
      out_.of_piece[flat_pieces_[i]] = first + merger_.of_piece[i];
    for (uint32_t& c : merger_.merged.corners) c = vertices_[c];
    for (size_t i = 0; i < merger_.merged.size(); ++i) out_.polygons.add(merger_.merged[i]);
    for (const uint32_t p : members)
      if (out_.of_piece[p] == no_polygon) add_alone(p);
  }
  for (const uint32_t v : vertices_) local_[v] = no_polygon;
  vertices_.clear();
  return is_wanted;
}

}  // namespace

MergedPolygons merge_polygons(std::span<const Vec3> positions, const PolygonList& pieces,
                              std::span<const PolygonEdge> edges, size_t most_corners) {
  PolygonMerger merger(positions, pieces, most_corners);
  for_each_edge(edges, [&](std::span<const PolygonEdge> e) { merger.look_at(e); });
  return merger.merge();
}

MergedPolygons merge_polygons(std::span<const Vec3> positions, const PolygonList& pieces,
                              size_t most_corners, const EdgeVisitor& look) {
  PolygonMerger merger(positions, pieces, most_corners);
  for_each_edge(pieces, positions.size(), [&](std::span<const PolygonEdge> e) {
    merger.look_at(e);
    look(e);
  });
  return merger.merge();
}

}  // namespace troffer
