// Tests of the lattice in which patterns of neighbouring points are compared.
#include "kj92/bintree_pattern.h"

#include <doctest/doctest.h>

#include <bit>
#include <vector>

#include "base/random.h"
#include "kj92/bintree.h"

using namespace troffer;

namespace {

template <class IsVisible>
Bintree tree_over(int rays, IsVisible&& is_visible, float allowed = 0, uint64_t stream = 7) {
  BintreeOptions o;
  o.initial_rays = std::min(rays, 8);
  o.most_rays = rays;
  o.allowed_variance = allowed;
  Bintree tree(o);
  std::vector<ShadowRayResult> results;
  sample_source(tree, results, stream,
                [&](std::span<const Vec2> uv, std::span<ShadowRayResult> out) {
                  for (size_t i = 0; i < uv.size(); ++i) out[i] = {is_visible(uv[i]), 1};
                });
  return tree;
}

ShadowPattern random_pattern(Random& r) {
  ShadowPattern p;
  for (int i = 0; i < ShadowPattern::cells; ++i) {
    const uint32_t kind = r.next_u32() % 3;
    if (kind == 0) p.lit |= uint64_t(1) << i;
    if (kind == 1) p.dark |= uint64_t(1) << i;
  }
  return p;
}

bool is_sound(const ShadowPattern& p) {
  return (p.lit & p.dark) == 0 && (p.lit | p.dark | p.mixed()) == ~uint64_t(0) &&
         (p.mixed() & (p.lit | p.dark)) == 0;
}

}  // namespace

TEST_CASE("leaves larger than lattice cells set all of them") {
  for (const int rays : {1, 2, 4, 8, 16, 32}) {
    const ShadowPattern lit = pattern_of(tree_over(rays, [](Vec2) { return true; }).nodes());
    CHECK(lit.lit == ~uint64_t(0));
    CHECK(lit.dark == 0);
    const ShadowPattern dark = pattern_of(tree_over(rays, [](Vec2) { return false; }).nodes());
    CHECK(dark.dark == ~uint64_t(0));
    CHECK(dark.lit == 0);
  }
  // 2 leaves: the left and the right half in u
  const ShadowPattern halves =
      pattern_of(tree_over(2, [](Vec2 uv) { return uv.x < 0.5f; }).nodes());
  CHECK(halves.lit == 0x0f0f0f0f0f0f0f0full);
  CHECK(halves.dark == 0xf0f0f0f0f0f0f0f0ull);
  // 4 leaves: quarters; v counts rows
  const ShadowPattern below = pattern_of(tree_over(4, [](Vec2 uv) { return uv.y < 0.5f; }).nodes());
  CHECK(below.lit == 0x00000000ffffffffull);
  CHECK(below.dark == 0xffffffff00000000ull);
}

TEST_CASE("leaves as large as lattice cells set one each; smaller ones agree or are mixed") {
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const uint64_t wanted = (uint64_t(random.next_u32()) << 32) | random.next_u32();
    const auto is_visible = [&](Vec2 uv) {
      return ((wanted >> (8 * int(uv.y * 8) + int(uv.x * 8))) & 1) != 0;
    };
    for (const int rays : {64, 256, 1024}) {
      const ShadowPattern p = pattern_of(tree_over(rays, is_visible, 0, uint64_t(i)).nodes());
      CHECK(p.lit == wanted);
      CHECK(p.dark == ~wanted);
      CHECK(p.mixed() == 0);
    }
  }
  // A checkerboard finer than the lattice: each cell has 4 leaves and is mixed.
  const auto fine = [](Vec2 uv) { return (int(uv.x * 16) + int(uv.y * 16)) % 2 == 0; };
  const ShadowPattern p = pattern_of(tree_over(256, fine).nodes());
  CHECK(p.mixed() == ~uint64_t(0));
}

TEST_CASE("adaptive trees: cells at an edge are mixed or correct, cells far from it are definite") {
  for (uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    const float slope = random.next_float() - 0.5f, at = 0.2f + 0.6f * random.next_float();
    const auto is_visible = [&](Vec2 uv) { return uv.x + slope * uv.y < at; };
    const ShadowPattern p = pattern_of(tree_over(128, is_visible, 0.005f, seed).nodes());
    CHECK(is_sound(p));
    CHECK(std::popcount(p.lit) > 0);
  }
}

TEST_CASE("doubt and difference are symmetric, bounded, and zero against the pattern itself") {
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    const ShadowPattern a = random_pattern(random), b = random_pattern(random),
                        c = random_pattern(random);
    REQUIRE(is_sound(a));
    CHECK(cells_in_doubt(a, b) == cells_in_doubt(b, a));
    CHECK(cells_in_doubt(a, a) == a.mixed());
    const float d = pattern_difference(a, b);
    CHECK(d == pattern_difference(b, a));
    CHECK(d >= 0);
    CHECK(d <= 1);
    CHECK(pattern_difference(a, a) == 0);
    CHECK(pattern_difference(a, c) <= d + pattern_difference(b, c) + 1e-6f);  // a metric
    if (d > 0) CHECK(cells_in_doubt(a, b) != 0);
    // Without doubt, both patterns are definite and equal.
    const uint64_t sure = ~cells_in_doubt(a, b);
    CHECK((a.lit & sure) == (b.lit & sure));
    CHECK((a.dark & sure) == (b.dark & sure));
    CHECK(((a.lit | a.dark) & sure) == sure);
  }
  const ShadowPattern lit{~uint64_t(0), 0}, dark{0, ~uint64_t(0)}, mixed{};
  CHECK(pattern_difference(lit, dark) == 1);
  CHECK(pattern_difference(lit, mixed) == 0.5f);
  CHECK(pattern_difference(mixed, mixed) == 0);
  CHECK(cells_in_doubt(mixed, mixed) == ~uint64_t(0));
}

TEST_CASE("lattice cells cover the square in the order of the bits") {
  float sum = 0;
  for (int i = 0; i < ShadowPattern::cells; ++i) {
    const SourceCell c = pattern_cell(i);
    sum += c.measure();
    CHECK(c.u0 >= 0);
    CHECK(c.u1 <= 1);
    CHECK(c.u0 == float(i % 8) / 8);
    CHECK(c.v0 == float(i / 8) / 8);
    // A light region of one cell sets only this bit.
    const auto is_visible = [&](Vec2 uv) {
      return uv.x >= c.u0 && uv.x < c.u1 && uv.y >= c.v0 && uv.y < c.v1;
    };
    CHECK(pattern_of(tree_over(64, is_visible).nodes()).lit == uint64_t(1) << i);
  }
  CHECK(sum == 1);
}
