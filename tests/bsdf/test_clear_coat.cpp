// Clear coats over gloss: energy, closed forms, and comparison with random walks between both
// surfaces.
#include <doctest/doctest.h>

#include <algorithm>

#include "bsdf/fresnel.h"
#include "bsdf/samples.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// Light that returns from random walks between a glass coat and the metal below it, each
// represented by its own Bsdf: total, and spread about the mirror direction.
struct Walked {
  double energy = 0;
  double spread = 0;  // mean squared tilt of the half vector within 45 degrees
};

struct Spread {
  double energy = 0, within = 0, squares = 0;
  void add(const Vec3& wo, const Vec3& wi, double weight) {
    energy += weight;
    const Vec3 h = normalize(wo + wi);
    if (h.z < 0.70710678f) return;
    within += weight;
    squares += weight * double((1 - h.z * h.z) / (h.z * h.z));
  }
  Walked over(double n) const { return {energy / n, within > 0 ? squares / within : 0}; }
};

Walked walked(const Specimens& s, const Vec3& wo, uint32_t n) {
  const Bsdf outside = s.at(0, true), inside = s.at(0, false), metal = s.at(1);
  Random random(9);
  Spread sum;
  for (uint32_t i = 0; i < n; ++i) {
    BsdfSample x;
    const auto draw = [&](const Bsdf& b, const Vec3& w) {
      const float lobe = random.next_float();
      return sample(b, w, lobe, random.next_vec2(), x);
    };
    if (!draw(outside, wo)) continue;
    double weight = double(x.weight.g) * double(x.eta) * double(x.eta);
    Vec3 w = x.wi;
    for (int step = 0; w.z < 0 && weight > 0 && step < 200; ++step) {
      if (!draw(metal, -w)) {
        weight = 0;
        break;
      }
      weight *= double(x.weight.g);
      // The frame below the coat has an inverted z.
      if (!draw(inside, Vec3{-x.wi.x, -x.wi.y, x.wi.z})) {
        weight = 0;
        break;
      }
      weight *= double(x.weight.g) * double(x.eta) * double(x.eta);
      w = {x.wi.x, x.wi.y, -x.wi.z};
    }
    if (w.z > 0 && weight > 0) sum.add(wo, w, weight);
  }
  return sum.over(n);
}

Walked sampled(const Bsdf& b, const Vec3& wo, uint32_t n) {
  Random random(10);
  Spread sum;
  for (uint32_t i = 0; i < n; ++i) {
    BsdfSample x;
    const float lobe = random.next_float();
    if (sample(b, wo, lobe, random.next_vec2(), x)) sum.add(wo, x.wi, double(x.weight.g));
  }
  return sum.over(n);
}

}  // namespace

TEST_CASE("white gloss under a clear coat reflects everything, and never more") {
  double least = 2, most = 0;
  NamedMaterials coats;
  for (const float alpha : {0.0f, 0.1f, 0.3f, 1.0f})
    for (const float coat : {0.0f, 0.1f, 1.0f})
      coats.insert(coats.end(),
                   {{"metal", clear_coated(mirror_metal(alpha), coat)},
                    {"metal, dense coat", clear_coated(mirror_metal(alpha), coat, 1, 2)},
                    {"glTF metal", clear_coated(gltf(alpha, 1), coat)},
                    {"glTF half metal", clear_coated(gltf(alpha, 0.5f), coat, 0.6f)},
                    {"glTF dielectric", clear_coated(gltf(alpha, 0), coat)},
                    {"coat", clear_coated(coated(alpha), coat)}});
  const Specimens s(coats);
  for (size_t i = 0; i < s.size(); ++i)
    for (const float c : {0.05f, 0.3f, 1.0f}) {
      const double e = scattered(s.at(i), direction(c), 1u << 13).total();
      INFO(s.names[i], " alpha ", s.materials[i].roughness.value, " coat ",
           s.materials[i].coat_roughness.value, " cosine ", c, ": ", e);
      CHECK(e < 1.003);
      CHECK(e > 0.97);
      least = std::min(least, e);
      most = std::max(most, e);
    }
  MESSAGE("white gloss under a clear coat: ", least, " to ", most);
}

TEST_CASE("lossless glass under a clear coat passes on all light, from both sides") {
  double least = 2, most = 0;
  NamedMaterials coats;
  for (const float alpha : {0.0f, 0.1f, 0.3f, 1.0f})
    for (const float coat : {0.0f, 0.1f, 1.0f})
      coats.insert(coats.end(),
                   {{"glass", clear_coated(glass(alpha), coat)},
                    {"dense glass", clear_coated(glass(alpha, 2.5f), coat, 1, 1.3f)},
                    {"light glass", clear_coated(glass(alpha, 0.75f), coat)},
                    {"thin glass", clear_coated(glass(alpha, 1.5f, true), coat)},
                    {"matched glass", clear_coated(glass(alpha, 1), coat)},
                    {"half a coat", clear_coated(gltf(alpha, 0, Rgb{1}, 1), coat, 0.5f)},
                    {"half glass", clear_coated(gltf(alpha, 0, Rgb{1}, 0.5f), coat)},
                    {"half metal", clear_coated(gltf(alpha, 0.5f, Rgb{1}, 1, true), coat, 0.6f)}});
  const Specimens s(coats);
  for (size_t i = 0; i < s.size(); ++i)
    for (const bool is_front : {true, false})
      for (const float c : {0.05f, 0.3f, 0.7f, 1.0f}) {
        const Bsdf b = s.at(i, is_front);
        const double e = scattered(b, direction(c), 1u << 12).total();
        INFO(s.names[i], " alpha ", s.materials[i].roughness.value, " coat ",
             s.materials[i].coat_roughness.value, " cosine ", c, " front ", is_front, ": ", e);
        CHECK(e < 1.007);
        // Where a facet would refract one of two directions at the horizon, coats assume that the
        // light leaves the glass. A body of lower index loses most.
        CHECK(e > (s.names[i] == "light glass" ? 0.82 : 0.95));
        least = std::min(least, e);
        most = std::max(most, e);
      }
  MESSAGE("lossless glass under a clear coat: ", least, " to ", most);
}

TEST_CASE("diffusely transmitted light meets the coat on both sides") {
  for (const float coat : {0.0f, 0.3f}) {
    Material paper = clear_coated(gltf(0.4f, 0), coat, 0.8f);
    paper.diffuse_transmission.value = 0.6f;
    const Specimens s{{"paper", paper}};
    for (const float c : {0.1f, 0.5f, 1.0f}) {
      const Bsdf b = s.at(0);
      const double e =
          scattered(b, direction(c)).total() + scattered(through_part(b), direction(c)).total();
      CHECK(e == doctest::Approx(1).epsilon(0.01));
      for (const float other : {0.2f, 0.8f}) {
        const float there =
            evaluate(through_part(s.at(0, true)), direction(c), direction(other)).g / other;
        const float back =
            evaluate(through_part(s.at(0, false)), direction(other), direction(c)).g / c;
        CHECK(double(there) == doctest::Approx(double(back)).epsilon(1e-4));
        CHECK(there > 0.05f);
      }
    }
  }
}

// Compares with a face's reflection and transmission at normal incidence, from outside and from
// within.
TEST_CASE("a sheet under coats equals two coated faces") {
  const Specimens s{{"face", clear_coated(glass(0), 0)},
                    {"sheet", clear_coated(glass(0, 1.5f, true), 0)},
                    {"rough coats", clear_coated(glass(0, 1.5f, true), 0.2f)}};
  const Scattered outside = scattered(s.at(0, true), direction(1), 1u << 12);
  const Scattered within = scattered(s.at(0, false), direction(1), 1u << 12);
  CHECK(outside.transmitted == doctest::Approx(within.transmitted).epsilon(1e-5));
  // 4 % at each surface: r + (1 - r)² r / (1 - r²)
  CHECK(outside.reflected ==
        doctest::Approx(0.04 + 0.96 * 0.96 * 0.04 / (1 - 0.0016)).epsilon(1e-4));
  const double t = outside.transmitted, r = within.reflected;
  const double through = t * t / (1 - r * r), back = outside.reflected + t * t * r / (1 - r * r);
  const Bsdf sheet = s.at(1);
  CHECK(is_purely_delta(sheet));
  CHECK(has_one_mirror(sheet));
  CHECK(double(straight_transmittance(sheet, direction(1)).g) ==
        doctest::Approx(through).epsilon(1e-4));
  CHECK(double(mirrored_reflectance(sheet, 1).g) == doctest::Approx(back).epsilon(1e-3));
  for (const float c : {0.1f, 0.5f, 0.9f}) {
    const Scattered e = scattered(sheet, direction(c), 1u << 12);
    CHECK(double(straight_transmittance(sheet, direction(c)).g) ==
          doctest::Approx(e.transmitted).epsilon(2e-3));
    CHECK(double(mirrored_reflectance(sheet, c).g) == doctest::Approx(e.reflected).epsilon(2e-3));
    // Rough coats take nearly as much of the transmitted light, but only the layer below them
    // mirrors.
    CHECK(double(straight_transmittance(s.at(2), direction(c)).g) ==
          doctest::Approx(e.transmitted).epsilon(0.25));
    CHECK(mirrored_reflectance(s.at(2), c).g < mirrored_reflectance(sheet, c).g);
  }
}

TEST_CASE("a smooth coat over a smooth metal sums the light reflected between them") {
  const Specimens s{{"copper", clear_coated(copper(0), 0)}};
  for (const float c : {0.1f, 0.4f, 0.8f, 1.0f}) {
    const double f = double(fresnel_dielectric(c, 1.5f));
    const float inside = refracted_cosine(c, 1.5f);
    const double r = double(fresnel_conductor(inside, 0.92f / 1.5f, 2.45f / 1.5f));
    const double expected = f + (1 - f) * (1 - f) * r / (1 - f * r);
    CHECK(scattered(s.at(0), direction(c), 256).total() == doctest::Approx(expected).epsilon(1e-4));
    CHECK(double(mirrored_reflectance(s.at(0), c).g) == doctest::Approx(expected).epsilon(1e-4));
  }
  CHECK(is_purely_delta(s.at(0)));
}

TEST_CASE("a coat over rough metal is close to random walks between both surfaces") {
  double energy_off = 0, spread_off = 0;
  for (const float alpha : {0.1f, 0.3f})
    for (const float coat : {0.0f, 0.1f, 0.3f}) {
      Material metal = copper(alpha);
      metal.eta = metal.eta / 1.5f;
      metal.k = metal.k / 1.5f;
      const Specimens s{{"glass", glass(coat)}, {"metal", metal}};
      const Specimens whole{{"coated", clear_coated(copper(alpha), coat)}};
      for (const float c : {0.3f, 0.7f, 1.0f}) {
        const Walked w = walked(s, direction(c), 1u << 14);
        const Walked one = sampled(whole.at(0), direction(c), 1u << 14);
        INFO("alpha ", alpha, " coat ", coat, " cosine ", c, ": ", one.energy, " ", w.energy,
             " spread ", std::sqrt(one.spread), " ", std::sqrt(w.spread));
        energy_off = std::max(energy_off, std::abs(one.energy / w.energy - 1));
        spread_off = std::max(spread_off, std::abs(std::sqrt(one.spread / w.spread) - 1));
        CHECK(one.energy == doctest::Approx(w.energy).epsilon(0.05));
        CHECK(std::sqrt(one.spread) == doctest::Approx(std::sqrt(w.spread)).epsilon(0.12));
      }
    }
  MESSAGE("from walks: energy within ", energy_off, ", spread within ", spread_off);
}

TEST_CASE("a coat reflects by its own normal, whatever the base's") {
  Material m = clear_coated(gltf(0.4f, 1), 0);
  m.has_coat_normal = true;
  m.coat_normal_texture = 0;
  const Specimens s{{"coat", m}};
  TexturePlace place(Vec2{0, 0});
  const Vec3 normal = normalize(Vec3{0.2f, 0.1f, 1});
  place.coat_normal = {normal.x, normal.y};
  const Bsdf b = make_bsdf(s.tables, s.materials, s.textures, 0, place, true);
  const Vec3 wo = direction(0.8f);
  int mirrored = 0;
  for (uint32_t i = 0; i < 4096; ++i) {
    const SobolGroup u(11, 3, i);
    BsdfSample x;
    if (!sample(b, wo, u.get(2), u.get2(0), x) || !x.is_delta) continue;
    ++mirrored;
    CHECK(length(x.wi + wo - normal * (2 * dot(wo, normal))) < 1e-4f);
  }
  CHECK(mirrored > 50);
}
