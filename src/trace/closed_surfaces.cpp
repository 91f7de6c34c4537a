#include "trace/closed_surfaces.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "base/disjoint_sets.h"

namespace troffer {

namespace {

// A piece of a triangle's edge, between vertices low < high.
struct Piece {
  uint32_t low, high, triangle;
};

// Limit of the pieces in total. Rooms do not have that many vertices on their edges.
constexpr size_t most_pieces_of_triangle = 64, pieces_for_nothing = 1 << 20;

// The vertices ordered along lines parallel to each axis.
class Lines {
 public:
  Lines(std::span<const Vec3> positions, std::span<const std::array<uint32_t, 3>> triangles)
      : positions_(positions) {
    for (const auto& t : triangles)
      for (const uint32_t v : t) order_[0].push_back(v);
    std::sort(order_[0].begin(), order_[0].end());
    order_[0].erase(std::unique(order_[0].begin(), order_[0].end()), order_[0].end());
    order_[1] = order_[2] = order_[0];
    for (size_t axis = 0; axis < 3; ++axis)
      std::sort(order_[axis].begin(), order_[axis].end(),
                [&](uint32_t a, uint32_t b) { return key(a, axis) < key(b, axis); });
  }

  // Calls add(low, high) for each piece of the edge. Returns false if there are more than `most`.
  template <class Add>
  bool divide(uint32_t a, uint32_t b, size_t most, const Add& add) const {
    const Vec3 &p = positions_[a], &q = positions_[b];
    const std::array<bool, 3> is_same{p.x == q.x, p.y == q.y, p.z == q.z};
    for (size_t axis = 0; axis < 3; ++axis) {
      if (!is_same[(axis + 1) % 3] || !is_same[(axis + 2) % 3]) continue;
      if (p[axis] > q[axis]) std::swap(a, b);
      const auto& order = order_[axis];
      auto at = std::lower_bound(order.begin(), order.end(), a, [&](uint32_t v, uint32_t w) {
        return key(v, axis) < key(w, axis);
      });
      for (size_t n = 0; *at != b; ++at, ++n) {
        if (n == most) return false;
        add(std::min(*at, *(at + 1)), std::max(*at, *(at + 1)));
      }
      return true;
    }
    add(std::min(a, b), std::max(a, b));
    return true;
  }

 private:
  // Returns a sort key. It is unique, because vertices are welded.
  std::tuple<float, float, float> key(uint32_t v, size_t axis) const {
    const Vec3& p = positions_[v];
    return {p[(axis + 1) % 3], p[(axis + 2) % 3], p[axis]};
  }

  std::span<const Vec3> positions_;
  std::array<std::vector<uint32_t>, 3> order_;
};

bool is_same_edge(const Piece& a, const Piece& b) {
  return a.low == b.low && a.high == b.high;
}

// Returns all pieces of all edges, grouped by edge; empty if there are too many.
std::vector<Piece> pieces_of(std::span<const Vec3> positions,
                             std::span<const std::array<uint32_t, 3>> triangles) {
  const Lines lines(positions, triangles);
  const size_t most = most_pieces_of_triangle * triangles.size() + pieces_for_nothing;
  std::vector<Piece> pieces;
  for (uint32_t t = 0; t < triangles.size(); ++t)
    for (size_t k = 0; k < 3; ++k)
      if (!lines.divide(triangles[t][k], triangles[t][(k + 1) % 3], most - pieces.size(),
                        [&](uint32_t a, uint32_t b) {
                          pieces.push_back({a, b, t});
                        }))
        return {};
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return pieces;
}

// Edges as runs of pieces, and the edges of each triangle.
struct Edges {
  std::vector<size_t> first;              // start of each run, and the end
  std::vector<uint32_t> count;            // remaining triangles per edge
  std::vector<std::vector<uint32_t>> of;  // edges per triangle
  std::vector<bool> is_left;              // per triangle

  Edges(const std::vector<Piece>& pieces, size_t triangles)
      : of(triangles), is_left(triangles, true) {
    for (size_t i = 0; i < pieces.size(); ++i) {
      if (i == 0 || !is_same_edge(pieces[i], pieces[i - 1])) {
        first.push_back(i);
        count.push_back(0);
      }
      ++count.back();
      of[pieces[i].triangle].push_back(uint32_t(count.size() - 1));
    }
    first.push_back(pieces.size());
  }

  // Removes triangles with an open edge until none is left.
  void leave_out_open(const std::vector<Piece>& pieces) {
    std::vector<uint32_t> open;
    const auto note = [&](uint32_t edge) {
      if (count[edge] != 1) return;
      for (size_t i = first[edge]; i < first[edge + 1]; ++i)
        if (is_left[pieces[i].triangle]) open.push_back(pieces[i].triangle);
    };
    for (uint32_t e = 0; e < count.size(); ++e) note(e);
    while (!open.empty()) {
      const uint32_t t = open.back();
      open.pop_back();
      if (!is_left[t]) continue;
      is_left[t] = false;
      for (const uint32_t e : of[t]) {
        --count[e];
        note(e);
      }
    }
  }
};

}  // namespace

std::vector<std::vector<uint32_t>> closed_surfaces(
    std::span<const Vec3> positions, std::span<const std::array<uint32_t, 3>> triangles) {
  const std::vector<Piece> pieces = pieces_of(positions, triangles);
  Edges edges(pieces, triangles.size());
  edges.leave_out_open(pieces);
  DisjointSets sets(triangles.size());
  std::vector<bool> is_odd(triangles.size(), false);
  for (size_t e = 0; e < edges.count.size(); ++e) {
    uint32_t last = pieces[edges.first[e]].triangle;
    bool is_first = true;
    for (size_t i = edges.first[e]; i < edges.first[e + 1]; ++i) {
      const uint32_t t = pieces[i].triangle;
      if (!edges.is_left[t]) continue;
      if (!is_first) sets.join(last, t);
      if (edges.count[e] % 2 == 1) is_odd[t] = true;
      is_first = false;
      last = t;
    }
  }
  std::vector<bool> is_open(triangles.size(), pieces.empty());
  for (uint32_t t = 0; t < triangles.size(); ++t)
    if (is_odd[t]) is_open[sets.find(t)] = true;
  std::vector<std::vector<uint32_t>> out;
  std::vector<uint32_t> number(triangles.size(), ~0u);
  for (uint32_t t = 0; t < triangles.size(); ++t) {
    const uint32_t set = sets.find(t);
    if (!edges.is_left[t] || is_open[set]) continue;
    if (number[set] == ~0u) {
      number[set] = uint32_t(out.size());
      out.emplace_back();
    }
    out[number[set]].push_back(t);
  }
  return out;
}

}  // namespace troffer
