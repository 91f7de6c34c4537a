// Scene-wide tables for Bsdfs: directional albedos for each index of refraction in the scene, and
// averages of Fresnel terms. Built once per scene; make_bsdf() reads them at each hit. Thread-safe
// once built.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/rgb.h"
#include "bsdf/albedo_table.h"
#include "bsdf/angular_lobe.h"
#include "bsdf/clear_coat.h"
#include "bsdf/film_glass_table.h"
#include "bsdf/grain_table.h"
#include "bsdf/rough_coat_table.h"
#include "bsdf/thin_film.h"
#include "scene/scene.h"

namespace troffer {

// Relative indices this close to 1 do not bend light.
constexpr float index_matched = 1e-3f;

// Properties of a material that do not depend on the hit. Table indices are -1 where there is none.
struct PreparedMaterial {
  float ior = 1.5f;               // clamped to [1/100, 100]; finite
  int32_t coat = -1, glass = -1;  // tables for this ior, if the material can need them
  int32_t grain = -1;             // table for its widths and clear coat, if both are constant
  int32_t film_glass = -1;        // table of rough solid glass under a film, if both are constant
  int32_t rough_coat = -1;        // table of a coat of constant width whose facets scatter once
  int32_t clear_inside = -1;      // table of the clear coat seen from below
  int32_t clear_coat = -1;        // table of the clear coat's index, if it can be rough
  int32_t angular = -1;           // lobe of its matrices
  float clear_coat_ior = 1.5f;    // clamped like ior
  float dielectric_average = 0;   // cosine-weighted mean Fresnel reflectance from outside
  float plate_average = 0;        // the same for a thin plate
  bool is_pane = false;
  Rgb conductor_average;  // the same for the conductor eta, k (not with is_reflectance)
};

// Tables that make_bsdf may need for a material at any hit.
struct TableNeeds {
  bool has_ggx = false;                      // tables by GGX width alone
  bool has_coat = false, has_glass = false;  // tables by index of refraction
  bool has_dielectric_average = false, has_conductor_average = false;
  bool has_sheen = false;
  bool has_film = false;
  float single_coat_alpha = 0;  // width of a single-scattering rough coat; 0: none, or not constant
  float filmed_alpha = 0;       // width of rough solid glass under a film; 0: none, or not constant
  bool has_clear_coat = false;  // tables for the index of its clear coat
  bool has_clear_inside = false;  // the same from below
  GgxWidths grain{0, 0};          // zeros: none, or not constant
  ClearCoat coat_over_grain;      // the coat above the grain, without its row
};
TableNeeds table_needs(const Material& material, float clear_coat_ior);  // table_needs.cpp

// True for clear thin glass: all light that it does not reflect goes straight on, so that shadow
// rays may pass it. False if its roughness varies or it has holes.
bool is_pane(const Material& material);  // table_needs.cpp

// Immutable once built. Bsdfs point into it, so it must outlive them and stay in place.
class BsdfTables {
 public:
  // Builds all tables that the materials need. That takes some ten milliseconds, and as much again
  // for each distinct index of refraction (of rough dielectrics and coats), pair of grain widths,
  // and film over rough glass; sheen takes a tenth of a second. Beyond `max_indices` distinct
  // indices, similar ones share a table (IndexClasses). Beyond `max_parameters` pairs of widths or
  // films, a material takes the nearest table.
  explicit BsdfTables(const std::vector<Material>& materials);
  explicit BsdfTables(const Scene& scene) : BsdfTables(scene.materials) {}

  const PreparedMaterial& material(uint32_t i) const { return materials_[i]; }
  const GgxTables& ggx() const { return ggx_; }
  const CoatTable& coat(int32_t i) const { return coats_[size_t(i)]; }
  const GlassTables& glass(int32_t i) const { return glasses_[size_t(i)]; }
  const GrainTable& grain(int32_t i) const { return grains_[size_t(i)]; }
  const RoughCoatTable& rough_coat(int32_t i) const { return rough_coats_[size_t(i)]; }
  const FilmGlassTable& film_glass(int32_t i) const { return film_glasses_[size_t(i)]; }
  // Sets the rows of a clear coat from the material's tables.
  void set_rows(ClearCoat& clear, const PreparedMaterial& material) const;
  const AngularLobe& angular(int32_t i) const { return angulars_[size_t(i)]; }
  const AlbedoTable& sheen() const { return sheen_; }
  const InterferenceTable& interference() const { return interference_; }
  // Returns the mean Fresnel reflectance of a conductor with eta = 1 and normal reflectance r.
  Rgb reflectance_average(Rgb r) const;

 private:
  // Limits by time: 32 indices, or 64 of coats, take .3 to .6 s, 256 pairs of widths or films 3 s.
  static constexpr size_t max_indices = 32, max_parameters = 256, reflectances = 65;

  std::vector<PreparedMaterial> materials_;
  GgxTables ggx_;
  std::vector<CoatTable> coats_;
  std::vector<GlassTables> glasses_;
  std::vector<GrainTable> grains_;
  std::vector<RoughCoatTable> rough_coats_;
  std::vector<FilmGlassTable> film_glasses_;
  std::vector<AngularLobe> angulars_;
  AlbedoTable sheen_;
  InterferenceTable interference_;
  std::array<float, reflectances> reflectance_average_{};

  int32_t rough_coat_for(const Material& m, float alpha, float ior);
  void build_angular_lobes(const std::vector<Material>& materials);
  void build_grain_tables(const std::vector<Material>& materials);
  void build_film_glass_tables(const std::vector<Material>& materials);
};

}  // namespace troffer
