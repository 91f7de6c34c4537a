// The diffuse and specular parts used by the 1992 method add up to the whole.
#include <doctest/doctest.h>

#include <algorithm>

#include "base/random.h"
#include "bsdf/samples.h"

using namespace troffer;
using namespace troffer::test;

namespace {

Specimens all_kinds() {
  std::vector<Material> m;
  m.push_back(material_of(MaterialKind::diffuse, 0, {0.7f, 0.5f, 0.3f}));
  m.push_back(material_of(MaterialKind::diffuse, 0, Rgb{0}));
  for (const float alpha : {0.0f, 0.05f, 0.3f, 1.0f}) {
    m.push_back(mirror_metal(alpha, {0.9f, 0.6f, 0.2f}));
    m.push_back(copper(alpha));
    m.push_back(coated(alpha, {0.6f, 0.7f, 0.1f}));
    m.push_back(coated(alpha, Rgb{0}));
    m.push_back(coated(alpha, Rgb{1}, 2.2f));
    m.push_back(glass(alpha));
    m.push_back(glass(alpha, 1.5f, true));
    for (const float metallic : {0.0f, 0.4f, 1.0f})
      for (const float transmission : {0.0f, 0.6f, 1.0f})
        for (const bool is_thin : {false, true})
          m.push_back(gltf(alpha, metallic, {0.8f, 0.5f, 0.9f}, transmission, is_thin));
  }
  m.push_back(brushed(gltf(0.1f, 0.4f, {0.8f, 0.5f, 0.9f}), 0.7f));
  m.push_back(cloth(0.6f, {0.9f, 0.3f, 0.5f}, 0.3f, {0.8f, 0.5f, 0.9f}));
  m.push_back(clear_coated(gltf(0.4f, 0.4f, {0.8f, 0.5f, 0.9f}), 0.2f, 0.7f));
  m.push_back(clear_coated(gltf(0.4f, 0, {0.8f, 0.5f, 0.9f}), 0));
  m.push_back(clear_coated(cloth(0.6f, {0.9f, 0.3f, 0.5f}), 0.1f));
  m.push_back(clear_coated(coated(0.2f, {0.8f, 0.5f, 0.9f}), 0.1f));
  m.push_back(clear_coated(copper(0.2f), 0));
  m.push_back(clear_coated(glass(0.3f), 0.1f));
  m.push_back(clear_coated(gltf(0.3f, 0.4f, {0.8f, 0.5f, 0.9f}, 0.6f, true), 0));
  m.push_back(tinted(0.3f));
  m.push_back(sheened(gltf(0.5f, 0.7f, {0.3f, 0.7f, 0.9f}), 0.6f));
  m.push_back(sheened(gltf(0.5f, 0.2f, {0.3f, 0.7f, 0.9f}, 0.6f, true), 0.6f));
  m.push_back(filmed(gltf(0.3f, 0.4f, {0.8f, 0.5f, 0.9f}), 450));
  m.push_back(cloth(0.9f, {0.1f, 1, 0.5f}, 0, {0.8f, 0.5f, 0.9f}));
  return Specimens(m);
}

double most(const Rgb& c) {
  return double(std::max({std::abs(c.r), std::abs(c.g), std::abs(c.b)}));
}
float least(const Rgb& c) {
  return std::min({c.r, c.g, c.b});
}

}  // namespace

TEST_CASE("both parts together scatter as the whole does") {
  const Specimens s = all_kinds();
  Random random(5);
  for (size_t i = 0; i < s.size(); ++i)
    for (const bool is_front : {true, false}) {
      const Bsdf whole = s.at(i, is_front), diffuse = diffuse_part(whole);
      const bool is_matte = is_lambertian(whole, nullptr);
      // A Lambertian surface is its own diffuse part and has no other part.
      const Bsdf specular = is_matte ? Bsdf{} : specular_part(whole);
      CAPTURE(i);
      CAPTURE(is_front);
      for (int k = 0; k < 200; ++k) {
        const Vec3 wo = direction(std::max(random.next_float(), 1e-3f), 6 * random.next_float());
        const Vec3 wi = direction(2 * random.next_float() - 1, 6 * random.next_float());
        const Rgb all = evaluate(whole, wo, wi);
        const Rgb sum = evaluate(diffuse, wo, wi) + evaluate(specular, wo, wi);
        CHECK(most(sum - all) <= 1e-5 * most(all) + 1e-7);
        // The diffuse part only reflects, and no value is negative.
        if (wi.z < 0) CHECK(evaluate(diffuse, wo, wi).is_black());
        CHECK(least(evaluate(diffuse, wo, wi)) >= 0);
        CHECK(least(evaluate(specular, wo, wi)) >= 0);
        const Rgb a = albedo(whole, wo.z);
        const Rgb parts = albedo(diffuse, wo.z) + albedo(specular, wo.z);
        CHECK(most(parts - a) <= 1e-5 * most(a) + 1e-7);
      }
    }
}

TEST_CASE("the coat's transmittances in both directions are factors of the diffuse part") {
  const Specimens s = all_kinds();
  Random random(6);
  for (size_t i = 0; i < s.size(); ++i) {
    const Bsdf diffuse = diffuse_part(s.at(i));
    CAPTURE(i);
    for (int k = 0; k < 50; ++k) {
      const Vec3 wo = direction(std::max(random.next_float(), 1e-3f), 6 * random.next_float());
      const Vec3 wi = direction(std::max(random.next_float(), 1e-3f), 6 * random.next_float());
      const Rgb value = evaluate(diffuse, wo, wi);
      const Rgb product = albedo(diffuse, wo.z) * (coat_share(diffuse, wi.z) * wi.z * inv_pi_f);
      CHECK(most(product - value) <= 1e-4 * most(value) + 1e-7);
    }
  }
}

TEST_CASE("each part scatters by its albedo and samples what it evaluates") {
  const Specimens s = all_kinds();
  for (size_t i = 0; i < s.size(); ++i) {
    const Bsdf whole = s.at(i);
    if (is_lambertian(whole, nullptr)) continue;
    for (const float cosine : {0.2f, 0.7f}) {
      const Vec3 wo = direction(cosine);
      CAPTURE(i);
      CAPTURE(cosine);
      const Bsdf diffuse = diffuse_part(whole), specular = specular_part(whole);
      const double d = diffuse.has_separable ? scattered(diffuse, wo, 1u << 12).total() : 0;
      const bool is_specular = has_glossy(specular) || specular.has_separable;
      const double g = is_specular ? scattered(specular, wo, 1u << 12).total() : 0;
      // The diffuse part is cosine-shaped, so its albedo is exact up to the tables.
      CHECK(d == doctest::Approx(double(albedo(diffuse, wo.z).g)).epsilon(0.01));
      CHECK(d + g == doctest::Approx(scattered(whole, wo, 1u << 12).total()).epsilon(0.02));
    }
  }
}

TEST_CASE("metals and glass have no diffuse part; matte materials have only that") {
  const Specimens s({{"mirror", mirror_metal(0)},
                     {"glass", glass(0)},
                     {"rough glass", glass(0.5f)},
                     {"matte", material_of(MaterialKind::diffuse, 0, Rgb{0.5f})},
                     {"rough mirror", mirror_metal(0.5f)}});
  for (size_t i : {0, 1, 2, 4}) CHECK(!diffuse_part(s.at(i)).has_separable);
  CHECK(is_purely_delta(specular_part(s.at(0))));
  CHECK(is_purely_delta(specular_part(s.at(1))));
  CHECK(!is_purely_delta(specular_part(s.at(2))));
  CHECK(is_lambertian(diffuse_part(s.at(3)), nullptr));
  // Energy returned after loss between microfacets belongs to the specular part.
  CHECK(specular_part(s.at(4)).has_separable);
}
