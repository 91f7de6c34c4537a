// Matrices as scattering functions: energy, straight light, sampling against evaluation,
// orientation.
#include "bsdf/angular_lobe.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <memory>

#include "bsdf/fresnel.h"
#include "bsdf/samples.h"
#include "support/klems.h"

using namespace troffer;
using namespace troffer::test;

namespace {

Material angular(AngularBsdf bsdf, bool is_sharp) {
  Material m;
  m.kind = MaterialKind::angular;
  m.angular = std::make_shared<const AngularBsdf>(std::move(bsdf));
  m.has_sharp_peak = is_sharp;
  return m;
}

// Transmits a share .2 diffusely and .5 cos straight; reflects .1 at the front, .3 at the back.
AngularBsdf window() {
  AngularBsdf b;
  b.to_front = b.to_back = peaked_matrix(klems_full(), 0.2, 0.5);
  b.front_reflection = peaked_matrix(klems_full(), 0.1, 0);
  b.back_reflection = peaked_matrix(klems_half(), 0.3, 0);
  return b;
}

Bsdf at(const Specimens& s, bool is_front) {
  TexturePlace place(Vec2{0.5f, 0.5f});
  place.grain = {0.6f, 0.8f};
  return make_bsdf(s.tables, s.materials, s.textures, 0, place, is_front);
}

}  // namespace

TEST_CASE("a layer scatters what the sums of its matrices say, kept sharp or not") {
  const AngleBasis basis = klems_full();
  for (const bool is_sharp : {false, true}) {
    const Specimens s({{"window", angular(window(), is_sharp)}});
    for (const bool is_front : {true, false})
      for (const float c : {0.1f, 0.4f, 0.8f, 0.95f, 1.0f}) {
        const Bsdf b = at(s, is_front);
        const Vec3 wo = direction(c);
        const double middle =
            double(basis.direction(basis.patch_of({std::sqrt(1 - c * c), 0, c}), {0.5f, 0.5f}).z);
        const Scattered e = scattered(b, wo, 1u << 16);
        CHECK(e.reflected == doctest::Approx(is_front ? 0.1 : 0.3).epsilon(0.01));
        CHECK(e.transmitted == doctest::Approx(0.2 + 0.5 * middle).epsilon(0.01));
        CHECK(double(albedo(b, c).g) == doctest::Approx(e.total()).epsilon(0.01));
        const double straight = double(straight_transmittance(b, wo).g);
        CHECK(straight == doctest::Approx(is_sharp ? 0.5 * middle : 0.0).epsilon(0.001));
        CHECK(b.is_pane == is_sharp);
      }
  }
}

TEST_CASE("sampling a layer follows the density that evaluation gives") {
  const Specimens s({{"window", angular(window(), true)}});
  Random random(3);
  for (const bool is_front : {true, false}) {
    const Bsdf b = at(s, is_front);
    const Vec3 wo = direction(0.7f);
    // Counts by octants of both sides against integrals of the density.
    std::array<double, 8> counts{}, expected{};
    constexpr int n = 200'000;
    const auto octant = [](const Vec3& w) {
      return size_t(w.x > 0) + 2 * size_t(w.y > 0) + 4 * size_t(w.z > 0);
    };
    double deltas = 0;
    for (int k = 0; k < n; ++k) {
      BsdfSample sample_of;
      if (!sample(b, wo, random.next_float(), random.next_vec2(), sample_of)) continue;
      if (sample_of.is_delta) {
        CHECK(sample_of.wi == -wo);
        ++deltas;
        continue;
      }
      counts[octant(sample_of.wi)] += 1.0 / n;
      CHECK(sample_of.pdf == doctest::Approx(pdf(b, wo, sample_of.wi)).epsilon(1e-3));
    }
    for (int k = 0; k < n; ++k) {
      const Vec3 w = sphere_from_square(random.next_vec2());
      expected[octant(w)] += double(pdf(b, wo, w)) * 4 * pi / n;
    }
    double sum = deltas / n;
    for (size_t k = 0; k < 8; ++k) {
      CHECK(counts[k] == doctest::Approx(expected[k]).epsilon(0.04));
      sum += expected[k];
    }
    CHECK(sum == doctest::Approx(1).epsilon(0.01));
  }
}

// Light along the normal leaves to the patch at azimuth 0 of the ring from 25°: to the right of a
// viewer in front, whose up is the y axis of the matrix. In the local frame, up is (.6, .8), and
// right = up × normal = (.8, -.6).
TEST_CASE("the matrix is oriented by the up vector and the side") {
  AngularBsdf b;
  const size_t target = 1 + 8 + 16;
  b.to_front = b.to_back = matrix_of(klems_full(), [&](size_t o, size_t i) {
    return o == target && i == 0 ? 1 / klems_full().projected_solid_angle(target) : 0.0;
  });
  const Specimens s({{"bending", angular(b, false)}});
  const float sine = std::sin(rad_from_deg(30.0f)), cosine = std::cos(rad_from_deg(30.0f));
  const Vec3 right{0.8f * sine, -0.6f * sine, cosine}, left{-right.x, -right.y, cosine};
  const Vec3 through{0, 0, -1};
  CHECK(evaluate(at(s, true), right, through).g > 0);
  CHECK(evaluate(at(s, true), left, through).g == 0);
  // Behind, the viewer's frame has the same x axis, and y and z reversed. The matrix is given in
  // the front's frame for both ways, so `right` keeps its place in space.
  const Vec3 right_behind{right.x, -right.y, cosine};
  CHECK(evaluate(at(s, false), right_behind, through).g > 0);
  CHECK(evaluate(at(s, false), {-right.x, right.y, cosine}, through).g == 0);
}

// A matrix of clear glass, made from the plate's transmittance at the middle of each patch: its
// straight transmittance differs from the glass by no more than glass varies within the patch.
TEST_CASE("a matrix of clear glass passes what glass passes, within its patches") {
  const AngleBasis basis = klems_full();
  const auto passed = [](double c) { return 1 - double(plate_reflectance(float(c), 1.52f)); };
  AngularBsdf b;
  b.to_front = b.to_back = matrix_of(basis, [&](size_t o, size_t i) {
    return o == i
               ? passed(double(basis.direction(o, {0.5f, 0.5f}).z)) / basis.projected_solid_angle(o)
               : 0.0;
  });
  Material glass;
  glass.kind = MaterialKind::dielectric;
  glass.base_color.value = Rgb{1};
  glass.is_thin = true;
  glass.ior = 1.52f;
  const Specimens s({{"matrix", angular(b, true)}, {"glass", glass}});
  for (const double theta : {0.0, 10.0, 21.0, 38.0, 50.0, 63.0, 70.0}) {
    const Vec3 wo = direction(float(std::cos(rad_from_deg(theta))));
    const double lower = passed(std::cos(rad_from_deg(theta + 10)));
    const double upper = passed(std::cos(rad_from_deg(std::max(theta - 10, 0.0))));
    const double t = double(straight_transmittance(at(s, true), wo).g);
    CHECK(t >= lower - 1e-6);
    CHECK(t <= upper + 1e-6);
    const double exact = double(straight_transmittance(s.at(1), wo).g);
    CHECK(exact >= lower - 1e-6);
    CHECK(exact <= upper + 1e-6);
  }
}

TEST_CASE("haze around the straight direction stays in the matrix unless it is low") {
  const AngleBasis basis = klems_full();
  const auto hazy = [&](double contrast) {
    AngularBsdf b;
    b.to_front =
        matrix_of(basis, [&](size_t o, size_t i) { return o == i ? 2.0 : 2.0 / contrast; });
    return AngularLobe(b, true);
  };
  CHECK_FALSE(hazy(7).has_straight());
  REQUIRE(hazy(9).has_straight());
  // The value above the haze, times the patch.
  CHECK(double(hazy(9).straight({0, 0, 1})) ==
        doctest::Approx((2 - 2.0 / 9) * basis.projected_solid_angle(0)));
  CHECK(double(hazy(9).value({0, 0, 1}, {0, 0, -1})) == doctest::Approx(2.0 / 9));
}
