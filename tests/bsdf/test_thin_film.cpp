// Interference by angle compared with spectra: Airy's sum of complex amplitudes, per wavelength.
#include <doctest/doctest.h>

#include <complex>

#include "base/observer.h"
#include "bsdf/fresnel.h"
#include "bsdf/samples.h"

using namespace troffer;
using namespace troffer::test;

namespace {

using Complex = std::complex<double>;

// Returns the reflectance at one wavelength, averaged over both polarisations.
double airy(double cosine, double film, double base, double thickness_nm, double nm) {
  const double s = std::sqrt(1 - cosine * cosine);
  const double c2 = std::sqrt(1 - s * s / (film * film)), c3 = std::sqrt(1 - s * s / (base * base));
  const double delta = 4 * pi * film * thickness_nm * c2 / nm;
  const Complex way = std::exp(Complex(0, delta));
  double sum = 0;
  for (const bool is_parallel : {false, true}) {
    const double a = is_parallel ? c2 : cosine, b = is_parallel ? cosine : c2;
    const double r12 = (a - film * b) / (a + film * b) * (is_parallel ? -1.0 : 1.0);
    const double p = is_parallel ? c3 : c2, q = is_parallel ? c2 : c3;
    const double r23 = (film * p - base * q) / (film * p + base * q) * (is_parallel ? -1.0 : 1.0);
    sum += 0.5 * std::norm((r12 + r23 * way) / (1.0 + r12 * r23 * way));
  }
  return sum;
}

Rgb spectral(double cosine, double film, double base, double thickness_nm) {
  Vec3d sum, white;
  for (int nm = least_visible_nm; nm <= most_visible_nm; ++nm) {
    const Vec3d seen = color_matching(nm);
    sum += seen * airy(cosine, film, base, thickness_nm, nm);
    white += seen;
  }
  return rgb_from_xyz(sum) / rgb_from_xyz(white);
}

}  // namespace

TEST_CASE("a film's colours follow from its spectrum, by angle and thickness") {
  const InterferenceTable table = make_interference_table();
  double off = 0, varies = 0;
  for (const float base : {1.33f, 1.5f, 2.5f, 20.0f})
    for (const float ior : {1.2f, 1.33f, 1.8f})
      for (const float thickness : {0.0f, 100.0f, 250.0f, 400.0f, 730.0f, 1500.0f}) {
        ThinFilm film;
        film.share = 1;
        film.ior = ior;
        film.thickness_nm = thickness;
        film.table = &table;
        const Rgb f0{normal_reflectance(base)};
        for (const float c : {0.1f, 0.3f, 0.5f, 0.7f, 0.9f, 1.0f}) {
          Rgb expected = spectral(double(c), double(ior), double(base), double(thickness));
          const Rgb got = film_reflectance(film, f0, c);
          for (size_t k = 0; k < 3; ++k) {
            expected[k] = std::clamp(expected[k], 0.0f, 1.0f);
            INFO("base ", base, " film ", ior, " ", thickness, " nm, cosine ", c);
            CHECK(got[k] == doctest::Approx(double(expected[k])).scale(1).epsilon(2e-3));
            off = std::max(off, double(std::abs(got[k] - expected[k])));
          }
          varies = std::max(varies, double(std::abs(got.r - got.b)));
        }
      }
  MESSAGE("from spectra: within ", off);
  CHECK(varies > 0.1);
}

TEST_CASE("a film without thickness, or with the base's index, has no effect") {
  const InterferenceTable table = make_interference_table();
  ThinFilm film;
  film.share = 1;
  film.table = &table;
  for (const float c : {0.05f, 0.4f, 1.0f}) {
    film.ior = 1.3f;
    film.thickness_nm = 0;
    CHECK(film_reflectance(film, Rgb{0.04f}, c).g ==
          doctest::Approx(double(fresnel_dielectric(c, 1.5f))).epsilon(2e-3));
    film.ior = 1.5f;
    film.thickness_nm = 400;
    CHECK(film_reflectance(film, Rgb{0.04f}, c).b ==
          doctest::Approx(double(fresnel_dielectric(c, 1.5f))).epsilon(2e-3));
  }
}

TEST_CASE("surfaces under a film keep their energy, and change colour with the angle") {
  for (const float alpha : {0.0f, 0.1f, 0.5f})
    for (const float thickness : {150.0f, 400.0f, 900.0f}) {
      const Specimens s{{"metal", filmed(gltf(alpha, 1), thickness, 1.4f)},
                        {"dielectric", filmed(gltf(alpha, 0), thickness, 1.8f)},
                        {"half metal", filmed(gltf(alpha, 0.5f), thickness, 1.3f, 0.7f)},
                        {"thin glass", filmed(gltf(alpha, 0, Rgb{1}, 1, true), thickness)},
                        {"glass", filmed(gltf(alpha, 0, Rgb{1}, 1), thickness)}};
      for (size_t i = 0; i < s.size(); ++i)
        for (const float c : {0.1f, 0.3f, 0.6f, 1.0f}) {
          const double e = scattered(s.at(i), direction(c), 1u << 12).total();
          INFO(s.names[i], " alpha ", alpha, " ", thickness, " nm, cosine ", c, ": ", e);
          // lost light of glass: right per colour only on average
          CHECK(e < (i == 4 ? 1.007 : 1.003));
          CHECK(e > 0.8);
        }
    }
  Material tinted = filmed(gltf(0, 0, Rgb{1}, 1, true), 400, 1.5f), dark = tinted;
  tinted.absorption = Rgb{1e-6f};
  dark.absorption = {0.1f, 1, 20};
  const Specimens sheets{{"clear", filmed(gltf(0, 0, Rgb{1}, 1, true), 400, 1.5f)},
                         {"nearly", tinted},
                         {"dark", dark}};
  for (const float c : {0.2f, 0.7f, 1.0f}) {
    const Rgb clear = straight_transmittance(sheets.at(0), direction(c));
    const Rgb nearly = straight_transmittance(sheets.at(1), direction(c));
    for (size_t k = 0; k < 3; ++k)
      CHECK(clear[k] == doctest::Approx(double(nearly[k])).epsilon(1e-3));
    // The first face keeps its colours even if no light returns from the second.
    const Rgb mirrored = mirrored_reflectance(sheets.at(2), c);
    CHECK(straight_transmittance(sheets.at(2), direction(c)).b < 1e-6f);
    CHECK(mirrored.b < mirrored_reflectance(sheets.at(0), c).b);
    CHECK(mirrored.b > 0.3f * mirrored_reflectance(sheets.at(0), c).b);
  }
  const Specimens s{{"metal", filmed(gltf(0, 1, Rgb{0.9f}), 400, 1.4f)}};
  const auto hue = [&](float c) {
    const Rgb r = mirrored_reflectance(s.at(0), c);
    return double(r.r - r.b);
  };
  CHECK(std::abs(hue(1) - hue(0.3f)) > 0.02);
}
