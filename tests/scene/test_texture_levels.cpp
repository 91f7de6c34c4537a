// Levels of images, and lookups over a footprint.
#include <doctest/doctest.h>

#include <cmath>

#include "base/random.h"
#include "scene/texture.h"
#include "support/textures.h"

using namespace troffer;
using namespace troffer::test;

namespace {

Texture random_image(int width, int height, int channels, bool is_bytes, uint64_t seed) {
  Texture t;
  t.kind = TextureKind::image;
  t.width = width;
  t.height = height;
  t.channels = channels;
  Random random(seed);
  for (int i = 0; i < width * height * channels; ++i) {
    const float v = random.next_float();
    if (is_bytes)
      t.texels8.push_back(uint8_t(v < 0.5f ? 0 : 255));  // the worst case for rounding to bytes
    else
      t.texels_float.push_back(v);
  }
  return t;
}

// Mean of a texture over its texels.
Rgb texel_mean(const Texture& t) {
  const std::vector<Texture> textures{t};
  Rgb sum;
  for (int y = 0; y < t.height; ++y)
    for (int x = 0; x < t.width; ++x) {
      const Vec2 at{(float(x) + 0.5f) / float(t.width), (float(y) + 0.5f) / float(t.height)};
      sum += evaluate(textures, 0, at).rgb;
    }
  return sum / float(t.width * t.height);
}

TexturePlace over(const Vec2& uv, const Vec2& a, const Vec2& b) {
  TexturePlace p(uv);
  p.axis_a = a;
  p.axis_b = b;
  return p;
}

// Black and white columns, each one texel wide.
Texture stripes() {
  Texture t = grey_image(64, 64, [](int x, int) { return x % 2 == 0 ? 1.0f : 0.0f; });
  build_levels(t);
  return t;
}

}  // namespace

TEST_CASE(
    "every level keeps the mean in linear light, and all levels together add a third of the "
    "memory") {
  for (const auto& [w, h] : {std::pair{256, 256}, {255, 131}, {7, 300}, {1, 64}, {3, 2}})
    for (const int channels : {1, 3, 4})
      for (const bool is_bytes : {true, false}) {
        Texture t = random_image(w, h, channels, is_bytes, uint64_t(w + channels));
        const Rgb mean = texel_mean(t);
        build_levels(t);
        REQUIRE_FALSE(t.levels.empty());
        CHECK(t.levels.back().width == 1);
        CHECK(t.levels.back().height == 1);
        const Rgb last = evaluate({t}, 0, over({0.3f, 0.6f}, {50, 0}, {0, 50})).rgb;
        CAPTURE(w);
        CAPTURE(channels);
        CAPTURE(is_bytes);
        for (size_t c = 0; c < 3; ++c)
          CHECK(std::abs(last[c] - mean[c]) < (is_bytes ? 2e-5f : 2e-6f) + 1e-5f);
        const size_t texels = t.texels8.size() + 4 * t.texels_float.size();
        const size_t more = t.levels8.size() + 4 * t.levels_float.size();
        const size_t floats = is_bytes ? size_t(4 * channels * 32 * 32 * 4 / 3) : 0;
        CHECK(more <= texels / 3 + floats + size_t(channels * 8 * (w + h)));
      }
}

TEST_CASE("a footprint smaller than a texel is a point, a large one has the mean") {
  Texture t = random_image(64, 64, 3, true, 5);
  const Vec2 at{0.31f, 0.72f};
  const Rgb point = evaluate({t}, 0, at).rgb, mean = texel_mean(t);
  build_levels(t);
  CHECK(evaluate({t}, 0, over(at, {0.01f, 0}, {0, 0.01f})).rgb == point);
  CHECK(evaluate({t}, 0, at).rgb == point);
  const Rgb all = evaluate({t}, 0, over(at, {1, 0}, {0, 1})).rgb;
  for (size_t c = 0; c < 3; ++c) CHECK(std::abs(all[c] - mean[c]) < 0.02f);
}

TEST_CASE("a long footprint does not blur across its narrow side") {
  const std::vector<Texture> textures{stripes()};
  const float texel = 1.0f / 64;
  for (const float x : {20.5f, 21.5f}) {
    const Vec2 at{x * texel, 0.5f};
    const float sharp = int(x) % 2 == 0 ? 1.0f : 0.0f;
    // along the stripes: eight texels long and one wide
    const float along = evaluate(textures, 0, over(at, {texel, 0}, {0, 8 * texel})).rgb.r;
    CHECK(std::abs(along - sharp) < 1e-5f);
    // across the stripes: grey
    const float across = evaluate(textures, 0, over(at, {8 * texel, 0}, {0, texel})).rgb.r;
    CHECK(std::abs(across - 0.5f) < 0.02f);
  }
}

TEST_CASE("the mean of a transformed image changes continuously between footprint sizes") {
  Texture t = stripes();
  t.uv_scale = {2, -3};
  t.uv_rotation_rad = 0.7f;
  float before = -1;
  for (float size = 0.002f; size < 0.2f; size *= 1.02f) {
    const float v = evaluate({t}, 0, over({0.123f, 0.4f}, {size, 0}, {0, size})).rgb.r;
    if (before >= 0) CHECK(std::abs(v - before) < 0.12f);
    before = v;
  }
  CHECK(std::abs(before - 0.5f) < 0.02f);
  const float nan = std::nanf("");
  for (const Vec2& bad : {Vec2{nan, 0}, Vec2{1e30f, 1e30f}, Vec2{INFINITY, 0}})
    CHECK(std::isfinite(evaluate({t}, 0, over({0.5f, 0.5f}, bad, {0, 0.1f})).rgb.r));
}
