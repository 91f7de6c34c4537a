// Openings through which a sky lights a room, found from light samples.
#include <doctest/doctest.h>

#include <vector>

#include "base/random.h"
#include "base/warp.h"
#include "select/openings.h"
#include "support/chi_square.h"
#include "support/light_scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace test_openings {

namespace {

constexpr float y0 = 0.3f, y1 = 0.6f, z0 = 0.4f, z1 = 0.7f;

// The room is the unit cube. Returns true if a ray from inside leaves it through a window in its
// side x = 1.
bool sees_window(const Vec3& x, const Vec3& w) {
  if (!(w.x > 0)) return false;
  const float t = (1 - x.x) / w.x, y = x.y + t * w.y, z = x.z + t * w.z;
  return y > y0 && y < y1 && z > z0 && z < z1;
}

Vec3 place_in_room(Random& r) {
  return {r.next_float(), r.next_float(), r.next_float()};
}

// Samples of a uniform sky all over the room.
std::vector<SkySample> samples_in_room(int count, uint64_t seed) {
  std::vector<SkySample> samples;
  Random r(seed);
  for (int i = 0; i < count; ++i) {
    const Vec3 x = place_in_room(r), w = sphere_from_square(r.next_vec2());
    samples.push_back({x, w, 4 * pi_f, sees_window(x, w) ? 1.0f : 0.0f});
  }
  return samples;
}

// Share of directions that openings choose which go through the window.
double share_through_window(const Openings& openings, uint64_t seed) {
  Random r(seed);
  int chosen = 0, open = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Vec3 x = place_in_room(r), n = random_direction(r);
    Vec3 w;
    const float u = r.next_float();
    if (!openings.contains(x) || !openings.sample(x, n, true, u, r.next_vec2(), w)) continue;
    ++chosen;
    open += sees_window(x, w);
  }
  return chosen > 0 ? double(open) / chosen : 0;
}

// Bins of equal solid angle.
constexpr int rows = 12, columns = 24;
size_t bin_of(const Vec3& w) {
  const Vec2 u = square_from_sphere(w);
  return size_t(std::min(int(u.x * rows), rows - 1) * columns +
                std::min(int(u.y * columns), columns - 1));
}

}  // namespace

TEST_CASE("openings choose directions by their density") {
  const Openings openings(7, samples_in_room(100'000, 1));
  REQUIRE_FALSE(openings.is_empty());
  CHECK(openings.piece() == 7);
  Random r(2);
  const int places = 4, draws = 40'000, across = 96;
  for (int k = 0; k < places; ++k) {
    const Vec3 x = place_in_room(r), n = random_direction(r);
    const bool both_sides = k % 2 == 0;
    REQUIRE(openings.contains(x));
    std::vector<double> observed(rows * columns), expected(rows * columns);
    double failed = 0;
    for (int i = 0; i < draws; ++i) {
      Vec3 w;
      const float u = r.next_float();
      if (openings.sample(x, n, both_sides, u, r.next_vec2(), w))
        ++observed[bin_of(w)];
      else
        ++failed;
    }
    double sum = 0;
    for (int i = 0; i < rows * across; ++i)
      for (int j = 0; j < columns * across; ++j) {
        const Vec2 u{(float(i) + 0.5f) / (rows * across), (float(j) + 0.5f) / (columns * across)};
        const Vec3 w = sphere_from_square(u);
        const double p = double(openings.pdf(x, n, both_sides, w)) * 4 * pi /
                         (double(rows) * across * columns * across);
        expected[bin_of(w)] += p * draws;
        sum += p;
      }
    CHECK(sum == doctest::Approx(1 - failed / draws).epsilon(0.01));
    const auto test = chi_square_test(observed, expected, 0, sidak(1e-4, places));
    CHECK_MESSAGE(test.is_accepted, test.text());
  }
}

TEST_CASE("openings find a window, with and without receivers outside of the room") {
  std::vector<SkySample> samples = samples_in_room(100'000, 3);
  // The window is 1.5 % of the walls. Cells at its edges are partly blocked.
  CHECK(share_through_window(Openings(0, samples), 4) > 0.75);
  // A garden, far larger than the room, where paths arrive that have left it.
  Random r(5);
  for (int i = 0; i < 5'000; ++i)
    samples.push_back({Vec3{1.5f + 20 * r.next_float(), 20 * r.next_float() - 10, 0},
                       sphere_from_square(r.next_vec2()), 4 * pi_f, 1});
  CHECK(share_through_window(Openings(0, samples), 6) > 0.6);
}

TEST_CASE("where all light is blocked there are no openings") {
  std::vector<SkySample> samples = samples_in_room(10'000, 7);
  for (SkySample& s : samples) s.light = 0;
  CHECK(Openings(0, samples).is_empty());
  CHECK(Openings(0, {}).is_empty());
}

}  // namespace test_openings
