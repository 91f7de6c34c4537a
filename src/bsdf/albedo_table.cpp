#include "bsdf/albedo_table.h"

#include "base/gauss_legendre.h"
#include "base/units.h"
#include "bsdf/fresnel.h"
#include "bsdf/ggx.h"

namespace troffer {

namespace {

constexpr size_t facet_azimuths = 24, facet_heights = 32,
                 facet_count = facet_azimuths * facet_heights;

// Microfacets seen from a direction in the plane y = 0, for integrals over visible normals. One
// array per field, because loops over them dominate the time to build the tables.
struct Facets {
  float alpha = 0, view_z = 0, lambda = 0;         // GGX width, and terms of the viewing direction
  std::array<float, facet_count> cos_o, normal_z;  // wo·m, m.z
  std::array<float, facet_count> weight;           // share of the visible area; sum 1
  std::array<float, facet_count> reflect;          // weight G2 / G1 of the mirror direction

  // G2 / G1(o) = (1 + Lambda(o)) / (1 + Lambda(o) + Lambda(i)). Numerator and denominator are
  // multiplied by the cosine of i, so that the result is 0 at and below the horizon.
  float masking(float cos_i) const {
    const float z = std::max(cos_i, 0.0f), a2 = alpha * alpha;
    return (1 + lambda) * z / ((0.5f + lambda) * z + 0.5f * std::sqrt(a2 + (1 - a2) * z * z));
  }
  // Returns Σ f(i), summed in eight lanes so that the compiler can vectorise.
  template <class F>
  float sum(const F& f) const {
    std::array<float, 8> lanes{};
    for (size_t i = 0; i < facet_count; i += 8)
      for (size_t l = 0; l < 8; ++l) lanes[l] += f(i + l);
    float total = 0;
    for (const float x : lanes) total += x;
    return total;
  }
};

// Midpoint rule over the unit square of ggx_sample_visible_normal with bound 1, whose steps it
// repeats. By symmetry half of the azimuths suffice. u.y = 1 - (1 - v)² concentrates nodes at the
// tail of the distribution, where reflections reach the horizon.
void set_visible_facets(Facets& f, float cosine, float alpha) {
  f.alpha = alpha;
  f.view_z = cosine;
  f.lambda = ggx_lambda(cosine, alpha);
  const float view_x = std::sqrt(1 - cosine * cosine);
  const Vec3 w = normalize(Vec3{alpha * view_x, 0, cosine});
  std::array<float, facet_azimuths> cos_phi, sin_phi;
  for (size_t i = 0; i < facet_azimuths; ++i) {
    const float phi = pi_f * (float(i) + 0.5f) / float(facet_azimuths);
    cos_phi[i] = std::cos(phi);
    sin_phi[i] = std::sin(phi);
  }
  for (size_t j = 0; j < facet_heights; ++j) {
    const float rest = 1 - (float(j) + 0.5f) / float(facet_heights);
    const float weight = 2 * rest / float(facet_count);
    const float z = rest * rest * (1 + w.z) - w.z, r = std::sqrt(std::max(0.0f, 1 - z * z));
    for (size_t i = 0; i < facet_azimuths; ++i) {
      const size_t at = j * facet_azimuths + i;
      const float x = alpha * (r * cos_phi[i] + w.x), y = alpha * r * sin_phi[i], n = z + w.z;
      const float scale = 1 / std::sqrt(x * x + y * y + n * n);
      const float c = (view_x * x + cosine * n) * scale;
      f.normal_z[at] = n * scale;
      f.cos_o[at] = std::min(std::max(c, 0.0f), 1.0f);
      f.weight[at] = weight;
      f.reflect[at] = weight * f.masking(2 * c * n * scale - cosine);
    }
  }
}

// Returns the albedo of glass with relative index eta: reflection plus refraction.
float glass_albedo(const Facets& f, float eta) {
  return f.sum([&f, eta](size_t i) {
    const float c = f.cos_o[i], r = fresnel_dielectric(c, eta);
    const float cos_t = std::sqrt(std::max(0.0f, 1 - (1 - c * c) / (eta * eta)));
    const float z = (cos_t - c / eta) * f.normal_z[i] + f.view_z / eta;  // below the surface
    return r * f.reflect[i] + (1 - r) * f.weight[i] * f.masking(z);
  });
}

float schlick_weight(float c) {
  return pow5(1 - c);
}

void finish(AlbedoTable& table) {
  for (size_t a = 0; a < table_alphas; ++a)
    table.averages[a] = row_average(table.values.data() + a * table_cosines);
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

// Integrates the piecewise linear interpolant in the fourth root t of c: 2 ∫ E c dc = 8 ∫ E t⁷ dt.
// On such short intervals the error of three-point Gauss quadrature is below rounding.
float row_average(const float* row) {
  constexpr double h = 1.0 / double(table_cosines - 1);
  double sum = 0;
  for (size_t k = 0; k + 1 < table_cosines; ++k)
    for (size_t q = 0; q < 3; ++q) {
      const double node = gauss_nodes<double>[q], t = (double(k) + node) * h;
      sum += 8 * h * gauss_weights<double>[q] * std::pow(t, 7) *
             lerp(double(row[k]), double(row[k + 1]), node);
    }
  return float(std::min(sum, 1.0));
}

void build_albedo_tables(GgxTables& ggx, std::vector<CoatTable>& coats,
                         std::vector<GlassTables>& glasses) {
  const auto fourth_power = [](float x) { return sqr(sqr(x)); };
  Facets f;
  for (size_t at = 0; at < table_cosines * table_alphas; ++at) {
    const float s = float(at / table_cosines) / float(table_alphas - 1);
    const float t = float(at % table_cosines) / float(table_cosines - 1);
    const float alpha = fourth_power(lerp(AlphaCoordinate::first, 1.0f, s));
    set_visible_facets(f, std::max(fourth_power(t), 1e-6f), alpha);
    ggx.one.values[at] = f.sum([&f](size_t i) { return f.reflect[i]; });
    ggx.grazing.values[at] =
        f.sum([&f](size_t i) { return f.reflect[i] * schlick_weight(f.cos_o[i]); });
    for (CoatTable& x : coats)
      x.reflected.values[at] = f.sum([&f, ior = x.ior](size_t i) {
        return f.reflect[i] * fresnel_dielectric(f.cos_o[i], ior);
      });
    for (GlassTables& x : glasses) {
      x.outside.values[at] = glass_albedo(f, x.ior);
      x.inside.values[at] = glass_albedo(f, 1 / x.ior);
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

std::array<Rgb, table_cosines> glass_albedos(float alpha, float eta, bool is_inside,
                                             const ReflectanceCurve& curve) {
  std::array<Rgb, table_cosines> out;
  Facets f;
  for (size_t k = 0; k < table_cosines; ++k) {
    const float t = float(k) / float(table_cosines - 1);
    set_visible_facets(f, std::max(sqr(sqr(t)), 1e-6f), alpha);
    Rgb sum{0};
    for (size_t i = 0; i < facet_count; ++i) {
      const float c = f.cos_o[i], cos_t = refracted_cosine(c, eta);
      if (cos_t < 0) {
        sum += Rgb{f.reflect[i]};
        continue;
      }
      const float x = std::sqrt(is_inside ? cos_t : c) * float(curve.size() - 1);
      const size_t at = std::min(size_t(x), curve.size() - 2);
      const Rgb r = curve[at] + (curve[at + 1] - curve[at]) * (x - float(at));
      const float z = (cos_t - c / eta) * f.normal_z[i] + f.view_z / eta;  // below the surface
      sum += r * f.reflect[i] + (Rgb{1} - r) * (f.weight[i] * f.masking(z));
    }
    out[k] = sum;
  }
  return out;
}

float fresnel_dielectric_average(float eta) {
  return hemisphere_average([eta](float c) { return fresnel_dielectric(c, eta); });
}
float plate_reflectance_average(float eta) {
  return hemisphere_average([eta](float c) { return plate_reflectance(c, eta); });
}
float fresnel_conductor_average(float eta, float k) {
  return hemisphere_average([eta, k](float c) { return fresnel_conductor(c, eta, k); });
}

}  // namespace troffer
