#include "bsdf/albedo_table.h"

#include "base/units.h"
#include "bsdf/fresnel.h"
#include "bsdf/ggx.h"

namespace troffer {

namespace {

constexpr size_t azimuths = 12, heights = 20;

// A microfacet seen from wo. Nodes carry equal shares of the visible normals.
struct Facet {
  float cos_o;     // wo·m
  float normal_z;  // m.z
  float reflect;   // G2 / G1 of the mirror direction, 0 where it runs below the horizon
};
using Facets = std::array<Facet, azimuths * heights>;

// G2 / G1(o) = (1 + Lambda(o)) / (1 + Lambda(o) + Lambda(i)).
float masking(float lambda_o, float cos_i, float alpha) {
  return (1 + lambda_o) / (1 + lambda_o + ggx_lambda(cos_i, alpha));
}

// Midpoint rule over the unit square of ggx_sample_visible_normal; by symmetry half the azimuths
// suffice, and their periodicity makes few of them exact enough.
Facets visible_facets(const Vec3& wo, float lambda_o, float alpha) {
  Facets facets;
  for (size_t j = 0; j < heights; ++j)
    for (size_t i = 0; i < azimuths; ++i) {
      const Vec2 u{(float(i) + 0.5f) / (2 * float(azimuths)), (float(j) + 0.5f) / float(heights)};
      const Vec3 m = ggx_sample_visible_normal(wo, u, alpha, 1);
      const float c = std::min(std::max(dot(wo, m), 0.0f), 1.0f);
      const float z = 2 * c * m.z - wo.z;
      facets[j * azimuths + i] = {c, m.z, z > 0 ? masking(lambda_o, z, alpha) : 0.0f};
    }
  return facets;
}

// Reflection and refraction of glass with relative index eta.
float glass_albedo(const Facets& facets, const Vec3& wo, float lambda_o, float alpha, float eta) {
  float sum = 0;
  for (const Facet& f : facets) {
    const float r = fresnel_dielectric(f.cos_o, eta);
    sum += r * f.reflect;
    if (r >= 1) continue;
    const float z = (f.cos_o / eta - refracted_cosine(f.cos_o, eta)) * f.normal_z - wo.z / eta;
    if (z < 0) sum += (1 - r) * masking(lambda_o, -z, alpha);
  }
  return sum / float(facets.size());
}

float schlick_weight(float c) {
  return pow5(1 - c);
}

// Averages of the piecewise linear interpolant in t = sqrt(c): 2 ∫ E c dc = 4 ∫ E t³ dt.
// Three-point Gauss quadrature is exact on each interval (degree 4).
void finish(AlbedoTable& table) {
  constexpr std::array<double, 3> node{0.11270166537925831, 0.5, 0.88729833462074169};
  constexpr std::array<double, 3> weight{5.0 / 18, 8.0 / 18, 5.0 / 18};
  constexpr double h = 1.0 / double(table_cosines - 1);
  for (size_t a = 0; a < table_alphas; ++a) {
    const float* row = table.values.data() + a * table_cosines;
    double sum = 0;
    for (size_t k = 0; k + 1 < table_cosines; ++k)
      for (size_t q = 0; q < 3; ++q) {
        const double t = (double(k) + node[q]) * h;
        sum += 4 * h * weight[q] * t * t * t * lerp(double(row[k]), double(row[k + 1]), node[q]);
      }
    table.averages[a] = float(std::min(sum, 1.0));
  }
}

// 2 ∫ f(c) c dc, midpoint rule in t = sqrt(c).
template <class F>
float hemisphere_average(const F& f) {
  constexpr int n = 256;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double t = (i + 0.5) / n;
    sum += 4 * t * t * t * double(f(float(t * t)));
  }
  return float(sum / n);
}

}  // namespace

void build_albedo_tables(GgxTables& ggx, std::vector<CoatTable>& coats,
                         std::vector<GlassTables>& glasses) {
  for (size_t at = 0; at < table_cosines * table_alphas; ++at) {
    const float s = float(at / table_cosines) / float(table_alphas - 1);
    const float t = float(at % table_cosines) / float(table_cosines - 1);
    const float alpha = s * s, c = std::max(t * t, 1e-5f);
    if (at < table_cosines) {  // alpha = 0: a mirror
      ggx.one.values[at] = 1;
      ggx.grazing.values[at] = schlick_weight(t * t);
      for (CoatTable& x : coats) x.reflected.values[at] = fresnel_dielectric(t * t, x.ior);
      for (GlassTables& x : glasses) x.outside.values[at] = x.inside.values[at] = 1;
      continue;
    }
    const Vec3 wo{std::sqrt(1 - c * c), 0, c};
    const float lambda_o = ggx_lambda(c, alpha);
    const Facets facets = visible_facets(wo, lambda_o, alpha);
    const float share = 1.0f / float(facets.size());
    float one = 0, grazing = 0;
    for (const Facet& f : facets) {
      one += f.reflect;
      grazing += f.reflect * schlick_weight(f.cos_o);
    }
    ggx.one.values[at] = one * share;
    ggx.grazing.values[at] = grazing * share;
    for (CoatTable& x : coats) {
      float sum = 0;
      for (const Facet& f : facets) sum += f.reflect * fresnel_dielectric(f.cos_o, x.ior);
      x.reflected.values[at] = sum * share;
    }
    for (GlassTables& x : glasses) {
      x.outside.values[at] = glass_albedo(facets, wo, lambda_o, alpha, x.ior);
      x.inside.values[at] = glass_albedo(facets, wo, lambda_o, alpha, 1 / x.ior);
    }
  }
  finish(ggx.one);
  finish(ggx.grazing);
  for (CoatTable& x : coats) finish(x.reflected);
  for (GlassTables& x : glasses) {
    finish(x.outside);
    finish(x.inside);
  }
}

float fresnel_dielectric_average(float eta) {
  return hemisphere_average([eta](float c) { return fresnel_dielectric(c, eta); });
}
float plate_reflectance_average(float eta) {
  return hemisphere_average(
      [eta](float c) { return plate_reflectance(fresnel_dielectric(c, eta)); });
}
float fresnel_conductor_average(float eta, float k) {
  return hemisphere_average([eta, k](float c) { return fresnel_conductor(c, eta, k); });
}

}  // namespace troffer
