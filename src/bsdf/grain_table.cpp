#include "bsdf/grain_table.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "bsdf/sheen.h"

namespace troffer {

namespace {

float table_cosine(size_t i) {
  return std::max(sqr(sqr(float(i) / float(table_cosines - 1))), 1e-6f);
}

// Midpoint rule over the random numbers of visible normals, with nodes placed as in
// albedo_table.cpp.
float grained_albedo(const Vec3& wo, const GgxWidths& a) {
  constexpr int n = 32;
  const float at_o = ggx_stretched(wo, a);
  float sum = 0;
  for (int j = 0; j < n; ++j) {
    const float rest = 1 - (float(j) + 0.5f) / n;
    for (int i = 0; i < n; ++i) {
      const Vec3 m = ggx_sample_visible_normal(wo, {(float(i) + 0.5f) / n, 1 - rest * rest}, a, 1);
      const Vec3 wi = m * (2 * dot(wo, m)) - wo;
      if (!(wi.z > 0)) continue;
      // G2 / G1 = (1 + Lambda(o)) / (1 + Lambda(o) + Lambda(i)), multiplied by 2 o i
      const float masked = (at_o + wo.z) * wi.z;
      sum += 2 * rest * masked / (at_o * wi.z + ggx_stretched(wi, a) * wo.z);
    }
  }
  return std::min(sum / float(n * n), 1.0f);
}

// Returns the same below a clear coat, relative to the light that the coat passes; `seen` is the
// direction outside.
float grained_albedo_below(const Vec3& seen, const GgxWidths& a, const ClearCoat& over) {
  // More nodes than above, and each row shifted: the critical angle makes an edge in the integrand.
  constexpr int n = 80;
  constexpr float golden = 0.618034f;
  const Vec3 wo = over.below(seen);
  const float at_o = ggx_stretched(wo, a), pass = over.pass(seen.z);
  const float kept = over.gloss_pass(seen.z);
  if (!(pass > 0)) return 1;
  float sum = 0;
  for (int j = 0; j < n; ++j) {
    const float turn = golden * float(j) - std::floor(golden * float(j));
    for (int i = 0; i < n; ++i) {
      const Vec3 m =
          ggx_sample_visible_normal(wo, {(float(i) + turn) / n, (float(j) + 0.5f) / n}, a, 1);
      const Vec3 in = m * (2 * dot(wo, m)) - wo;
      Vec3 wi;
      if (!(in.z > 0) || !over.above(in, wi)) continue;
      const float masked = (at_o + wo.z) * in.z / (at_o * in.z + ggx_stretched(in, a) * wo.z);
      sum += masked * std::min(over.gloss_pass(wi.z), kept) / pass;
    }
  }
  return std::min(sum / float(n * n), 1.0f);
}

// Returns the albedo of white sheen at a cosine. By symmetry half of the azimuths suffice.
float sheen_albedo(float cosine, float alpha) {
  constexpr int heights = 32, azimuths = 24;
  const Vec3 wo{std::sqrt(1 - cosine * cosine), 0, cosine};
  double sum = 0;
  for (int j = 0; j < heights; ++j) {
    const float t = (float(j) + 0.5f) / heights, z = t * t, r = std::sqrt(1 - z * z);
    for (int i = 0; i < azimuths; ++i) {
      const float phi = pi_f * (float(i) + 0.5f) / azimuths;
      const float f = sheen_value(wo, {r * std::cos(phi), r * std::sin(phi), z}, alpha);
      sum += double(f * z * 2 * t);
    }
  }
  return float(std::min(sum * 2 * pi / (heights * azimuths), 1.0));
}

}  // namespace

GrainTable make_grain_table(const GgxWidths& widths, const ClearCoat& over) {
  // Without a grain all azimuths are equal.
  const int azimuths = widths.along > widths.across ? 4 : 1;
  GrainTable table;
  table.widths = widths;
  table.over = over;
  for (size_t k = 0; k < table_cosines; ++k) {
    const float c = std::min(table_cosine(k), 1.0f), s = std::sqrt(1 - c * c);
    float even = 0, twice = 0;
    for (int i = 0; i < azimuths; ++i) {
      const float phi = 0.5f * pi_f * (float(i) + 0.5f) / float(azimuths);
      const Vec3 wo{s * std::cos(phi), s * std::sin(phi), c};
      const float e =
          over.share > 0 ? grained_albedo_below(wo, widths, over) : grained_albedo(wo, widths);
      even += e / float(azimuths);
      twice += e * std::cos(2 * phi) * 2 / float(azimuths);
    }
    table.even[k] = table.even[k + table_cosines] = even;
    table.twice[k] = table.twice[k + table_cosines] = twice;
  }
  table.average = row_average(table.even.data());
  return table;
}

void build_sheen_table(AlbedoTable& table) {
  for (size_t a = 0; a < table_alphas; ++a) {
    const float at = lerp(AlphaCoordinate::first, 1.0f, float(a) / float(table_alphas - 1));
    const float alpha = std::max(sqr(sqr(at)), least_sheen_alpha);
    float* row = table.values.data() + a * table_cosines;
    for (size_t k = 0; k < table_cosines; ++k)
      row[k] = sheen_albedo(std::min(table_cosine(k), 1.0f), alpha);
    table.averages[a] = row_average(row);
  }
}

}  // namespace troffer
