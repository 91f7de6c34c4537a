// What reflection functions need beyond a material's own numbers: tables of directional albedo for
// every index of refraction in the scene, and averages of Fresnel terms. Built once per scene.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/rgb.h"
#include "bsdf/albedo_table.h"
#include "bsdf/clear_coat.h"
#include "bsdf/film_glass_table.h"
#include "bsdf/grain_table.h"
#include "bsdf/rough_coat_table.h"
#include "bsdf/thin_film.h"
#include "scene/scene.h"

namespace troffer {

// Relative indices this close to 1 do not bend light.
constexpr float index_matched = 1e-3f;

// What is known of a material before any hit.
struct PreparedMaterial {
  float ior = 1.5f;               // made safe: in [1/100, 100] and finite
  int32_t coat = -1, glass = -1;  // tables for this ior, where the material can need them
  int32_t grain = -1;  // for its two widths and its clear coat, where they are the same everywhere
  int32_t film_glass = -1;    // rough solid glass under a film, where both are the same everywhere
  int32_t rough_coat = -1;    // a coat of one width whose facets scatter once
  int32_t clear_inside = -1;  // … seen from below
  int32_t clear_coat = -1;    // for the index of its clear coat, where that can be rough
  float clear_coat_ior = 1.5f;   // made safe
  float dielectric_average = 0;  // cosine-weighted mean Fresnel reflectance from outside
  float plate_average = 0;       // … of a thin plate
  bool is_pane = false;
  Rgb conductor_average;  // … of the conductor eta, k (not of is_reflectance)
};

// What make_bsdf asks of the tables for a material, at any hit.
struct TableNeeds {
  bool has_ggx = false;                      // tables by GGX width alone
  bool has_coat = false, has_glass = false;  // tables for its index of refraction
  bool has_dielectric_average = false, has_conductor_average = false;
  bool has_sheen = false;
  bool has_film = false;
  float single_coat_alpha = 0;    // of a rough coat whose facets scatter once; 0: none, or not even
  float filmed_alpha = 0;         // of rough solid glass under a film; 0: none, or not even
  bool has_clear_coat = false;    // tables for the index of its clear coat
  bool has_clear_inside = false;  // … seen from below
  GgxWidths grain{0, 0};          // zeros: none, or not the same everywhere
  ClearCoat over_grain;           // that lies over it; without its row
};
TableNeeds table_needs(const Material& material, float clear_coat_ior);  // table_needs.cpp

// Clear thin glass: light that it does not reflect goes through straight on, so that shadow rays
// may pass it. Not where its roughness varies or it has holes.
bool is_pane(const Material& material);  // table_needs.cpp

// Immutable once built; Bsdf values point into it, so it must outlive them and stay in place.
class BsdfTables {
 public:
  // Some ten milliseconds, plus about as much per distinct index of refraction among rough
  // dielectrics and coats, per pair of widths among grained gloss and per film over rough glass,
  // and a tenth of a second for sheen. Past `max_iors` distinct indices of a kind the nearest one
  // that has a table serves; past as many pairs of widths, and films, there are none.
  explicit BsdfTables(const std::vector<Material>& materials);
  explicit BsdfTables(const Scene& scene) : BsdfTables(scene.materials) {}

  const PreparedMaterial& material(uint32_t i) const { return materials_[i]; }
  const GgxTables& ggx() const { return ggx_; }
  const CoatTable& coat(int32_t i) const { return coats_[size_t(i)]; }
  const GlassTables& glass(int32_t i) const { return glasses_[size_t(i)]; }
  const GrainTable& grain(int32_t i) const { return grains_[size_t(i)]; }
  const RoughCoatTable& rough_coat(int32_t i) const { return rough_coats_[size_t(i)]; }
  const FilmGlassTable& film_glass(int32_t i) const { return film_glasses_[size_t(i)]; }
  // The rows of a clear coat, by the material's tables.
  void set_rows(ClearCoat& clear, const PreparedMaterial& material) const;
  const AlbedoTable& sheen() const { return sheen_; }
  const InterferenceTable& interference() const { return interference_; }
  // Mean Fresnel reflectance of the conductor with eta = 1 and normal reflectance r.
  Rgb reflectance_average(Rgb r) const;

 private:
  static constexpr size_t max_iors = 32, reflectances = 65;

  std::vector<PreparedMaterial> materials_;
  GgxTables ggx_;
  std::vector<CoatTable> coats_;
  std::vector<GlassTables> glasses_;
  std::vector<GrainTable> grains_;
  std::vector<RoughCoatTable> rough_coats_;
  std::vector<FilmGlassTable> film_glasses_;
  AlbedoTable sheen_;
  InterferenceTable interference_;
  std::array<float, reflectances> reflectance_average_{};

  int32_t rough_coat_for(const Material& m, float alpha, float ior);
  void build_grain_tables(const std::vector<Material>& materials);
  void build_film_glass_tables(const std::vector<Material>& materials);
};

}  // namespace troffer
