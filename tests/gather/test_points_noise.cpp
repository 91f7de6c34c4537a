// Noise of measuring points by the noise of cells, and how many rays it is worth.
#include <doctest/doctest.h>

#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "gather/points_noise.h"

using namespace troffer;

namespace {

constexpr size_t cells = 400;
constexpr uint32_t rays_of_cell = 16;

// Makes cells whose rays run into light of 0 or 2 at random. The mean of `rays_of_cell` of them has
// a variance of 1 / rays_of_cell.
CellRows cells_of_chance(Random& random, std::vector<Rgb>& light) {
  CellRows rows;
  light.assign(cells, Rgb{0});
  for (uint32_t c = 0; c < cells; ++c)
    for (const bool half : {false, true}) {
      constexpr uint32_t n = rays_of_cell / 2;
      Rgb sum;
      for (uint32_t k = 0; k < n; ++k) sum += Rgb{random.next_float() < 0.5f ? 0.0f : 2.0f};
      rows.add({c, n, 0, half, sum}, {});
      light[c] += sum / float(rays_of_cell);
    }
  rows.finish(cells);
  return rows;
}

// All cells are equally large, in a square over which rays are stratified, as those of pilots are.
PointsSeen points_that_see_all(size_t points, uint32_t rays_of_set, uint64_t seed) {
  constexpr uint32_t side = 20;
  static_assert(side * side == cells);
  PointsSeen seen{rays_of_set, {}, {}};
  for (uint64_t set = 0; set < PointsSeen::sets * points; ++set) {
    for (uint32_t k = 0; k < rays_of_set; ++k) {
      const Vec2 u = SobolGroup(hash_of(seed, set), 0, k).get2();
      seen.seen.push_back({uint32_t(u.x * float(side)) + side * uint32_t(u.y * float(side)), 1});
    }
    seen.end.push_back(seen.seen.size());
  }
  return seen;
}

}  // namespace

TEST_CASE("the error of points that see all cells is that of their mean, with any number of rays") {
  for (const uint32_t rays : {8u, 256u, 1024u}) {
    CAPTURE(rays);
    Random random(rays);
    double by_rows = 0;
    constexpr int worlds = 20;
    for (int k = 0; k < worlds; ++k) {
      std::vector<Rgb> light;
      const CellRows rows = cells_of_chance(random, light);
      const PointsSeen seen = points_that_see_all(40, rays, rays + uint64_t(k));
      // Direct light is as much again.
      const PointsNoise noise = noise_at_points(
          seen, std::vector<float>(40, 1), rows, light,
          {rows.differences(light, 1), std::vector<float>(cells, 0)}, {64, 64, 0}, 0, 1);
      by_rows += noise.by_rows / worlds;
      CHECK(noise.by_hits == 0);
      CHECK(noise.gather_rays == 40 * 64);
      // The light of cells varies by 1 / rays_of_cell, too.
      CHECK(noise.by_gather == doctest::Approx(1.0 / rays_of_cell / 64 / 4).epsilon(0.3));
    }
    CHECK(by_rows == doctest::Approx(1.0 / rays_of_cell / double(cells) / 4).epsilon(0.25));
  }
}

TEST_CASE("points get as many gather rays as the asked error needs, within limits") {
  std::vector<Rgb> light(cells);
  for (size_t c = 0; c < cells; ++c) light[c] = Rgb{c % 2 == 0 ? 0.0f : 2.0f};
  CellRows rows;
  for (uint32_t c = 0; c < cells; ++c) rows.add({c, 8, 0, false, light[c] * 8}, {});
  rows.finish(cells);
  const PointsSeen seen = points_that_see_all(10, 512, 3);
  const auto rays = [&](double error) {
    const PointsNoise noise = noise_at_points(
        seen, std::vector<float>(10, 0), rows, light,
        {std::vector<float>(cells, 0), std::vector<float>(cells, 0)}, {64, 4096, error}, 0, 1);
    return noise.gather_rays / 10;
  };
  CHECK(rays(0.05) == doctest::Approx(400).epsilon(0.05));
  CHECK(rays(1) == 64);
  CHECK(rays(0.001) == 4096);
}

TEST_CASE("dark points do not count for noise") {
  Random random(5);
  std::vector<Rgb> light;
  const CellRows rows = cells_of_chance(random, light);
  const PointsNoise noise = noise_at_points(
      PointsSeen{16, {}, {0, 0, 0, 0}}, {0, 3}, rows, light,
      {rows.differences(light, 1), std::vector<float>(cells, 1)}, {64, 4096, 0.01}, 0, 1);
  CHECK(noise.by_rows == 0);
  CHECK(noise.by_hits == 0);
  CHECK(times_as_many_rays(noise, 1000) == 1);
}

TEST_CASE("the number of rays per cell minimizes the variance for the time") {
  const PointsNoise noise{.by_rows = 4e-5, .by_hits = 1e-6, .by_gather = 6e-6, .gather_rays = 3e6};
  constexpr double rays = 1e5;
  const double best = times_as_many_rays(noise, rays);
  const auto work = [&](double times) {
    return (noise.gather_rays + times * rays) *
           (noise.by_hits + noise.by_gather + noise.by_rows / times);
  };
  CHECK(best > 2);
  for (const double f : {0.5, 0.9, 1.1, 2.0}) CHECK(work(best * f) > work(best));
  // Few points are worth no more rays.
  CHECK(times_as_many_rays({4e-5, 1e-6, 6e-6, 1e4}, rays) == 1);
  // The number of rays is bounded, for memory.
  CHECK(times_as_many_rays({1, 1e-9, 1e-9, 1e12}, 1e6) * 1e6 < 2e7);
  CHECK(times_as_many_rays({1, 1e-9, 1e-9, 1e12}, 1e9) == 1);
}
