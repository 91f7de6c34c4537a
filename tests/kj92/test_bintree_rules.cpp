// Tests each rule of docs/method/bintree.md on trees small enough to know the result.
#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "base/random.h"
#include "kj92/bintree_rules.h"

using namespace troffer;

namespace {

constexpr int32_t root = BintreeNodes::root;

// A tree of one level, with functions to build others.
struct Planted {
  BintreeNodes t{64};
  Random random{1};
  BintreePending pending;
  std::vector<int32_t> scratch;

  explicit Planted(int level) { plant(t, level, random, pending); }

  // Returns the node with the cell of `level` that contains (u,v).
  int32_t at(int level, float u, float v) const {
    return t.find(level, uint32_t(u * float(1 << ((level + 1) / 2))),
                  uint32_t(v * float(1 << (level / 2))));
  }
  void split(int level, float u, float v) { split_pending(t, at(level, u, v), random, pending); }
  // Sets results by the visibility at the centre of each leaf's cell.
  template <class IsVisible>
  void answer(IsVisible is_visible) {
    t.for_each_leaf([&](int32_t i) {
      const SourceCell c = t.cell(i);
      t.set_result(i, is_visible((c.u0 + c.u1) / 2, (c.v0 + c.v1) / 2));
    });
    t.propagate_all();
    pending.clear();
  }
  bool is_leaf(int level, float u, float v) const {
    const int32_t i = at(level, u, v);
    return t[i].is_leaf() && t[i].level == level;
  }
  size_t leaves() const { return t[root].samples; }
};

}  // namespace

TEST_CASE("rule 1: initial rays are uniform, one per cell, all pending") {
  for (int level = 0; level <= 6; ++level) {
    const Planted p(level);
    CHECK(p.pending.size() == size_t(1) << level);
    p.t.for_each_leaf([&](int32_t i) { CHECK(p.t[i].level == level); });
  }
}

TEST_CASE("rule 3a: the only child in penumbra is taken") {
  Planted p(3);
  // left half light, right half mixed: the upper right cell is dark
  p.answer([](float u, float v) { return !(u > 0.75f && v > 0.5f); });
  const int32_t a = p.t.first_child(root), b = a + 1;
  CHECK(choose_only_penumbra(p.t, a, b) == b);
  CHECK(choose_only_penumbra(p.t, b, a) == b);
  // The upper quarter of the right half is mixed. Its left cell is light and its right one dark,
  // and only the dark one differs from a neighbour (the one below).
  CHECK(choose_leaf(p.t) == p.at(3, 0.9f, 0.9f));
}

TEST_CASE("rule 3b: of two children in penumbra the one with fewer samples is taken") {
  Planted p(3);
  p.split(3, 0.1f, 0.9f);
  p.answer([](float, float v) { return v > 0.5f; });
  const int32_t a = p.t.first_child(root), b = a + 1;
  CHECK(choose_only_penumbra(p.t, a, b) == -1);
  CHECK(p.t[a].samples == 5);
  CHECK(choose_fewer_samples(p.t, a, b) == b);
  CHECK(p.t[choose_leaf(p.t)].column >= 2);  // on the right
  CHECK(choose_fewer_samples(p.t, b, b - 1) == b);
}

TEST_CASE(
    "rule 3c: of two children without penumbra the one that differs from its neighbours is taken") {
  Planted p(4);
  // of 16 cells only the upper right one in the lower left quarter is dark
  p.answer([](float u, float v) { return !(u > 0.25f && u < 0.5f && v > 0.25f && v < 0.5f); });
  // the cells to its right and above it are light and have it as a neighbour
  const int32_t right = p.at(4, 0.6f, 0.3f), below_right = p.at(4, 0.6f, 0.1f);
  CHECK(p.t.sibling(right) == below_right);
  CHECK(differs_from_neighbours(p.t, right));
  CHECK(!differs_from_neighbours(p.t, below_right));
  CHECK(choose_by_neighbours(p.t, right, below_right) == right);
  CHECK(choose_by_neighbours(p.t, below_right, right) == right);
  // Both children of the parent differ in flag, but only the dark one differs from a neighbour
  // other than its sibling.
  const int32_t dark = p.at(4, 0.3f, 0.3f), sibling = p.t.sibling(dark);
  CHECK(differs_from_neighbours(p.t, dark));
  CHECK(!differs_from_neighbours(p.t, sibling));
  CHECK(choose_leaf(p.t) == dark);
}

TEST_CASE("rule 3c: without a difference the one with fewer samples is taken, level by level") {
  Planted p(2);
  p.split(2, 0.1f, 0.1f);
  p.answer([](float, float) { return true; });
  // The left half has 3 rays and the right half 2, so the right half is taken. Its children have
  // one ray each: the first is taken.
  CHECK(choose_leaf(p.t) == p.at(2, 0.9f, 0.1f));
  CHECK(choose_leaf_evenly(p.t) == p.at(2, 0.9f, 0.1f));
}

TEST_CASE("rule 3c: a larger leaf counts as neighbour of its smaller ones") {
  Planted p(2);
  p.split(2, 0.1f, 0.1f);
  p.split(3, 0.3f, 0.1f);  // level 4 beside a leaf of level 2 in [0.5, 1) × [0, 0.5)
  p.answer([](float u, float v) { return u < 0.5f || v > 0.5f; });
  CHECK(differs_from_neighbours(p.t, p.at(4, 0.3f, 0.1f)));
  CHECK(!differs_from_neighbours(p.t, p.at(3, 0.1f, 0.1f)));
}

TEST_CASE("rule 4: larger leaves beside deep ones are split, and no others") {
  Planted p(2);
  p.split(2, 0.1f, 0.1f);
  p.split(3, 0.3f, 0.1f);
  p.answer([](float, float) { return true; });
  CHECK(largest_level_difference(p.t) == 2);
  size_t leaves = p.leaves();
  const int32_t where = p.at(2, 0.1f, 0.1f);
  // two levels allowed: nothing to split
  enforce_level_difference(p.t, where, 2, 64, leaves, p.random, p.pending, p.scratch);
  CHECK(p.pending.empty());
  // one level: the lower right and the upper left quarter, which are beside leaves of level 4
  enforce_level_difference(p.t, where, 1, 64, leaves, p.random, p.pending, p.scratch);
  CHECK(largest_level_difference(p.t) == 1);
  CHECK(leaves == 8);
  CHECK(p.pending.size() == 2);
  CHECK(!p.t[p.at(2, 0.6f, 0.1f)].is_leaf());
  CHECK(!p.t[p.at(2, 0.3f, 0.6f)].is_leaf());
  CHECK(p.is_leaf(2, 0.6f, 0.6f));
}

TEST_CASE("rule 4: holds after any sequence of splits; difference 0 means one level") {
  Random random(8);
  for (int difference = 0; difference <= 3; ++difference) {
    for (int k = 0; k < 20; ++k) {
      Planted p(2);
      p.answer([](float, float) { return true; });
      size_t leaves = p.leaves();
      for (int s = 0; s < 20; ++s) {
        const Vec2 uv = random.next_vec2() * 0.3f;  // always near one corner
        const int32_t leaf = p.t.find(12, uint32_t(uv.x * 64), uint32_t(uv.y * 64));
        if (p.t[leaf].level == 12) continue;
        split_pending(p.t, leaf, p.random, p.pending);
        ++leaves;
        enforce_level_difference(p.t, leaf, difference, 100000, leaves, p.random, p.pending,
                                 p.scratch);
        CHECK(largest_level_difference(p.t) <= difference);
        if (leaves > 3000) break;
      }
      // each pending entry is a leaf, occurs once, and came from a split
      std::vector<int32_t> sorted = p.pending;
      std::sort(sorted.begin(), sorted.end());
      CHECK(std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end());
      for (const int32_t i : sorted) CHECK(p.t[i].is_leaf());
      CHECK(sorted.size() == leaves - 4);
    }
  }
}

TEST_CASE("rule 4: stops at the cap") {
  Planted p(2);
  p.answer([](float, float) { return true; });
  p.split(2, 0.1f, 0.1f);
  size_t leaves = 5;
  enforce_level_difference(p.t, root, 0, 6, leaves, p.random, p.pending, p.scratch);
  CHECK(leaves == 6);
}

TEST_CASE("reuse: shrink, before and after") {
  // 32 leaves in 8 columns: six light columns, the two on the right dark
  Planted p(5);
  p.answer([](float u, float) { return u < 0.7f; });
  shrink(p.t, 2, 100, p.random, p.scratch);
  // The left half (level 1) is all light, so its children (level 2) become leaves.
  CHECK(p.is_leaf(2, 0.1f, 0.1f));
  CHECK(p.is_leaf(2, 0.1f, 0.9f));
  // The right half and its quarters are mixed. In each quarter the left half (level 3) is all light
  // and the right one all dark, so their children become leaves of level 4.
  CHECK(p.t[p.at(2, 0.6f, 0.1f)].flag == ShadowFlag::penumbra);
  for (const float v : {0.1f, 0.9f}) {
    CHECK(!p.t[p.at(3, 0.6f, v)].is_leaf());
    CHECK(p.is_leaf(4, 0.6f, v));
    CHECK(!p.t[p.at(3, 0.9f, v)].is_leaf());
    CHECK(p.is_leaf(4, 0.9f, v));
  }
  CHECK(p.leaves() == 2 + 2 * 2 * 2);
  CHECK(p.t[root].mean == 0.75f);
  // a second call has nothing to remove
  shrink(p.t, 2, 100, p.random, p.scratch);
  CHECK(p.leaves() == 10);
}

TEST_CASE("reuse: shrink stops at the initial level, and at a mixed parent") {
  for (int initial = 0; initial <= 5; ++initial) {
    Planted p(5);
    p.answer([](float, float) { return false; });
    shrink(p.t, initial, 100, p.random, p.scratch);
    // only the root's children may become leaves: level 1 at the highest
    CHECK(p.leaves() == size_t(1) << std::max(initial, 1));
  }
  Planted p(2);
  p.answer([](float u, float) { return u < 0.5f; });
  shrink(p.t, 0, 100, p.random, p.scratch);
  CHECK(p.leaves() == 4);  // the halves are uniform, but their parent is not
}

TEST_CASE("reuse: shrink keeps the level difference") {
  Random random(9);
  for (int k = 0; k < 60; ++k) {
    const int difference = 1 + k % 3;
    Planted p(3);
    p.answer([](float, float) { return true; });
    const float edge = random.next_float();
    size_t leaves = p.leaves();
    for (int s = 0; s < 30; ++s) {
      const int32_t leaf = choose_leaf(p.t);
      split_pending(p.t, leaf, p.random, p.pending);
      ++leaves;
      enforce_level_difference(p.t, leaf, difference, 100000, leaves, p.random, p.pending,
                               p.scratch);
      p.answer([&](float u, float v) { return u + 0.5f * v < edge; });
    }
    const float moved = edge + 0.2f;
    p.answer([&](float u, float v) { return u + 0.5f * v < moved; });
    const size_t before = p.leaves();
    shrink(p.t, 3, difference, p.random, p.scratch);
    CHECK(p.leaves() <= before);
    CHECK(largest_level_difference(p.t) <= difference);
    p.t.for_each_leaf([&](int32_t i) { CHECK(p.t[i].level >= 3); });
  }
}
