// Microfacets that scatter once, as in Mitsuba's rough BSDFs.
#include <doctest/doctest.h>

#include <cmath>

#include "base/coat.h"
#include "base/facets.h"
#include "bsdf/facet_lobe.h"
#include "bsdf/samples.h"

using namespace troffer;
using namespace troffer::test;

namespace {

Material single(Material m, FacetModel facets = FacetModel::single_ggx) {
  m.facets = facets;
  return m;
}

// Returns ∫ D(m) (m · n) dm by the midpoint rule in the cosine.
double normalisation(const Bsdf& b) {
  constexpr int n = 400;
  const GgxWidths a = b.is_grained ? b.widths : GgxWidths{b.alpha, b.alpha};
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const float z = (float(i) + 0.5f) / n, phi = 2 * pi_f * (float(j) + 0.5f) / n;
      const float s = std::sqrt(1 - z * z);
      sum += double(beckmann_distribution({s * std::cos(phi), s * std::sin(phi), z}, a) * z);
    }
  return sum * 2 * pi / (n * n);
}

}  // namespace

// Kd .2, .5, .8 seen along the normal under a uniform sky of radiance 1, index 1.5. Expected values
// are from Mitsuba 3's roughplastic (scalar_rgb), specular lobe included.
TEST_CASE("rough plastic in a furnace agrees with Mitsuba") {
  struct Row {
    float alpha;
    bool is_nonlinear;
    Rgb expected;
  };
  for (const Row& row : {Row{0.4f, true, {0.1127f, 0.2591f, 0.4479f}},
                         Row{0.4f, false, {0.1472f, 0.3198f, 0.4924f}}}) {
    Rgb base{0.2f, 0.5f, 0.8f};
    const float f = mean_rough_reflectance_inside(FacetShape::ggx, double(row.alpha), 1.5);
    for (size_t c = 0; c < 3 && !row.is_nonlinear; ++c) base[c] = from_white_base(base[c], f);
    const Specimens s{{"plastic", single(coated(row.alpha, base))}};
    const Rgb seen = albedo(s.at(0), 1);
    for (size_t c = 0; c < 3; ++c) {
      CAPTURE(c);
      CHECK(seen[c] == doctest::Approx(double(row.expected[c])).epsilon(0.002));
    }
  }
}

TEST_CASE("sampled single-scattering microfacets agree with albedo()") {
  for (const FacetModel facets : {FacetModel::single_ggx, FacetModel::single_beckmann})
    for (const float alpha : {0.1f, 0.4f, 1.0f})
      for (const float c : {0.3f, 0.7f, 1.0f}) {
        CAPTURE(alpha);
        CAPTURE(c);
        const Specimens s{{"plastic", single(coated(alpha, Rgb{0.5f}), facets)}};
        const double sum = scattered(s.at(0), direction(c), 1u << 15).total();
        CHECK(sum == doctest::Approx(double(albedo(s.at(0), c).g)).epsilon(0.01));
      }
}

// White metal loses light only between facets: ∫ D G1(o) G1(i) / (4 cos o) di.
TEST_CASE("single-scattering microfacets lose light, balanced ones do not") {
  for (const FacetModel facets : {FacetModel::single_ggx, FacetModel::single_beckmann}) {
    const FacetShape shape = shape_of(facets);
    for (const float alpha : {0.2f, 0.6f}) {
      const Specimens s{{"metal", single(mirror_metal(alpha), facets)},
                        {"balanced", mirror_metal(alpha)},
                        {"glass", single(glass(alpha), facets)}};
      for (const float c : {0.2f, 0.6f, 1.0f}) {
        CAPTURE(alpha);
        CAPTURE(c);
        // An interface with a very large index reflects everything.
        const double metal = rough_shares(shape, double(alpha), 1e6, double(c)).reflected;
        CHECK(scattered(s.at(0), direction(c), 1u << 15).total() ==
              doctest::Approx(metal).epsilon(0.01));
        CHECK(scattered(s.at(1), direction(c), 1u << 15).total() ==
              doctest::Approx(1).epsilon(0.01));
        const RoughShares glass = rough_shares(shape, double(alpha), 1.5, double(c));
        CHECK(scattered(s.at(2), direction(c), 1u << 15).total() ==
              doctest::Approx(glass.reflected + glass.through).epsilon(0.01));
      }
    }
  }
}

TEST_CASE("Beckmann's distribution covers the surface once") {
  const Specimens s{{"metal", single(mirror_metal(0.3f), FacetModel::single_beckmann)}};
  CHECK(normalisation(s.at(0)) == doctest::Approx(1).epsilon(1e-3));
}

// Walter et al., Eq. 27, and GGX's closed form.
TEST_CASE("shares of visible microfacets") {
  CHECK(smith_g1(FacetShape::ggx, 0) == 1);
  CHECK(smith_g1(FacetShape::ggx, 3) == doctest::Approx(2.0 / 3));
  CHECK(smith_g1(FacetShape::beckmann, 0.3f) == 1);
  CHECK(smith_g1(FacetShape::beckmann, 1) == doctest::Approx(5.716 / 5.853));
  CHECK(smith_g1(FacetShape::beckmann, 100) ==
        doctest::Approx((0.3535 + 0.02181) / (1 + 0.2276 + 0.02577)));
}
