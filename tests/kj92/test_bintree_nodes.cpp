// Tests the nodes of random trees: cells, samples inside their cells, neighbours, sums.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/random.h"
#include "kj92/bintree_nodes.h"
#include "kj92/bintree_rules.h"

using namespace troffer;

namespace {

bool contains(const SourceCell& c, const Vec2& p) {
  return p.x >= c.u0 && p.x < c.u1 && p.y >= c.v0 && p.y < c.v1;
}

std::vector<int32_t> leaves_of(const BintreeNodes& t, int32_t i = BintreeNodes::root) {
  std::vector<int32_t> out;
  t.for_each_leaf([&](int32_t leaf) { out.push_back(leaf); }, i);
  return out;
}

// Returns a tree after `splits` splits of random leaves and some merges, with random results.
BintreeNodes random_tree(Random& r, int splits, int deepest = BintreeNodes::max_level) {
  BintreeNodes t(size_t(splits) + 1);
  t.reset(r.next_vec2());
  t.set_result(BintreeNodes::root, r.next_float() < 0.5f, r.next_float());
  for (int k = 0; k < splits; ++k) {
    const std::vector<int32_t> leaves = leaves_of(t);
    const int32_t leaf = leaves[r.next_u32() % leaves.size()];
    if (t[leaf].level >= deepest) continue;
    t.set_result(t.split(leaf, r), r.next_float() < 0.5f, r.next_float());
    const int32_t parent = t[leaves_of(t)[r.next_u32() % leaves.size()]].parent;
    const bool is_pair =
        parent >= 0 && t[t.first_child(parent)].is_leaf() && t[t.first_child(parent) + 1].is_leaf();
    if (is_pair && r.next_float() < 0.2f) t.merge(parent, r);
  }
  t.propagate_all();
  return t;
}

// Computes the values of summarise() from the leaves alone, in double precision.
void check_against_leaves(const BintreeNodes& t, int32_t i) {
  const std::vector<int32_t> leaves = leaves_of(t, i);
  const double area = double(t.cell(i).measure());
  double mean = 0, square = 0;
  size_t visible = 0;
  for (const int32_t leaf : leaves) {
    const double weight = double(t.cell(leaf).measure()) / area;
    const double value = t[leaf].is_visible ? double(t[leaf].kernel) : 0;
    mean += weight * value;
    square += weight * value * value;
    visible += t[leaf].is_visible ? 1 : 0;
  }
  const double n = double(leaves.size());
  CHECK(t[i].samples == leaves.size());
  CHECK(double(t[i].mean) == doctest::Approx(mean).epsilon(1e-5));
  if (leaves.size() > 1) {
    CHECK(double(t[i].variance) ==
          doctest::Approx((square - mean * mean) / (n - 1)).epsilon(1e-4).scale(1e-2));
  } else {
    CHECK(t[i].variance == 0);
  }
  CHECK(t[i].flag == (visible == leaves.size() ? ShadowFlag::light
                      : visible == 0           ? ShadowFlag::shadow
                                               : ShadowFlag::penumbra));
}

void check_nodes(const BintreeNodes& t, int32_t i = BintreeNodes::root) {
  check_against_leaves(t, i);
  const SourceCell c = t.cell(i);
  CHECK(c.measure() == std::ldexp(1.0f, -t[i].level));
  if (t[i].is_leaf()) {
    CHECK(contains(c, t[i].uv));
    return;
  }
  const int32_t a = t.first_child(i), b = a + 1;
  const SourceCell ca = t.cell(a), cb = t.cell(b);
  CHECK(t[a].parent == i);
  CHECK(t[b].parent == i);
  CHECK(t.sibling(a) == b);
  CHECK(t.sibling(b) == a);
  CHECK(ca.u0 == c.u0);
  CHECK(ca.v0 == c.v0);
  CHECK(cb.u1 == c.u1);
  CHECK(cb.v1 == c.v1);
  CHECK(
      (t[i].level % 2 == 0 ? ca.u1 == cb.u0 && ca.v1 == cb.v1 : ca.v1 == cb.v0 && ca.u1 == cb.u1));
  check_nodes(t, a);
  check_nodes(t, b);
}

// True if two cells share a part of a side, with b on the given side of a.
bool touches(const SourceCell& a, const SourceCell& b, BintreeSide side) {
  const bool v_overlap = a.v0 < b.v1 && b.v0 < a.v1, u_overlap = a.u0 < b.u1 && b.u0 < a.u1;
  switch (side) {
    case BintreeSide::left:
      return b.u1 == a.u0 && v_overlap;
    case BintreeSide::right:
      return b.u0 == a.u1 && v_overlap;
    case BintreeSide::below:
      return b.v1 == a.v0 && u_overlap;
    case BintreeSide::above:
      return b.v0 == a.v1 && u_overlap;
  }
  return false;
}

}  // namespace

TEST_CASE("bintree: cells, counts, means, variances and flags follow from the leaves") {
  Random random(1);
  for (int k = 0; k < 40; ++k) check_nodes(random_tree(random, 1 + int(random.next_u32() % 60)));
}

TEST_CASE("bintree: passing up from one leaf is the same as passing up everything") {
  Random random(2);
  for (int k = 0; k < 40; ++k) {
    BintreeNodes t = random_tree(random, 40);
    const std::vector<int32_t> leaves = leaves_of(t);
    const int32_t leaf = leaves[random.next_u32() % leaves.size()];
    t.set_result(leaf, !t[leaf].is_visible, 0.7f);
    t.propagate_up(leaf);
    check_nodes(t);
  }
}

TEST_CASE("bintree: a split keeps the ray in the half that contains it") {
  Random random(3);
  for (int k = 0; k < 200; ++k) {
    BintreeNodes t(2);
    const Vec2 uv = random.next_vec2();
    t.reset(uv);
    t.set_result(BintreeNodes::root, true, 0.25f);
    const int32_t empty = t.split(BintreeNodes::root, random), full = t.sibling(empty);
    CHECK(t[full].uv == uv);
    CHECK(t[full].is_visible);
    CHECK(t[full].kernel == 0.25f);
    CHECK(contains(t.cell(full), uv));
    CHECK(contains(t.cell(empty), t[empty].uv));
  }
}

TEST_CASE("bintree: the border u = 1/2 belongs to the second half") {
  Random random(4);
  BintreeNodes t(2);
  t.reset({0.5f, 0.5f});
  const int32_t empty = t.split(BintreeNodes::root, random);
  CHECK(empty == t.first_child(BintreeNodes::root));
}

TEST_CASE("bintree: jitter stays in the cell, deepest levels and largest numbers included") {
  Random random(5);
  for (const float at : {0.0f, 0.3f, one_minus_epsilon}) {
    BintreeNodes t(64);
    t.reset({at, at});
    int32_t leaf = BintreeNodes::root;
    while (t[leaf].level < BintreeNodes::max_level) leaf = t.sibling(t.split(leaf, random));
    for (int k = 0; k < 2000; ++k) {
      t.jitter(leaf, random);
      CHECK(contains(t.cell(leaf), t[leaf].uv));
    }
  }
}

TEST_CASE("bintree: a merged leaf keeps the ray of either half, as often as the other") {
  Random random(6);
  int first = 0;
  const int n = 4000;
  for (int k = 0; k < n; ++k) {
    BintreeNodes t(2);
    t.reset({0.25f, 0.5f});
    t.set_result(t.split(BintreeNodes::root, random), true);
    t.merge(BintreeNodes::root, random);
    CHECK(t[BintreeNodes::root].is_leaf());
    CHECK(t[BintreeNodes::root].samples == 1);
    first += t[BintreeNodes::root].uv.x < 0.5f ? 1 : 0;
  }
  CHECK(std::abs(first - n / 2) < 4 * std::sqrt(n / 4.0));
}

TEST_CASE("bintree: neighbours agree with geometry") {
  Random random(7);
  for (int k = 0; k < 10; ++k) {
    const BintreeNodes t = random_tree(random, 40, 9);
    const std::vector<int32_t> leaves = leaves_of(t);
    for (const int32_t i : leaves) {
      for (const BintreeSide side : bintree_sides) {
        const int32_t n = t.neighbour(i, side);
        int deepest = -1;
        for (const int32_t other : leaves) {
          if (!touches(t.cell(i), t.cell(other), side)) continue;
          deepest = std::max(deepest, int(t[other].level));
          // a leaf no deeper than i must be the neighbour itself
          if (t[other].level <= t[i].level) CHECK(n == other);
        }
        CHECK((n < 0) == (deepest < 0));
        if (n < 0) continue;
        CHECK(touches(t.cell(i), t.cell(n), side));
        CHECK(t[n].level <= t[i].level);
        if (t[n].is_leaf()) CHECK(deepest == t[n].level);
        const BintreeSide back = BintreeSide(uint8_t(side) ^ 1);
        if (t[n].level == t[i].level) CHECK(t.deepest_along(n, back) == deepest);
        CHECK(t.find(t[i].level, t[i].column, t[i].row) == i);
      }
    }
  }
}
