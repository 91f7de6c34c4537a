// Directional albedos of rough surfaces, tabulated over the cosine and the GGX width alpha.
// Grids are uniform in the fourth roots of cosine and alpha, which resolves the corner where both
// are small, and begin at cosine 0 and alpha = smooth_alpha. The stored averages are those of the
// interpolant itself, so that energy identities built from a table hold exactly for the table.
// References: [1] Kulla & Conty, "Revisiting Physically Based Shading at Imageworks", SIGGRAPH
//   2017 course. [2] Karis, "Real Shading in Unreal Engine 4", SIGGRAPH 2013 course (the split of
//   Schlick's term).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/rgb.h"
#include "base/vec.h"

namespace troffer {

// GGX widths below this are mirrors: delta lobes (pbrt-v4's threshold).
constexpr float smooth_alpha = 1e-3f;

constexpr size_t table_cosines = 80, table_alphas = 56;

// Where a value falls on an axis of a table: between `index` and index + 1.
struct TableCoordinate {
  size_t index = 0;
  float fraction = 0;
  TableCoordinate(float x, size_t count) {
    const float at = std::min(std::max(x, 0.0f), 1.0f) * float(count - 1);
    index = std::min(size_t(at), count - 2);
    fraction = at - float(index);
  }
};
struct CosineCoordinate : TableCoordinate {
  explicit CosineCoordinate(float cosine)
      : TableCoordinate(std::sqrt(std::sqrt(std::max(cosine, 0.0f))), table_cosines) {}
};
struct AlphaCoordinate : TableCoordinate {
  static constexpr float first = 0.177827941f;  // fourth root of smooth_alpha
  explicit AlphaCoordinate(float alpha)
      : TableCoordinate((std::sqrt(std::sqrt(std::max(alpha, 0.0f))) - first) / (1 - first),
                        table_alphas) {}
};

// A table at one alpha: what a Bsdf keeps. Points into the table.
struct AlbedoRow {
  const float* values = nullptr;  // row of the smaller alpha; that of the larger follows it
  float fraction = 0;
  float average = 0;  // cosine-weighted mean over the hemisphere: 2 ∫ E(c) c dc

  float at(const CosineCoordinate& c) const {
    const float* a = values + c.index;
    const float* b = a + table_cosines;
    const float at_a = lerp(a[0], a[1], c.fraction), at_b = lerp(b[0], b[1], c.fraction);
    return lerp(at_a, at_b, fraction);
  }
};

struct AlbedoTable {
  std::array<float, table_cosines * table_alphas> values{};
  std::array<float, table_alphas> averages{};

  AlbedoRow row(float alpha) const {
    const AlphaCoordinate a(alpha);
    return {values.data() + a.index * table_cosines, a.fraction,
            lerp(averages[a.index], averages[a.index + 1], a.fraction)};
  }
};

// Cosine-weighted mean of a row of table_cosines values, as AlbedoRow reads between them.
float row_average(const float* row);

// GGX reflection with Fresnel factor 1, and with Schlick's (1 - cos)^5 in its place: a lobe with
// Schlick's f0, f90 has the albedo f0 (one - grazing) + f90 grazing [2].
struct GgxTables {
  AlbedoTable one, grazing;
};
// Reflection and refraction together by a rough interface, for light that comes from outside and
// from inside.
struct GlassTables {
  float ior = 1;
  AlbedoTable outside, inside;
};
// Reflection alone by a rough dielectric interface seen from outside.
struct CoatTable {
  float ior = 1;
  AlbedoTable reflected;
};

// All tables at once, since they share the microfacets. `coats` and `glasses` come with their
// `ior` set. All single scattering: what a table lacks to 1 is lost behind other microfacets.
void build_albedo_tables(GgxTables& ggx, std::vector<CoatTable>& coats,
                         std::vector<GlassTables>& glasses);

// A reflectance at even steps of the square root of the cosine, from 0 to 1.
using ReflectanceCurve = std::array<Rgb, 512>;

// Per cosine of the tables what glass of relative index eta reflects and refracts together at one
// alpha where its facets reflect by a curve in place of Fresnel's formula: by the cosine outside,
// be the light there or (is_inside) within, beside total reflection.
std::array<Rgb, table_cosines> glass_albedos(float alpha, float eta, bool is_inside,
                                             const ReflectanceCurve& curve);

// Cosine-weighted mean of fresnel_dielectric over the hemisphere, and of plate_reflectance.
float fresnel_dielectric_average(float eta);
float plate_reflectance_average(float eta);
// The same of fresnel_conductor.
float fresnel_conductor_average(float eta, float k);

}  // namespace troffer
