// Samples follow their density, the density has the right integral, and weights are f |cos| / pdf.
#include <doctest/doctest.h>

#include "bsdf/samples.h"
#include "support/chi_square.h"
#include "support/quadrature.h"

using namespace troffer;
using namespace troffer::test;

namespace {

constexpr int rows = 16, columns = 24;  // bins over cos theta in [-1,1] and phi

// Returns the expected fraction per bin: the density integrated over (cos theta, phi).
std::vector<double> integrated_pdf(const Bsdf& b, const Vec3& wo, double tolerance) {
  std::vector<double> mass(size_t(rows * columns));
  for (int r = 0; r < rows; ++r) {
    const double z0 = -1 + 2.0 * r / rows, z1 = -1 + 2.0 * (r + 1) / rows;
    if (z1 <= 0 && !b.has_transmission) continue;
    for (int c = 0; c < columns; ++c) {
      const double p0 = 2 * pi * c / columns - pi, p1 = 2 * pi * (c + 1) / columns - pi;
      mass[size_t(r * columns + c)] = integrate_adaptive_2d(
          [&](double z, double phi) {
            const double s = std::sqrt(std::max(0.0, 1 - z * z));
            const Vec3 wi(Vec3d{s * std::cos(phi), s * std::sin(phi), z});
            return double(pdf(b, wo, wi));
          },
          z0, z1, p0, p1, tolerance, 5, 8);
    }
  }
  return mass;
}

int bin_of(const Vec3& w) {
  const int r = std::clamp(int((double(w.z) + 1) / 2 * rows), 0, rows - 1);
  const double phi = std::atan2(double(w.y), double(w.x));
  const int c = std::clamp(int((phi + pi) / (2 * pi) * columns), 0, columns - 1);
  return r * columns + c;
}

void check_sampling(const std::string& name, const Bsdf& b, float cosine, int tests) {
  const Vec3 wo = direction(cosine, 0.7f);
  constexpr int n = 40000;
  std::vector<double> observed(size_t(rows * columns) + 1);
  Random random(hash_of(uint64_t(1000 * cosine), uint64_t(b.eta * 100)));
  int bad_weights = 0, deltas = 0;
  for (int i = 0; i < n; ++i) {
    BsdfSample x;
    const float u_lobe = random.next_float();
    if (!sample(b, wo, u_lobe, random.next_vec2(), x)) {
      observed.back() += 1;
      continue;
    }
    if (x.is_delta) {
      ++deltas;
      observed.back() += 1;
      CHECK(x.pdf == 0);
      continue;
    }
    observed[size_t(bin_of(x.wi))] += 1;
    const BsdfValue v = evaluate_with_pdf(b, wo, x.wi);
    const double relative = std::abs(double(v.pdf) / double(x.pdf) - 1);
    const double weight = std::abs(double(v.f_cos.g / v.pdf) - double(x.weight.g));
    const bool is_unit = std::abs(length(x.wi) - 1) < 1e-5f;
    const bool is_side_right = x.is_transmission == (x.wi.z < 0);
    if (relative > 1e-3 || weight > 1e-3 * double(x.weight.g) || !is_unit || !is_side_right)
      ++bad_weights;
  }
  INFO(name, " eta ", b.eta, " cosine ", cosine);
  CHECK(bad_weights == 0);
  if (is_purely_delta(b)) {
    CHECK(deltas + int(observed.back()) >= n);
    return;
  }
  std::vector<double> expected = integrated_pdf(b, wo, 4e-5);
  double mass = 0;
  for (double& e : expected) {
    mass += e;
    e *= n;
  }
  // The remaining probability belongs to delta lobes and failed samples.
  CHECK(mass <= 1 + 1e-4);
  CHECK(std::abs(observed.back() / n - (1 - mass)) < 5 * std::sqrt(0.25 / n));
  expected.push_back(std::max(0.0, n * (1 - mass)));
  if (expected.back() < 1e-4 * n && observed.back() == 0) {
    observed.pop_back();
    expected.pop_back();
  }
  const auto r = chi_square_test(observed, expected, 1, sidak(1e-3, tests));
  CHECK_MESSAGE(r.is_accepted, r.text());
}

}  // namespace

TEST_CASE("samples follow the density") {
  Material mixed = gltf(0.35f, 0.3f, {0.2f, 0.5f, 0.9f}, 0.5f);
  Material mixed_thin = mixed;
  mixed_thin.is_thin = true;
  const Specimens s{
      {"diffuse", material_of(MaterialKind::diffuse, 0, {0.2f, 0.4f, 0.6f})},
      {"copper .1", copper(0.1f)},
      {"copper .4", copper(0.4f)},
      {"metal 1", mirror_metal(1)},
      {"smooth metal", mirror_metal(0)},
      {"coated 0", coated(0, {0.3f, 0.7f, 0.9f})},
      {"coated .2", coated(0.2f, {0.3f, 0.7f, 0.9f})},
      {"coated .8", coated(0.8f, {0.3f, 0.7f, 0.9f}, 2)},
      {"glass 0", glass(0)},
      {"glass .2", glass(0.2f)},
      {"glass .6", glass(0.6f, 2)},
      {"glass 1", glass(1, 1.2f)},
      {"thin glass .3", glass(0.3f, 1.5f, true)},
      {"glTF .15", gltf(0.15f, 0.5f, {0.3f, 0.7f, 0.9f})},
      {"glTF .7", gltf(0.7f, 0, {0.3f, 0.7f, 0.9f})},
      {"glTF mixed", mixed},
      {"glTF mixed thin", mixed_thin},
      {"brushed copper", brushed(copper(0.15f), 0.5f)},
      {"brushed glTF", brushed(gltf(0.3f, 0.5f, {0.3f, 0.7f, 0.9f}), 0.9f)},
      {"cloth", cloth(0.6f, {0.9f, 0.3f, 0.5f})},
      {"smooth cloth", cloth(0.9f, Rgb{1}, 0)},
      {"coat .2 over copper .3", clear_coated(copper(0.3f), 0.2f)},
      {"smooth coat over copper .4", clear_coated(copper(0.4f), 0)},
      {"coat .3 over smooth copper", clear_coated(copper(0), 0.3f)},
      {"coat over brushed copper", clear_coated(brushed(copper(0.15f), 0.5f), 0.2f)},
      {"coat .15 over glTF .5", clear_coated(gltf(0.5f, 0.5f, {0.3f, 0.7f, 0.9f}), 0.15f, 0.7f)},
      {"coat over cloth", clear_coated(cloth(0.6f, {0.9f, 0.3f, 0.5f}), 0.2f)},
      {"coat .1 over glass .3", clear_coated(glass(0.3f), 0.1f)},
      {"smooth coat over glass .4", clear_coated(glass(0.4f), 0)},
      {"coat .2 over smooth glass", clear_coated(glass(0), 0.2f)},
      {"smooth coat over smooth glass", clear_coated(glass(0), 0)},
      {"coat over thin glass", clear_coated(glass(0.3f, 1.5f, true), 0.2f)},
      {"coat over glTF mixed", clear_coated(mixed, 0.2f, 0.7f)},
      {"coat over glTF mixed thin", clear_coated(mixed_thin, 0.2f)},
      {"film over glass", filmed(gltf(0.5f, 0, Rgb{1}, 1), 450)},
      {"coat over film over glass", clear_coated(filmed(gltf(0.5f, 0, Rgb{1}, 1), 450), 0.2f)},
      {"sheen over metal", sheened(gltf(0.5f, 1, {0.3f, 0.7f, 0.9f}), 0.6f)},
      {"sheen over smooth metal", sheened(gltf(0, 1), 0.6f)},
      {"sheen over glass", sheened(gltf(0.4f, 0, Rgb{1}, 1), 0.6f, {0.9f, 0.3f, 0.5f})},
      {"sheen over smooth glass", sheened(gltf(0, 0, Rgb{1}, 1), 0.6f)},
      {"sheen over glTF mixed thin", sheened(mixed_thin, 0.6f)},
      {"coat over sheen over glass", clear_coated(sheened(mixed, 0.6f), 0.2f)},
      {"glass that reflects less", reflecting(glass(0.5f), {0.9f, 0.5f, 0})},
      {"coat that reflects less", reflecting(coated(0.3f, Rgb{0.8f}), {0.9f, 0.5f, 0})},
      {"tinted copper", tinted(0.3f)},
      {"film", filmed(gltf(0.3f, 0.5f, {0.3f, 0.7f, 0.9f}), 450)},
  };
  const float cosines[] = {0.05f, 0.4f, 0.95f};
  int tests = 0;
  for (size_t i = 0; i < s.size(); ++i) tests += s.at(i).has_transmission ? 6 : 3;
  for (size_t i = 0; i < s.size(); ++i)
    for (const bool is_front : {true, false}) {
      const Bsdf b = s.at(i, is_front);
      if (!is_front && !b.has_transmission) continue;
      for (const float c : cosines) check_sampling(s.names[i], b, c, tests);
    }
}

TEST_CASE("grazing and degenerate directions stay finite") {
  Material infinite = gltf(0.2f, 0);
  infinite.ior = 0;
  const Specimens s{
      {"diffuse", material_of(MaterialKind::diffuse, 0)},
      {"copper", copper(1e-3f)},
      {"metal", mirror_metal(1)},
      {"coated", coated(0.01f)},
      {"glass", glass(1e-3f)},
      {"glass", glass(1)},
      {"matched glass", glass(0.3f, 1.0005f)},
      {"nearly matched glass", glass(0.3f, 1.002f)},
      {"thin", glass(0.2f, 1.5f, true)},
      {"glTF", gltf(0.002f, 0.4f, {0.3f, 0.7f, 0.9f}, 0.5f)},
      {"brushed", brushed(mirror_metal(1e-4f), 0.5f)},
      {"brushed", brushed(mirror_metal(0.5f), 1)},
      {"cloth", cloth(0, Rgb{1})},
      {"cloth", cloth(1, Rgb{1}, 0)},
      {"coat", clear_coated(copper(1e-3f), 0.5f)},
      {"coat", clear_coated(mirror_metal(1), 0)},
      {"coat", clear_coated(mirror_metal(0), 0, 1, 50)},
      {"coat", clear_coated(gltf(1, 0.5f), 1, 0.5f, 1.0001f)},
      {"coat", clear_coated(glass(0.3f, 1.0005f), 0.2f, 0.5f)},
      {"coat", clear_coated(glass(1, 0.3f), 1, 1, 50)},
      {"coat", clear_coated(glass(0), 1e-3f)},
      {"film", filmed(gltf(0.2f, 1), 0)},
      {"film", filmed(gltf(0.2f, 0.5f, Rgb{1}, 0.5f, true), 1e6f, 10)},
      {"infinite index",
       [] {
         Material m = gltf(0.2f, 0);
         m.ior = 0;
         return m;
       }()},
  };
  const float zs[] = {0, 1e-30f, 1e-10f, 1e-6f, 1e-3f, 0.5f, 1};
  Random random(3);
  for (size_t k = 0; k < s.size(); ++k)
    for (const bool is_front : {true, false}) {
      const Bsdf b = s.at(k, is_front);
      for (const float zo : zs)
        for (int i = 0; i < 400; ++i) {
          const Vec3 wo = direction(zo, 6 * random.next_float());
          Vec3 wi = direction(zs[random.next_u32() % 7], 6 * random.next_float());
          if (i % 4 == 0) wi = {-wo.x, -wo.y, wo.z};
          if (i % 2) wi.z = -wi.z;
          const BsdfValue v = evaluate_with_pdf(b, wo, wi);
          bool is_good = is_finite(v.f_cos) && std::isfinite(v.pdf) && v.pdf >= 0 &&
                         v.f_cos.r >= 0 && v.f_cos.g >= 0 && v.f_cos.b >= 0;
          if (zo == 0 || wi.z == 0) is_good &= v.f_cos.is_black();
          BsdfSample x;
          const float edge[] = {0, one_minus_epsilon, random.next_float()};
          const Vec2 u{edge[random.next_u32() % 3], edge[random.next_u32() % 3]};
          if (sample(b, wo, edge[random.next_u32() % 3], u, x))
            is_good &= is_finite(x.weight) && is_finite(x.wi) && x.pdf >= 0 && zo > 0 &&
                       max_component(x.weight) < 1000;
          const Rgb a = albedo(b, zo);
          is_good &= is_finite(a) && max_component(a) < 1.1f;
          INFO(s.names[k], " zo ", zo, " wi.z ", wi.z, " weight ", x.weight.g, " pdf ", x.pdf);
          CHECK(is_good);
        }
    }
}
