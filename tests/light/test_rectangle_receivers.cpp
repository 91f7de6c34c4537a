// points_of_rectangle() against sample().
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <vector>

#include "base/random.h"
#include "base/warp.h"
#include "light/light_sample.h"
#include "light/rectangle_receivers.h"
#include "support/scenes.h"

using namespace troffer;

namespace {

// Receivers near and far, on both sides, some of them nearly in the rectangle's plane.
struct RandomReceivers {
  std::array<std::vector<float>, 9> a;
  std::vector<float> u, v;

  RandomReceivers(size_t n, Random& random, const Vec3& around) {
    for (auto& column : a) column.resize(n);
    for (size_t i = 0; i < n; ++i) {
      const float r = i % 4 == 0 ? 120 : 4;
      Vec3 x = sphere_from_square(random.next_vec2()) * (r * random.next_float());
      if (i % 16 == 1) x.z *= 1e-5f;
      const Vec3 shading = sphere_from_square(random.next_vec2());
      const Vec3 normal = normalize(shading + sphere_from_square(random.next_vec2()) * 0.3f);
      const std::array<Vec3, 3> all{x + around, shading, normal};
      for (size_t k = 0; k < 9; ++k) a[k][i] = all[k / 3][k % 3];
      u.push_back(random.next_float());
      v.push_back(random.next_float());
    }
  }
  Vec3 vector(size_t which, size_t i) const {
    return {a[3 * which][i], a[3 * which + 1][i], a[3 * which + 2][i]};
  }
  SurfaceArrays arrays() const {
    return {u.size(),    a[0].data(), a[1].data(), a[2].data(), a[3].data(),
            a[4].data(), a[5].data(), a[6].data(), a[7].data(), a[8].data()};
  }
};

}  // namespace

TEST_CASE("a rectangle's points for many receivers equal those chosen one by one") {
  Random random(5);
  for (const bool is_two_sided : {false, true}) {
    Scene s;
    const uint32_t black = test::add_diffuse(s, Rgb{0});
    test::make_light(
        s, test::add_quad(s, black, {Vec3{1, 2, 3}, {1, 3.5f, 3}, {1.4f, 3.5f, 3}, {1.4f, 2, 3}}),
        Rgb{1}, is_two_sided);
    const LightPrimitives lights(s);
    REQUIRE(lights.size() == 1);
    const LightPrimitive& p = lights[0];
    REQUIRE(p.shape == PrimitiveShape::rectangle);

    constexpr size_t n = 8000;
    const RandomReceivers r(n, random, {1.2f, 2.7f, 3});
    std::vector<float> cosine(n, -9), inverse_pdf(n, -9);
    points_of_rectangle(p, r.arrays(), r.u.data(), r.v.data(), cosine.data(), inverse_pdf.data());
    size_t told = 0, dark = 0, untold = 0;
    for (size_t i = 0; i < n; ++i) {
      CAPTURE(i);
      LightSample one;
      const bool is_valid = sample(p, r.vector(0, i), {r.u[i], r.v[i]}, one);
      if (inverse_pdf[i] < 0) {
        ++untold;
        // Allowed only close to the rectangle's plane or for a small solid angle.
        CHECK((!is_valid || std::abs(r.vector(0, i).z - 3) < 0.13f || one.pdf_solid_angle > 490));
        continue;
      }
      REQUIRE((inverse_pdf[i] > 0) == is_valid);
      if (!is_valid) {
        ++dark;
        continue;
      }
      ++told;
      const float by_shading = dot(one.wi, r.vector(1, i)), by_normal = dot(one.wi, r.vector(2, i));
      CHECK(inverse_pdf[i] * one.pdf_solid_angle == doctest::Approx(1).epsilon(3e-3));
      if (std::abs(by_normal) > 1e-3f && std::abs(by_shading) > 1e-3f)
        CHECK(cosine[i] ==
              doctest::Approx(by_shading * by_normal > 0 ? by_shading : 0).epsilon(2e-3));
    }
    CHECK(told > n / 3);
    CHECK((dark > n / 3) == !is_two_sided);
    CHECK(untold > n / 32);
    CHECK(untold < n / 4);
  }
}
