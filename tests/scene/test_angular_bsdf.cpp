// Bases of directions: Klems' numbers of patches, areas that fill the hemisphere, and inversion.
#include "scene/angular_bsdf.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "support/klems.h"

using namespace troffer;
using namespace troffer::test;

TEST_CASE("the Klems bases have 145, 73 and 41 patches that fill the hemisphere") {
  const std::pair<AngleBasis, size_t> bases[] = {
      {klems_full(), 145}, {klems_half(), 73}, {klems_quarter(), 41}};
  for (const auto& [basis, count] : bases) {
    REQUIRE(basis.size() == count);
    double sum = 0;
    for (size_t k = 0; k < count; ++k) sum += basis.projected_solid_angle(k);
    CHECK(sum == doctest::Approx(pi));
  }
  // [Klems] the middle patch reaches to 5°, and the next ring's to 15° with 8 patches.
  const double sine5 = std::sin(rad_from_deg(5.0)), sine15 = std::sin(rad_from_deg(15.0));
  CHECK(klems_full().projected_solid_angle(0) == doctest::Approx(pi * sine5 * sine5));
  CHECK(klems_full().projected_solid_angle(3) ==
        doctest::Approx(pi * (sine15 * sine15 - sine5 * sine5) / 8));
}

TEST_CASE("directions of a patch lie in it, and are uniform in projected solid angle") {
  Random random(1);
  for (const AngleBasis& basis : {klems_full(), klems_half(), klems_quarter()})
    for (size_t k = 0; k < basis.size(); ++k)
      for (int n = 0; n < 20; ++n) {
        const Vec2 u = random.next_vec2() * 0.998f + Vec2{0.001f, 0.001f};
        const Vec3 w = basis.direction(k, u);
        CHECK(length(w) == doctest::Approx(1));
        CHECK(basis.patch_of(w) == k);
        CHECK(basis.patch_of({w.x, w.y, -w.z}) == k);
      }
}

// The ring from 5° to 15° starts with a patch of azimuths -22.5° to 22.5°, which touches two more
// of its ring, the middle, and those of the ring of 16 patches within ±33.75°: -1, 0 and 1.
TEST_CASE("patches know those around them") {
  std::vector<size_t> around = klems_full().neighbours(1);
  std::sort(around.begin(), around.end());
  CHECK(around == std::vector<size_t>{0, 2, 8, 9, 10, 24});
  CHECK(klems_full().neighbours(0).size() == 8);
}

TEST_CASE("symmetric matrices are reciprocal, and reversal exchanges directions") {
  const AngleBasis basis = klems_half();
  const AngleMatrix even = peaked_matrix(basis, 0.3, 0.5);
  CHECK(reciprocity_error(even, even) == doctest::Approx(0).epsilon(1e-6));
  // All light from the first patch goes to the third ring's first patch, 0° azimuth.
  const AngleMatrix bent =
      matrix_of(basis, [](size_t o, size_t i) { return o == 9 && i == 0 ? 2.0 : 0.0; });
  CHECK(reciprocity_error(bent, bent) == doctest::Approx(1));
  const AngleMatrix back = reversed(bent);
  CHECK(reciprocity_error(bent, back) == doctest::Approx(0).epsilon(1e-6));
  // Light that comes from the direction to which patch 9 leaves is in the opposite patch, at 180°.
  CHECK(back.at(0, 9 + 6) == 2.0f);
  CHECK(std::count(back.values.begin(), back.values.end(), 0.0f) ==
        std::ptrdiff_t(back.values.size()) - 1);
}
