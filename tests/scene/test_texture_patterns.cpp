// Checks, dots, mixes and noise, and mappings from space to (u,v).
#include <doctest/doctest.h>

#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "scene/texture_patterns.h"

using namespace troffer;

namespace {

Texture pattern(TextureKind kind, TextureMapping mapping = TextureMapping::uv) {
  Texture t;
  t.kind = kind;
  t.mapping = mapping;
  t.first.value = Rgb{1};
  t.second.value = Rgb{0};
  return t;
}

TexturePlace at(const Vec3& position, float width = 0) {
  TexturePlace p;
  p.position = position;
  p.width = width;
  return p;
}

float grey(const Texture& t, const TexturePlace& p) {
  return evaluate({t}, 0, p).rgb.r;
}

}  // namespace

TEST_CASE("checks in the plane and in space, and their mean over a footprint") {
  Texture t = pattern(TextureKind::checks);
  CHECK(grey(t, Vec2{0.5f, 0.5f}) == 1);
  CHECK(grey(t, Vec2{1.5f, 0.5f}) == 0);
  CHECK(grey(t, Vec2{-0.5f, -0.5f}) == 1);
  // compared with many point lookups, for footprints of several sizes
  for (const float size : {0.3f, 1.0f, 1.7f, 6.3f}) {
    TexturePlace p(Vec2{0.9f, 0.4f});
    p.axis_a = {size, 0};
    p.axis_b = {0, size};
    double sum = 0;
    constexpr int n = 400;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        sum += double(grey(t, Vec2{p.uv.x + size * ((float(i) + 0.5f) / n - 0.5f),
                                   p.uv.y + size * ((float(j) + 0.5f) / n - 0.5f)}));
    CHECK(grey(t, p) == doctest::Approx(sum / (n * n)).epsilon(0.01));
  }
  t = pattern(TextureKind::checks, TextureMapping::solid);
  t.from_scene = Affine::scale({2, 2, 2});
  CHECK(grey(t, at({0.1f, 0.1f, 0.1f})) == 1);
  CHECK(grey(t, at({0.1f, 0.1f, 0.6f})) == 0);
  CHECK(grey(t, at({0.6f, 0.1f, 0.6f})) == 1);
  CHECK(std::abs(grey(t, at({0.1f, 0.1f, 0.1f}, 200)) - 0.5f) < 1e-3f);
}

TEST_CASE("a mix takes its amount from a texture; dots cover their share") {
  Texture amount;
  amount.kind = TextureKind::constant;
  amount.value = Rgb{0.25f};
  Texture mix = pattern(TextureKind::mix);
  mix.second = {Rgb{0.4f}, -1};
  mix.amount = {Rgb{1}, 0};
  CHECK(evaluate({amount, mix}, 1, Vec2{0, 0}).rgb.r == doctest::Approx(0.85));
  const Texture dots = pattern(TextureKind::dots);
  double sum = 0, sharp = 0;
  constexpr int n = 1000;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const float v = grey(dots, Vec2{float(i) * 0.05f, float(j) * 0.05f});
      sum += double(v);
      sharp += v < 0.01f || v > 0.99f ? 1 : 0;
    }
  CHECK(sharp / (n * n) > 0.999);
  CHECK(sum / (n * n) == doctest::Approx(0.5 * pi * 0.35 * 0.35).epsilon(0.05));
}

TEST_CASE("noise has zero mean, is continuous, and vanishes for wide footprints") {
  Texture fbm = pattern(TextureKind::fbm, TextureMapping::solid);
  Texture wrinkled = pattern(TextureKind::wrinkled, TextureMapping::solid);
  Random random(7);
  double sum = 0, squares = 0, turbulence = 0, coarse = 0;
  constexpr int n = 20000;
  for (int i = 0; i < n; ++i) {
    const Vec3 p{random.next_float() * 90, random.next_float() * 90, random.next_float() * 90};
    const float v = grey(fbm, at(p));
    CHECK(std::abs(v - grey(fbm, at(p + Vec3{1e-5f, 0, 1e-5f}))) < 0.02f);
    sum += double(v);
    squares += double(v * v);
    turbulence += double(grey(wrinkled, at(p)));
    coarse += double(grey(wrinkled, at(p, 64)));
    CHECK(grey(fbm, at(p, 64)) == 0);
    CHECK(grey(wrinkled, at(p)) >= 0);
  }
  CHECK(std::abs(sum / n) < 0.02);
  CHECK(squares / n > 0.05);
  CHECK(coarse / n == doctest::Approx(turbulence / n).epsilon(0.1));
  for (const TextureKind kind : {TextureKind::windy, TextureKind::marble}) {
    const Texture t = pattern(kind, TextureMapping::solid);
    for (const float bad : {INFINITY, 1e38f, std::nanf("")})
      CHECK(is_finite(evaluate({t}, 0, at({bad, 1, 1})).rgb));
  }
}

TEST_CASE("places on spheres, cylinders and planes") {
  Texture t = pattern(TextureKind::checks, TextureMapping::spherical);
  Vec2 uv = mapped_place(t, at({0, 2, 0})).uv;
  CHECK(uv.x == doctest::Approx(0.5));
  CHECK(uv.y == doctest::Approx(0.25));
  t.mapping = TextureMapping::cylindrical;
  uv = mapped_place(t, at({3, 0, 7})).uv;
  CHECK(uv.x == doctest::Approx(0.5));
  CHECK(uv.y == doctest::Approx(7));
  t.mapping = TextureMapping::planar;
  t.from_scene = Affine::translate({1, 2, 3});
  uv = mapped_place(t, at({3, 4, 7}, 0.5f)).uv;
  CHECK(uv.x == doctest::Approx(4));
  CHECK(uv.y == doctest::Approx(6));
  CHECK(mapped_place(t, at({3, 4, 7}, 0.5f)).axis_a.x == doctest::Approx(0.5));
}
