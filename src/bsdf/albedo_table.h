// Tables of the directional albedo of rough surfaces over the cosine and the GGX width alpha.
// BsdfTables owns them, and a Bsdf reads one row at its own alpha. Grids are uniform in the fourth
// roots of cosine and alpha, which resolves the corner where both are small. They begin at cosine 0
// and alpha = smooth_alpha. The stored averages are those of the interpolant, so that energy
// identities built from a table hold exactly for that table.
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

// Position of a value on a table axis: between `index` and `index` + 1.
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

// A table at one alpha, as a Bsdf keeps it. Points into the table.
struct AlbedoRow {
  const float* values = nullptr;  // row of the smaller alpha; the row of the larger alpha follows
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

// Returns the cosine-weighted mean of a row of table_cosines values, interpolated as AlbedoRow
// does.
float row_average(const float* row);

// GGX reflection with Fresnel factor 1 (`one`) and with factor (1 - cos)^5 (`grazing`). A lobe with
// Schlick's f0 and f90 has the albedo f0 (one - grazing) + f90 grazing [2].
struct GgxTables {
  AlbedoTable one, grazing;
};
// Reflection plus refraction by a rough interface, for light from outside and from inside.
struct GlassTables {
  float ior = 1;
  AlbedoTable outside, inside;
};
// Reflection alone by a rough dielectric interface seen from outside.
struct CoatTable {
  float ior = 1;
  AlbedoTable reflected;
};

// Builds all tables at once, because they share the microfacets. The `ior` of `coats` and `glasses`
// must be set. Tables hold single scattering only: 1 - value is lost between microfacets.
void build_albedo_tables(GgxTables& ggx, std::vector<CoatTable>& coats,
                         std::vector<GlassTables>& glasses);

// Reflectance at equal steps of the square root of the cosine, from 0 to 1.
using ReflectanceCurve = std::array<Rgb, 512>;

// Returns, for each cosine of the tables, the albedo (reflection plus refraction) of glass with
// relative index eta and width alpha. Facets reflect by `curve` instead of Fresnel's formula. The
// curve is read at the cosine outside the glass; is_inside says that the light comes from within.
// Total internal reflection is added.
std::array<Rgb, table_cosines> glass_albedos(float alpha, float eta, bool is_inside,
                                             const ReflectanceCurve& curve);

// Cosine-weighted means over the hemisphere of fresnel_dielectric, plate_reflectance and
// fresnel_conductor.
float fresnel_dielectric_average(float eta);
float plate_reflectance_average(float eta);
float fresnel_conductor_average(float eta, float k);

}  // namespace troffer
