// Texture lookups.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "scene/material.h"
#include "scene/texture.h"

using namespace troffer;

namespace test_texture {

namespace {

// 3 × 2 linear grey texels: 1 2 3 / 4 5 6.
Texture small() {
  Texture t;
  t.kind = TextureKind::image;
  t.width = 3;
  t.height = 2;
  t.channels = 1;
  t.texels_float = {1, 2, 3, 4, 5, 6};
  return t;
}
float grey(const Texture& t, float u, float v) {
  return evaluate({t}, 0, Vec2{u, v}).rgb.r;
}

}  // namespace

TEST_CASE("texel centres return texels; between them values are bilinear") {
  const Texture t = small();
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x)
      CHECK(grey(t, (float(x) + 0.5f) / 3, (float(y) + 0.5f) / 2) ==
            doctest::Approx(double(1 + x + 3 * y)).epsilon(1e-5));
  // v points down: the top row has small v
  CHECK(grey(t, 1.0f / 3, 0.25f) == doctest::Approx(1.5));
  CHECK(grey(t, 0.5f, 0.5f) == doctest::Approx(3.5));
  // bilinear in both directions, between four texels
  const float u = 0.4f, v = 0.45f, fx = u * 3 - 0.5f, fy = v * 2 - 0.5f;
  CHECK(grey(t, u, v) == doctest::Approx(double(1 + fx + 3 * fy)).epsilon(1e-5));
}

TEST_CASE("nearest lookup takes the texel that covers the point") {
  Texture t = small();
  t.is_filtered = false;
  CHECK(grey(t, 0.34f, 0.1f) == 2);
  CHECK(grey(t, 0.32f, 0.1f) == 1);
  CHECK(grey(t, 0.99f, 0.51f) == 6);
}

TEST_CASE("wrap modes") {
  Texture t = small();
  t.is_filtered = false;
  const float inside = 0.5f / 3;
  for (const WrapMode mode :
       {WrapMode::repeat, WrapMode::clamp, WrapMode::mirror, WrapMode::black}) {
    t.wrap_u = mode;
    const float after = grey(t, 1 + inside, 0.1f), before = grey(t, -inside, 0.1f);
    const float far = grey(t, 2 + inside, 0.1f);
    switch (mode) {
      case WrapMode::repeat:
        CHECK(after == 1);
        CHECK(before == 3);
        CHECK(far == 1);
        break;
      case WrapMode::clamp:
        CHECK(after == 3);
        CHECK(before == 1);
        break;
      case WrapMode::mirror:
        CHECK(after == 3);
        CHECK(before == 1);
        CHECK(far == 1);
        break;
      case WrapMode::black:
        CHECK(after == 0);
        CHECK(before == 0);
        CHECK(evaluate({t}, 0, Vec2{-0.1f, 0.1f}).alpha == 0);
        break;
    }
  }
  // filtering reaches across the seam
  t = small();
  CHECK(grey(t, 0, 0.25f) == doctest::Approx(2));       // repeat: mean of 3 and 1
  CHECK(grey(t, 0.5f / 3, 0) == doctest::Approx(2.5));  // mean of 4 and 1
  t.wrap_u = WrapMode::clamp;
  CHECK(grey(t, 0, 0.25f) == doctest::Approx(1));
}

TEST_CASE("eight-bit texels decode sRGB in colour, never in alpha") {
  Texture t;
  t.kind = TextureKind::image;
  t.width = t.height = 1;
  t.channels = 4;
  t.texels8 = {0, 128, 255, 128};
  TextureValue v = evaluate({t}, 0, Vec2{0.5f, 0.5f});
  CHECK(v.rgb.r == 0);
  CHECK(v.rgb.g == doctest::Approx(0.21586).epsilon(1e-4));
  CHECK(v.rgb.b == 1);
  CHECK(v.alpha == doctest::Approx(128.0 / 255));
  t.is_srgb = false;
  v = evaluate({t}, 0, Vec2{0.5f, 0.5f});
  CHECK(v.rgb.g == doctest::Approx(128.0 / 255));
  t.channels = 2;
  t.texels8 = {51, 102};
  v = evaluate({t}, 0, Vec2{0.5f, 0.5f});
  CHECK(v.rgb == Rgb{0.2f});
  CHECK(v.alpha == doctest::Approx(0.4));
  t.channels = 3;
  t.texels8 = {51, 102, 153};
  CHECK(evaluate({t}, 0, Vec2{0.5f, 0.5f}).alpha == 1);
}

TEST_CASE("scale, rotation, offset, inversion") {
  Texture t = small();
  t.is_filtered = false;
  t.uv_scale = {1, -1};  // v up
  t.uv_offset = {0, 1};
  CHECK(grey(t, 0.1f, 0.9f) == 1);
  CHECK(grey(t, 0.1f, 0.1f) == 4);
  // KHR_texture_transform: offset + R(scale uv), R = (cos sin; -sin cos)
  t = small();
  t.uv_rotation_rad = 1.5707963268f;
  t.uv_scale = {1, 0.9f};
  t.uv_offset = {0.05f, 1};
  // (0.3, 0.8) -> scaled (0.3, 0.72) -> rotated (0.72, -0.3) -> (0.77, 0.7)
  const float x = 0.77f * 3 - 0.5f, y = 0.7f * 2 - 0.5f;
  CHECK(grey(t, 0.3f, 0.8f) == doctest::Approx(double(1 + x + 3 * y)).epsilon(1e-4));
  Texture inverted = small();
  for (float& f : inverted.texels_float) f /= 8;
  inverted.is_inverted = true;
  inverted.value = Rgb{2};
  CHECK(grey(inverted, 0.5f / 3, 0.25f) == doctest::Approx(2 * (1 - 0.125)));
}

TEST_CASE("products multiply colour, alpha and their own factor") {
  Texture a, b, product;
  a.value = {0.5f, 1, 2};
  b = small();
  product.kind = TextureKind::product;
  product.factor_a = 0;
  product.factor_b = 1;
  product.value = Rgb{10};
  const TextureValue v = evaluate({a, b, product}, 2, Vec2{0.5f / 3, 0.75f});
  CHECK(v.rgb.r == doctest::Approx(0.5 * 4 * 10));
  CHECK(v.rgb.b == doctest::Approx(2.0 * 4 * 10));
  CHECK(v.alpha == 1);
}

TEST_CASE("odd coordinates stay harmless") {
  const Texture t = small();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, inf, -inf, 1e30f, -1e30f})
    CHECK(grey(t, bad, 0.2f) == grey(t, 0, 0));
  CHECK(std::isfinite(grey(t, 123456.7f, -98765.4f)));
}

TEST_CASE("material inputs multiply value and texture channel") {
  Texture t;
  t.value = {0.1f, 0.2f, 0.4f};
  const std::vector<Texture> textures{t};
  CHECK(evaluate(textures, ColorInput{{2, 2, 0.5f}, no_texture}, Vec2{0, 0}) == Rgb{2, 2, 0.5f});
  CHECK(evaluate(textures, ColorInput{{2, 2, 0.5f}, 0}, Vec2{0, 0}) == Rgb{0.2f, 0.4f, 0.2f});
  CHECK(evaluate(textures, FloatInput{3, no_texture, 1}, Vec2{0, 0}) == 3);
  CHECK(evaluate(textures, FloatInput{3, 0, 1}, Vec2{0, 0}) == doctest::Approx(0.6));
  CHECK(evaluate(textures, FloatInput{3, 0, 3}, Vec2{0, 0}) == 3);
}

}  // namespace test_texture
