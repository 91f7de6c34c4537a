// Reciprocity: f(wo,wi) n(wi's side)² is symmetric.
#include <doctest/doctest.h>

#include "bsdf/samples.h"

using namespace troffer;
using namespace troffer::test;

namespace {

Vec3 random_direction(Random& random, bool is_above) {
  Vec3 w = sphere_from_square(random.next_vec2());
  w.z = std::max(std::abs(w.z), 0.01f);
  w = normalize(w);
  if (!is_above) w.z = -w.z;
  return w;
}

// Converts to the frame of a viewer on the other side, with inverted z.
Vec3 turned(const Vec3& w) {
  return {w.x, w.y, -w.z};
}

}  // namespace

TEST_CASE("scattering is reciprocal") {
  Material mixed = gltf(0.3f, 0.3f, {0.2f, 0.5f, 0.9f}, 0.4f);
  mixed.specular_color.value = {1.5f, 1, 0.3f};
  mixed.specular.value = 0.8f;
  Material thin = mixed;
  thin.is_thin = true;
  const Specimens s{
      {"diffuse", material_of(MaterialKind::diffuse, 0, {0.2f, 0.4f, 0.6f})},
      {"copper", copper(0.2f)},
      {"rough copper", copper(0.9f)},
      {"metal", mirror_metal(0.5f, {0.3f, 0.7f, 0.9f})},
      {"coated", coated(0.3f, {0.3f, 0.7f, 0.9f})},
      {"smooth coated", coated(0, {0.3f, 0.7f, 0.9f}, 1.8f)},
      {"glass", glass(0.3f)},
      {"rough glass", glass(0.9f, 2.0f)},
      {"thin glass", glass(0.3f, 1.5f, true)},
      {"glTF", gltf(0.4f, 0.4f, {0.3f, 0.7f, 0.9f})},
      {"glTF mixed", mixed},
      {"glTF thin", thin},
      {"brushed copper", brushed(copper(0.1f), 0.6f)},
      {"brushed glTF", brushed(gltf(0.3f, 0.5f, {0.3f, 0.7f, 0.9f}), 0.8f)},
      {"cloth", cloth(0.7f, {0.9f, 0.3f, 0.5f})},
      {"smooth cloth", cloth(0.4f, {0.9f, 0.3f, 0.5f}, 0)},
      {"coat over copper", clear_coated(copper(0.2f), 0.1f)},
      {"smooth coat over copper", clear_coated(copper(0.3f), 0)},
      {"coat over brushed copper", clear_coated(brushed(copper(0.1f), 0.6f), 0.1f)},
      {"half a coat over glTF", clear_coated(gltf(0.4f, 0.4f, {0.3f, 0.7f, 0.9f}), 0.2f, 0.5f)},
      {"coat over cloth", clear_coated(cloth(0.7f, {0.9f, 0.3f, 0.5f}), 0.2f)},
      {"coat over a coat", clear_coated(coated(0.3f, {0.3f, 0.7f, 0.9f}), 0.1f)},
      {"coat over glass", clear_coated(glass(0.3f), 0.1f)},
      {"smooth coat over rough glass", clear_coated(glass(0.9f, 2.0f), 0)},
      {"coat over thin glass", clear_coated(glass(0.3f, 1.5f, true), 0.1f)},
      {"half a coat over glTF mixed", clear_coated(mixed, 0.2f, 0.5f)},
      {"coat over glTF thin", clear_coated(thin, 0.2f)},
      {"sheen over metal", sheened(gltf(0.5f, 1, {0.3f, 0.7f, 0.9f}), 0.6f)},
      {"sheen over half metal", sheened(gltf(0.5f, 0.5f), 0.6f, {0.9f, 0.3f, 0.5f})},
      {"sheen over brushed metal", sheened(brushed(gltf(0.3f, 1), 0.8f), 0.6f)},
      {"sheen over glass", sheened(gltf(0.4f, 0, Rgb{1}, 1), 0.6f, {0.9f, 0.3f, 0.5f})},
      {"sheen over glTF thin", sheened(thin, 0.6f)},
      {"coat over sheen over glass", clear_coated(sheened(mixed, 0.6f), 0.2f)},
      {"tinted copper", tinted(0.3f)},
      {"glass that reflects less", reflecting(glass(0.5f), {0.9f, 0.5f, 0})},
      {"coat that reflects less", reflecting(coated(0.3f, Rgb{0.8f}), {0.9f, 0.5f, 0})},
      {"coat over tinted copper", clear_coated(tinted(0.3f), 0.2f)},
      {"film", filmed(gltf(0.4f, 0.4f, {0.3f, 0.7f, 0.9f}), 450)},
      {"film over glass", filmed(gltf(0.3f, 0, Rgb{1}, 1), 450)},
      {"film over very rough glass", filmed(gltf(0.9f, 0, {0.9f, 0.6f, 0.8f}, 1), 400, 1.8f)},
      {"coat over film over glass", clear_coated(filmed(gltf(0.7f, 0, Rgb{1}, 1), 450), 0.2f)},
  };
  Random random(1);
  int compared = 0;
  for (size_t k = 0; k < s.size(); ++k) {
    const bool has_transmission = s.at(k).has_transmission;
    for (int i = 0; i < 2000; ++i) {
      const bool is_front = random.next_float() < 0.5f;
      const bool crosses = has_transmission && random.next_float() < 0.5f;
      const Vec3 wo = random_direction(random, true);
      Vec3 wi = random_direction(random, !crosses);
      const Bsdf here = s.at(k, is_front), there = s.at(k, is_front != crosses);
      const Vec3 back_wo = crosses ? turned(wi) : wi, back_wi = crosses ? turned(wo) : wo;
      const bool bends = crosses && !here.is_thin;
      const float n2 = bends ? here.eta * here.eta : 1.0f;
      const Rgb a = evaluate(here, wo, wi) * (n2 / std::abs(wi.z));
      const Rgb b = evaluate(there, back_wo, back_wi) * (1 / std::abs(back_wi.z));
      INFO(s.names[k], " front ", is_front, " crosses ", crosses, " wo.z ", wo.z, " wi.z ", wi.z);
      for (size_t c = 0; c < 3; ++c)
        CHECK(a[c] == doctest::Approx(double(b[c])).epsilon(2e-3).scale(1e-3));
      compared += a.g > 0;
    }
  }
  CHECK(compared > 20000);
}
