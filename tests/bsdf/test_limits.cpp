// Smooth limits, material inputs, tables against brute force, normal maps.
#include <doctest/doctest.h>

#include "bsdf/fresnel.h"
#include "bsdf/ggx.h"
#include "bsdf/samples.h"
#include "support/quadrature.h"

using namespace troffer;
using namespace troffer::test;

TEST_CASE("Fresnel reflectances have their known values") {
  CHECK(fresnel_dielectric(1, 1.5f) == doctest::Approx(0.04).epsilon(1e-5));
  CHECK(fresnel_dielectric(1, 1 / 1.5f) == doctest::Approx(0.04).epsilon(1e-5));
  CHECK(fresnel_dielectric(0, 1.5f) == doctest::Approx(1));
  CHECK(fresnel_dielectric(0.5f, 1 / 1.5f) == 1);  // beyond the critical angle
  // At Brewster's angle half of the perpendicular reflectance remains.
  const double eta = 1.5, brewster = std::cos(std::atan(eta));
  const double perpendicular = std::pow((eta * eta - 1) / (eta * eta + 1), 2);
  CHECK(fresnel_dielectric(float(brewster), 1.5f) ==
        doctest::Approx(perpendicular / 2).epsilon(1e-4));
  // A conductor without absorption is a dielectric.
  for (const float c : {0.05f, 0.3f, 0.8f, 1.0f})
    CHECK(fresnel_conductor(c, 1.5f, 0) ==
          doctest::Approx(double(fresnel_dielectric(c, 1.5f))).epsilon(1e-4));
  for (const float r : {0.0f, 0.2f, 0.9f, 0.99f})
    CHECK(fresnel_conductor(1, 1, k_from_reflectance(r)) ==
          doctest::Approx(double(r)).epsilon(1e-4));
  // Hemispherical means from outside and from inside differ by n².
  const double outside = 1 - double(fresnel_dielectric_average(1.5f));
  const double inside = 1 - double(fresnel_dielectric_average(1 / 1.5f));
  CHECK(outside == doctest::Approx(inside * 2.25).epsilon(1e-3));
  CHECK(1 - outside == doctest::Approx(0.0918).epsilon(2e-3));
}

TEST_CASE("a plate that absorbs nothing is the clear plate, down to grazing incidence") {
  for (const float cosine : {1.0f, 0.5f, 1e-2f, 1e-4f, 1e-6f, 1e-8f, 1e-9f, 0.0f})
    for (const float eta : {1.5f, 1.001f, 2.5f, 1 / 1.5f}) {
      CAPTURE(cosine);
      CAPTURE(eta);
      const double r = double(plate_reflectance(cosine, eta));
      for (const float left : {1.0f, 1 - 1e-7f, 0.5f, 0.0f}) {
        CAPTURE(left);
        const PlateShares p = absorbing_plate(cosine, eta, left);
        REQUIRE(std::isfinite(p.reflected));
        REQUIRE(std::isfinite(p.transmitted));
        CHECK(p.reflected >= 0);
        CHECK(p.transmitted >= 0);
        CHECK(double(p.reflected + p.transmitted) <= 1 + 1e-6);
        if (left < 1) continue;
        CHECK(double(p.reflected) == doctest::Approx(r).epsilon(1e-5));
        CHECK(double(p.transmitted) == doctest::Approx(1 - r).epsilon(1e-4));
      }
    }
}

TEST_CASE("tables agree with direct integration") {
  GgxTables ggx;
  std::vector<CoatTable> coats(1);
  std::vector<GlassTables> glasses;
  coats[0].ior = 1.5f;
  build_albedo_tables(ggx, coats, glasses);
  for (const float alpha : {0.03f, 0.17f, 0.45f, 0.93f})
    for (const float c : {0.03f, 0.11f, 0.4f, 0.83f, 1.0f}) {
      const Vec3 wo = direction(c);
      double one = 0, coat = 0;
      constexpr uint32_t n = 1u << 15;
      for (uint32_t i = 0; i < n; ++i) {
        const Vec2 u = SobolGroup(1, 2, i).get2();
        const Vec3 m = ggx_sample_visible_normal(wo, u, alpha, 1);
        const float z = 2 * dot(wo, m) * m.z - wo.z;
        if (z <= 0) continue;
        const double w = (1.0 + double(ggx_lambda(c, alpha))) /
                         (1.0 + double(ggx_lambda(c, alpha) + ggx_lambda(z, alpha)));
        one += w / n;
        coat += w / n * double(fresnel_dielectric(std::min(dot(wo, m), 1.0f), 1.5f));
      }
      INFO("alpha ", alpha, " cosine ", c);
      const CosineCoordinate at(c);
      CHECK(std::abs(double(ggx.one.row(alpha).at(at)) - one) < 1.2e-3);
      CHECK(std::abs(double(coats[0].reflected.row(alpha).at(at)) - coat) < 1e-3);
    }
  // The stored mean is that of the interpolant.
  const AlbedoRow row = ggx.one.row(0.6f);
  const double mean = integrate(
      [&](double c) { return 2 * c * double(row.at(CosineCoordinate(float(c)))); }, 0.0, 1.0, 200);
  CHECK(double(row.average) == doctest::Approx(mean).epsilon(1e-5));
}

TEST_CASE("GGX normals project to unit area") {
  for (const float alpha : {0.05f, 0.3f, 1.0f}) {
    const double area = integrate_adaptive(
        [&](double z) {
          const float s = float(std::sqrt(1 - z * z));
          return 2 * pi * z * double(ggx_distribution({s, 0, float(z)}, alpha));
        },
        0.0, 1.0, 1e-5);
    CHECK(area == doctest::Approx(1).epsilon(1e-3));
  }
}

TEST_CASE("albedo converges to that of the mirror as alpha goes to 0") {
  for (const float c : {0.1f, 0.5f, 0.9f}) {
    const Vec3 wo = direction(c);
    const Specimens s{{"", glass(1.1e-3f)}, {"", glass(0)}, {"", copper(1.1e-3f)}, {"", copper(0)}};
    const Bsdf rough_glass = s.at(0), smooth_glass = s.at(1);
    const Bsdf rough_copper = s.at(2), smooth_copper = s.at(3);
    CHECK(smooth_glass.is_smooth);
    CHECK(is_purely_delta(smooth_glass));
    CHECK_FALSE(is_purely_delta(rough_glass));
    CHECK(scattered(smooth_glass, wo).reflected ==
          doctest::Approx(double(fresnel_dielectric(c, 1.5f))).epsilon(1e-3));
    CHECK(scattered(rough_glass, wo).reflected ==
          doctest::Approx(double(fresnel_dielectric(c, 1.5f))).epsilon(5e-3));
    CHECK(scattered(smooth_copper, wo).reflected ==
          doctest::Approx(double(fresnel_conductor(c, 0.92f, 2.45f))).epsilon(1e-4));
    CHECK(scattered(rough_copper, wo).reflected ==
          doctest::Approx(double(fresnel_conductor(c, 0.92f, 2.45f))).epsilon(2e-3));
  }
  // Refraction into smooth glass and out again restores the radiance.
  const Specimens s{{"glass", glass(0)}};
  BsdfSample in, out;
  REQUIRE(sample(s.at(0, true), direction(0.6f), 0.99f, {0.5f, 0.5f}, in));
  REQUIRE(in.is_transmission);
  const Vec3 down{-in.wi.x, -in.wi.y, -in.wi.z};
  REQUIRE(sample(s.at(0, false), down, 0.99f, {0.5f, 0.5f}, out));
  REQUIRE(out.is_transmission);
  CHECK(in.eta * out.eta == doctest::Approx(1));
  CHECK(in.weight.g * out.weight.g == doctest::Approx(1).epsilon(1e-5));
  CHECK(std::abs(out.wi.z) == doctest::Approx(0.6));
  CHECK(out.wi.x == doctest::Approx(-double(direction(0.6f).x)));
}

TEST_CASE("inputs out of range are clamped") {
  Material m = gltf(0.3f, 0, {2, std::nanf(""), -1});
  m.ior = std::nanf("");
  m.metallic.value = 7;
  const Specimens s{{"odd", m}};
  const Bsdf b = s.at(0);
  const Rgb f = evaluate(b, direction(0.5f), direction(0.5f));
  CHECK(is_finite(f));
  CHECK(f.r > 0);
  CHECK(scattered(b, direction(0.5f)).total() <= 1);
}

TEST_CASE("roughness has the meaning of the format, and textures control it") {
  Material m = copper(0.25f);
  CHECK(glossy_alpha(Specimens({{"a", m}}).at(0)) == 0.25f);
  m.roughness_meaning = RoughnessMeaning::alpha_is_sqrt;
  CHECK(glossy_alpha(Specimens({{"a", m}}).at(0)) == 0.5f);
  m.roughness_meaning = RoughnessMeaning::alpha_is_square;
  CHECK(glossy_alpha(Specimens({{"a", m}}).at(0)) == 0.0625f);
  Texture t;
  t.value = {0.1f, 0.5f, 0.9f};
  m.roughness_meaning = RoughnessMeaning::alpha;
  m.roughness = {0.5f, 0, 1};
  const std::vector<Material> materials{m};
  const BsdfTables tables(materials);
  CHECK(glossy_alpha(make_bsdf(tables, materials, {t}, 0, Vec2{0, 0}, true)) == 0.25f);
}

TEST_CASE("many indices of refraction share a bounded number of tables") {
  std::vector<Material> materials;
  for (int i = 0; i < 200; ++i) materials.push_back(coated(0.3f, Rgb{1}, 1.1f + 0.01f * float(i)));
  const BsdfTables tables(materials);
  for (const uint32_t i : {0u, 5u, 199u}) {
    const Bsdf b = make_bsdf(tables, materials, {}, i, Vec2{0, 0}, true);
    const double e = scattered(b, direction(0.7f)).total();
    CHECK(std::abs(e - 1) < 0.25);
  }
  for (const uint32_t i : {0u, 31u, 199u}) CHECK(tables.material(i).coat < 64);
}

TEST_CASE("two equal widths are isotropic, and the grain turns with the surface") {
  const Vec3 wo = direction(0.6f, 0.3f), wi = direction(0.8f, 2.9f), m = normalize(wo + wi);
  const GgxWidths even{0.3f, 0.3f};
  CHECK(ggx_distribution(m, even) == doctest::Approx(double(ggx_distribution(m, 0.3f))));
  CHECK(ggx_visibility(wo, wi, even) == doctest::Approx(double(ggx_visibility(0.6f, 0.8f, 0.3f))));
  CHECK(ggx_bound(wo, even) == doctest::Approx(double(ggx_bound(wo, 0.3f))));
  CHECK(ggx_pdf_reflected(wo, m, even, 0.7f) ==
        doctest::Approx(double(ggx_pdf_reflected(wo, m, 0.3f, 0.7f))));
  const Material metal = brushed(mirror_metal(0.1f), 0.7f);
  const BsdfTables tables({metal});
  const auto value = [&](float grain, float turn, bool is_front, float mirrored) {
    TexturePlace place;
    place.grain = {std::cos(grain), std::sin(grain)};
    return evaluate(make_bsdf(tables, {metal}, {}, 0, place, is_front),
                    direction(0.6f, mirrored * (0.3f + turn)),
                    direction(0.8f, mirrored * (2.9f + turn)))
        .g;
  };
  const double plain = double(value(0, 0, true, 1));
  CHECK(value(0.5f, 0.5f, true, 1) == doctest::Approx(plain).epsilon(1e-4));
  CHECK(value(1.4f, 0, true, 1) != doctest::Approx(plain).epsilon(0.1));
  // Seen from the back, whose frame has the opposite bitangent.
  CHECK(value(0.5f, 0.5f, false, -1) == doctest::Approx(plain).epsilon(1e-4));
}
