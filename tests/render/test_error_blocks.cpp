// Estimated against actual error of a film's pixels, by blocks of samples.
#include <doctest/doctest.h>

#include <cmath>

#include "base/random.h"
#include "render/film.h"

using namespace troffer;

namespace {

// Returns the ratio of estimated to actual error of a pixel with n samples, as root mean squares
// over many pixels. `value` gives a sample at a position in the pixel; it also takes a hash of the
// pixel.
template <class Value>
double told_over_made(uint32_t n, bool is_expected, const Value& value) {
  constexpr int pixels = 600;
  Film film({0, 0, pixels, 1}, {});
  film.expect_surrogates();
  double told = 0, made = 0;
  for (int x = 0; x < pixels; ++x) {
    const uint64_t stream = hash_of(uint64_t(x));
    const auto sample = [&](uint32_t first, uint32_t end) {
      double sum = 0;
      for (uint32_t i = first; i < end; ++i) {
        RadianceBatch batch;
        batch.reset(1);
        batch.enable_variance();
        batch.luminance_with_error.assign(1, 0);
        batch.known.assign(1, {});
        const double v = value(stream, i, SobolGroup(stream, 0, i).get2());
        batch.direct[0] = Rgb{float(v)};
        film.add(x, 0, batch, 0, 1);
        sum += v;
      }
      return sum;
    };
    double sum = sample(0, 4);
    if (is_expected) film.expect_samples(x, 0, n);
    sum += sample(4, n);
    told += sqr(film.estimated_error(x, 0));
    constexpr double mean = 0.5;
    made += sqr(sum / n - mean);
  }
  return std::sqrt(told / made);
}

}  // namespace

TEST_CASE(
    "the estimated error of a pixel with an edge: larger blocks of samples overestimate less") {
  // Through the pixel's centre, in any direction.
  const auto edge = [](uint64_t pixel, uint32_t, const Vec2& p) {
    const float angle = 2 * pi_f * unit_float(uint32_t(pixel >> 32));
    return (p.x - 0.5f) * std::cos(angle) + (p.y - 0.5f) * std::sin(angle) > 0 ? 1.0 : 0.0;
  };
  const double by_fours = told_over_made(256, false, edge);
  CHECK(by_fours > 2.5);
  for (const uint32_t n : {16u, 64u, 128u, 256u, 1024u}) {
    CAPTURE(n);
    const double ratio = told_over_made(n, true, edge);
    CHECK(ratio > 1);
    CHECK(ratio < (n > 256 ? 3 : 2.2));
    CHECK(ratio < 0.8 * told_over_made(n, false, edge) + (n < 64 ? 1 : 0));
  }
}

TEST_CASE(
    "the estimated error of a glittering pixel is its actual error, with blocks of any size") {
  const auto glitter = [](uint64_t pixel, uint32_t i, const Vec2&) {
    return double(hash_of(pixel, uint64_t{i}) & 1);
  };
  for (const uint32_t n : {16u, 64u, 100u, 256u, 1024u}) {
    CAPTURE(n);
    const double ratio = told_over_made(n, true, glitter);
    CHECK(ratio > 0.9);
    CHECK(ratio < 1.1);
  }
}
