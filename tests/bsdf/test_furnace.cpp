// White furnace: surfaces without absorption send on all the light that meets them.
#include <doctest/doctest.h>

#include "bsdf/fresnel.h"
#include "bsdf/samples.h"

using namespace troffer;
using namespace troffer::test;

namespace {

constexpr float cosines[] = {0.02f, 0.05f, 0.1f, 0.2f, 0.35f, 0.5f, 0.7f, 0.9f, 1.0f};
constexpr float alphas[] = {0, 1e-3f, 0.004f, 0.02f, 0.05f, 0.1f, 0.25f, 0.5f, 0.75f, 1.0f};

// Checks every cosine on the given side and prints the worst.
void check_furnace(const Specimen& s, double loss, double gain, bool is_front = true) {
  const Bsdf b = s.at(is_front);
  double least = 2, most = 0;
  for (const float c : cosines) {
    const double e = scattered(b, direction(c)).total();
    least = std::min(least, e);
    most = std::max(most, e);
  }
  INFO(s.name, " alpha ", s.materials[0].roughness.value, " front ", is_front, ": ", least, " ",
       most);
  CHECK(least >= 1 - loss);
  CHECK(most <= 1 + gain);
}

}  // namespace

TEST_CASE("opaque white surfaces reflect everything") {
  for (const float alpha : alphas) {
    check_furnace({"conductor", mirror_metal(alpha)}, 0.01, 1e-3);
    check_furnace({"white metal", gltf(alpha, 1)}, 0.01, 1e-3);
    check_furnace({"white dielectric", gltf(alpha, 0)}, 0.01, 1e-3);
    check_furnace({"half metal", gltf(alpha, 0.5f)}, 0.01, 1e-3);
    for (const float ior : {1.1f, 1.5f, 2.5f})
      check_furnace({"coated", coated(alpha, Rgb{1}, ior)}, 0.01, 1e-3);
  }
}

TEST_CASE("lossless glass sends everything on") {
  for (const float alpha : alphas) {
    for (const bool is_front : {true, false}) {
      for (const float ior : {1.1f, 1.5f, 2.5f, 0.75f})
        check_furnace({"glass", glass(alpha, ior)}, 0.01, 1e-3, is_front);
      check_furnace({"glTF glass", gltf(alpha, 0, Rgb{1}, 1)}, 0.01, 1e-3, is_front);
      check_furnace({"glTF half glass", gltf(alpha, 0, Rgb{1}, 0.5f)}, 0.01, 1e-3, is_front);
    }
    check_furnace({"thin glass", glass(alpha, 1.5f, true)}, 0.01, 1e-3);
    check_furnace({"thin glTF glass", gltf(alpha, 0.3f, Rgb{1}, 0.5f, true)}, 0.01, 1e-3);
  }
}

TEST_CASE("no surface makes energy, and the estimated albedo is close") {
  Random random(5);
  for (int trial = 0; trial < 300; ++trial) {
    const auto u = [&] { return random.next_float(); };
    Material m;
    m.kind = MaterialKind(random.next_u32() % 5);
    m.roughness.value = u() * u();
    m.base_color.value = Rgb{1.2f * u(), 1.2f * u(), 1.2f * u()};
    m.metallic.value = u() < 0.5f ? 0.0f : u();
    m.specular.value = u();
    m.specular_color.value = Rgb{2 * u(), 2 * u(), 2 * u()};
    m.transmission.value = u() < 0.5f ? 0.0f : u();
    m.ior = 1 + 2 * u();
    m.is_thin = u() < 0.3f;
    m.is_reflectance = u() < 0.5f;
    m.eta = {0.1f + 2 * u(), 0.1f + 2 * u(), 0.1f + 2 * u()};
    m.k = {4 * u(), 4 * u(), 4 * u()};
    const Specimen s("random", m);
    const bool is_front = u() < 0.5f;
    const float c = 0.02f + 0.98f * u();
    const double e = scattered(s.at(is_front), direction(c), 1u << 13).total();
    INFO("kind ", int(m.kind), " roughness ", m.roughness.value, " cosine ", c, " ior ", m.ior,
         " transmission ", m.transmission.value, " thin ", m.is_thin, " front ", is_front);
    CHECK(e <= 1 + 2e-3);
    CHECK(double(albedo(s.at(is_front), c).g) == doctest::Approx(e).epsilon(0.02).scale(2.5));
  }
}

TEST_CASE("without specular a glTF dielectric is Lambertian") {
  Material m = gltf(0.3f, 0, {0.2f, 0.5f, 0.8f});
  m.specular.value = 0;
  const Specimen s("plain", m);
  Rgb rho;
  REQUIRE(is_lambertian(s.at(), &rho));
  CHECK(rho == Rgb{0.2f, 0.5f, 0.8f});
  CHECK(evaluate(s.at(), direction(0.3f), direction(0.6f)).g ==
        doctest::Approx(0.5 * 0.6 / pi).epsilon(1e-6));
}

TEST_CASE("a smooth coat over diffuse follows the closed form") {
  const float ior = 1.5f, rho = 0.6f;
  const Specimen s("coated", coated(0, Rgb{rho}, ior));
  const float wo = 0.4f, wi = 0.8f;
  const double f_int = 1 - (1 - double(fresnel_dielectric_average(ior))) / (1.5 * 1.5);
  CHECK(f_int == doctest::Approx(0.5963).epsilon(1e-3));  // known mean internal reflectance
  const double t =
      (1 - double(fresnel_dielectric(wo, ior))) * (1 - double(fresnel_dielectric(wi, ior)));
  const double expected = t * 0.6 / (pi * 1.5 * 1.5 * (1 - 0.6 * f_int)) * 0.8;
  CHECK(evaluate(s.at(), direction(wo), direction(wi)).g ==
        doctest::Approx(expected).epsilon(1e-5));
}
