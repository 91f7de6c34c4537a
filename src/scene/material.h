// Materials as data. Importers fill them in; bsdf/ turns them into reflection functions at a hit.
// Roughness, coverage and colours are dimensionless; absorption is per metre.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/rgb.h"
#include "base/vec.h"
#include "scene/angular_bsdf.h"
#include "scene/texture.h"

namespace troffer {

constexpr int32_t no_texture = -1;

// value × texture
struct ColorInput {
  Rgb value{1};
  int32_t texture = no_texture;
};
// value × one channel of a texture (0 r, 1 g, 2 b, 3 alpha)
struct FloatInput {
  float value = 1;
  int32_t texture = no_texture;
  int32_t channel = 0;
};

enum class MaterialKind : uint8_t {
  diffuse,         // Lambertian reflection base_color
  coated_diffuse,  // dielectric coat of index ior and `roughness` over Lambertian base_color
  conductor,       // complex index eta + i k per channel; or base_color if is_reflectance
  dielectric,      // glass of index ior: solid, or a thin sheet if is_thin
  // glTF: mix by `metallic` of base_color metal and coated diffuse; `transmission` of the diffuse
  // part passes as through glass
  metallic_roughness,
  // matrices over patches of directions (Material::angular), such as LBNL WINDOW's
  angular,
};

// Relation between `roughness` and the GGX width alpha.
enum class RoughnessMeaning : uint8_t {
  alpha,            // alpha = roughness
  alpha_is_sqrt,    // alpha = sqrt(roughness): pbrt's remaproughness
  alpha_is_square,  // alpha = roughness²: glTF
};

// Microfacet model of rough gloss.
enum class FacetModel : uint8_t {
  // GGX with height-correlated shadowing and masking; light lost between microfacets returns
  // (bsdf/lost_light.cpp)
  balanced,
  single_ggx,       // GGX with shadowing times masking; lost light stays lost (Mitsuba)
  single_beckmann,  // the same with Beckmann's distribution
};

// Look of a surface from behind.
enum class BackFaces : uint8_t {
  shown,   // same as the front
  black,   // reflects nothing there (Mitsuba's one-sided materials)
  unseen,  // viewing rays pass (glTF); for light it is the same as the front
};

struct Material {
  std::string name;
  MaterialKind kind = MaterialKind::diffuse;
  ColorInput base_color{Rgb{0.5f}, no_texture};
  FloatInput roughness{0, no_texture, 0};
  RoughnessMeaning roughness_meaning = RoughnessMeaning::alpha;
  FacetModel facets = FacetModel::balanced;  // coated_diffuse, conductor, dielectric
  FloatInput metallic{0, no_texture, 2};
  // conductor, metallic_roughness: GGX has the width alpha + (1 - alpha) × anisotropy² along
  // TexturePlace::grain and alpha across it. The rotation turns the grain counterclockwise from
  // growing u. The texture's red and green turn it further, as a direction.
  FloatInput anisotropy{0, no_texture, 2};
  float anisotropy_rotation_rad = 0;
  // metallic_roughness: sheen of cloth fibres over the rest (bsdf/sheen.h), metal and glass
  // included. Black: none.
  ColorInput sheen_color{Rgb{0}, no_texture};
  FloatInput sheen_roughness{0, no_texture, 3};
  // Clear coat over the rest, with an index of its own (bsdf/clear_coat.h). metallic_roughness and
  // dielectric: share of the surface under the coat, whose base is unchanged
  // (KHR_materials_clearcoat). conductor: a layer over all of it that refracts. coated_diffuse: a
  // second coat. Solid glass has the coat outside, a thin sheet on both sides.
  FloatInput coat{0, no_texture, 0};
  FloatInput coat_roughness{0, no_texture, 1};
  float coat_ior = 1.5f;
  // True if the coat has its own normal map, or stays flat without one. Otherwise it follows the
  // base.
  bool has_coat_normal = false;
  int32_t coat_normal_texture = no_texture;
  float coat_normal_scale = 1;
  // metallic_roughness: thin film over the gloss (bsdf/thin_film.h): its share of the surface, its
  // index, and its thickness, interpolated from `film_thinnest_nm` to `film_thickest_nm`.
  FloatInput iridescence{0, no_texture, 0};
  float film_ior = 1.3f;
  FloatInput film_thickness{1, no_texture, 1};
  float film_thinnest_nm = 100, film_thickest_nm = 400;
  float ior = 1.5f;                       // real index of refraction, inside / outside
  FloatInput specular{1, no_texture, 3};  // KHR_materials_specular: specularFactor
  // KHR_materials_specular: specularColorFactor. coated_diffuse, dielectric, conductor with eta and
  // k: factor on the specular reflection only.
  ColorInput specular_color{Rgb{1}, no_texture};
  FloatInput transmission{0, no_texture, 0};  // KHR_materials_transmission
  // Diffuse transmission, as of paper, curtains and opal glass. diffuse: `diffuse_transmission` ×
  // its colour is transmitted in addition to base_color. metallic_roughness: that share of the
  // diffuse light passes, in this colour instead of base_color
  // (KHR_materials_diffuse_transmission).
  FloatInput diffuse_transmission{0, no_texture, 3};
  ColorInput diffuse_transmission_color{Rgb{1}, no_texture};
  bool is_thin = false;  // dielectric, transmission: no refraction
  // Solid glass: transmits exp(-absorption × metres). Sheet: exponent at normal incidence.
  Rgb absorption{0};
  BackFaces back_faces = BackFaces::shown;
  bool is_reflectance = false;          // conductor: normal reflectance is base_color
  Rgb eta{0.2f}, k{3.9f};               // conductor
  int32_t normal_texture = no_texture;  // tangent space, linear; -1: none
  float normal_scale = 1;
  FloatInput bump{0, no_texture, 0};  // height, m; none without a texture
  bool is_alpha_masked = false;       // hits with alpha < cutoff are ignored
  bool is_alpha_blended = false;      // only with is_alpha_masked: alpha is the coverage
  FloatInput alpha{1, no_texture, 3};
  float alpha_cutoff = 0.5f;
  // angular: the matrices, shared by materials; never null. Their y axis is `angular_up`, projected
  // onto the surface.
  std::shared_ptr<const AngularBsdf> angular;
  Vec3 angular_up{0, 0, 1};
  // angular: light of a patch that passes straight on, above the level of the patches around it,
  // stays a sharp beam.
  bool has_sharp_peak = false;
  // Light that it would mirror passes straight through instead (scene/mirror_image.h).
  bool is_mirror_pane = false;
};

// Calls visit(input) for every input of the scattering model that may be textured.
template <class Visit>
void for_each_input(const Material& m, const Visit& visit) {
  for (const ColorInput* c :
       {&m.base_color, &m.specular_color, &m.sheen_color, &m.diffuse_transmission_color})
    visit(*c);
  for (const FloatInput* f : {&m.roughness, &m.metallic, &m.specular, &m.transmission,
                              &m.diffuse_transmission, &m.anisotropy, &m.sheen_roughness, &m.coat,
                              &m.coat_roughness, &m.iridescence, &m.film_thickness})
    visit(*f);
}

// Calls visit(v) for the inputs, numbers and colours that define scattering and coverage. Leaves
// out names and bumps.
template <class Visit>
void for_each_value(const Material& m, const Visit& visit) {
  visit(uint64_t(m.kind));
  visit(uint64_t(m.roughness_meaning) | uint64_t(m.facets) << 8);
  for_each_input(m, visit);
  visit(m.alpha);
  visit(m.anisotropy_rotation_rad);
  visit(m.ior);
  visit(m.coat_ior);
  visit(m.film_ior);
  visit(m.film_thinnest_nm);
  visit(m.film_thickest_nm);
  visit(uint64_t(m.is_thin) | uint64_t(m.is_reflectance) << 1 | uint64_t(m.is_alpha_masked) << 2 |
        uint64_t(m.is_alpha_blended) << 3);
  visit(m.eta);
  visit(m.k);
  visit(m.absorption);
  visit(uint64_t(m.back_faces));
  visit(m.alpha_cutoff);
  if (m.angular == nullptr) return;
  visit(hash_of(*m.angular));
  visit(uint64_t(m.has_sharp_peak));
  for (size_t i = 0; i < 3; ++i) visit(m.angular_up[i]);
}

// True if the coat has another normal than the base.
inline bool has_own_coat_normal(const Material& m) {
  return m.coat.value > 0 && m.has_coat_normal &&
         (m.coat_normal_texture >= 0 || m.normal_texture >= 0 || m.bump.texture >= 0);
}

// True if any input of the scattering model is textured.
inline bool has_textured_input(const Material& m) {
  bool is_any = false;
  for_each_input(m, [&](const auto& input) { is_any = is_any || input.texture >= 0; });
  return is_any;
}

inline Rgb evaluate(const std::vector<Texture>& textures, const ColorInput& in,
                    const TexturePlace& uv) {
  return in.texture < 0 ? in.value : in.value * evaluate(textures, uint32_t(in.texture), uv).rgb;
}
inline float evaluate(const std::vector<Texture>& textures, const FloatInput& in,
                      const TexturePlace& uv) {
  if (in.texture < 0) return in.value;
  const TextureValue v = evaluate(textures, uint32_t(in.texture), uv);
  return in.value * (in.channel == 3 ? v.alpha : v.rgb[size_t(in.channel)]);
}

// Coverage at uv: 0 or 1 by a mask, between if alpha blends. Call it for materials that are
// is_alpha_masked.
inline float coverage(const std::vector<Texture>& textures, const Material& m,
                      const TexturePlace& uv) {
  const float alpha = evaluate(textures, m.alpha, uv);
  if (!m.is_alpha_blended) return alpha < m.alpha_cutoff ? 0.0f : 1.0f;
  return alpha > 0 ? (alpha < 1 ? alpha : 1.0f) : 0.0f;
}

// True if the surface is absent at uv.
inline bool is_cut_out(const std::vector<Texture>& textures, const Material& m,
                       const TexturePlace& uv) {
  return coverage(textures, m, uv) <= 0;
}

}  // namespace troffer
