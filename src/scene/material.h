// Materials as data: what importers fill in and bsdf/ turns into reflection functions at a hit.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/rgb.h"
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
  diffuse,             // Lambertian reflection base_color
  coated_diffuse,      // dielectric coat of index ior and `roughness` over Lambertian base_color
  conductor,           // complex index eta + i k per channel; or base_color where is_reflectance
  dielectric,          // glass of index ior; solid, or a thin sheet where is_thin
  metallic_roughness,  // glTF: mix by `metallic` of a base_color metal and a coated diffuse;
                       // `transmission` of the diffuse part passes as through glass instead
};

// How `roughness` becomes the GGX width alpha.
enum class RoughnessMeaning : uint8_t {
  alpha,            // alpha = roughness
  alpha_is_sqrt,    // alpha = sqrt(roughness): pbrt's remaproughness
  alpha_is_square,  // alpha = roughness²: glTF
};

// Microfacets of rough gloss.
enum class FacetModel : uint8_t {
  balanced,         // GGX, shadowing and masking correlated by height; what is lost between facets
                    // returns (bsdf/lost_light.cpp)
  single_ggx,       // GGX, shadowing times masking; what is lost stays lost: Mitsuba's
  single_beckmann,  // the same with Beckmann's distribution
};

// What a surface is to those who see its back.
enum class BackFaces : uint8_t {
  shown,   // the same as its front
  black,   // it reflects nothing there (Mitsuba's one-sided ones)
  unseen,  // viewing rays go through (glTF's); to light it is the same as its front
};

struct Material {
  std::string name;
  MaterialKind kind = MaterialKind::diffuse;
  ColorInput base_color{Rgb{0.5f}, no_texture};
  FloatInput roughness{0, no_texture, 0};
  RoughnessMeaning roughness_meaning = RoughnessMeaning::alpha;
  FacetModel facets = FacetModel::balanced;  // of coated_diffuse, conductor and dielectric
  FloatInput metallic{0, no_texture, 2};
  // GGX is alpha + (1 - alpha) × this² wide along TexturePlace::grain, alpha across it: of
  // conductors and metallic_roughness. The grain lies so far counterclockwise from growing u,
  // turned further by the texture's red and green as a direction.
  FloatInput anisotropy{0, no_texture, 2};
  float anisotropy_rotation_rad = 0;
  // metallic_roughness: cloth's fibres over it (bsdf/sheen.h), metal and glass too. Black: none.
  ColorInput sheen_color{Rgb{0}, no_texture};
  FloatInput sheen_roughness{0, no_texture, 3};
  // A clear coat over all else (bsdf/clear_coat.h), of an index of its own: of metallic_roughness
  // and of dielectrics the share of the surface that wears it, its base as without it
  // (KHR_materials_clearcoat); of a conductor a layer over all of it in which light bends; of
  // coated_diffuse a second coat. Solid glass wears it outside, thin sheets on both sides.
  FloatInput coat{0, no_texture, 0};
  FloatInput coat_roughness{0, no_texture, 1};
  float coat_ior = 1.5f;
  // The coat leans by a map of its own, or not at all; else with the base.
  bool has_coat_normal = false;
  int32_t coat_normal_texture = no_texture;
  float coat_normal_scale = 1;
  // metallic_roughness: a thin film over its gloss (bsdf/thin_film.h): the share that wears it, its
  // index, and its thickness, so far from `film_thinnest_nm` to `film_thickest_nm`.
  FloatInput iridescence{0, no_texture, 0};
  float film_ior = 1.3f;
  FloatInput film_thickness{1, no_texture, 1};
  float film_thinnest_nm = 100, film_thickest_nm = 400;
  float ior = 1.5f;                       // real index of refraction, inside / outside
  FloatInput specular{1, no_texture, 3};  // KHR_materials_specular: specularFactor
  // … specularColorFactor; of coated_diffuse, dielectrics and conductors of eta and k a factor on
  // what they reflect as gloss, and on that alone
  ColorInput specular_color{Rgb{1}, no_texture};
  FloatInput transmission{0, no_texture, 0};  // KHR_materials_transmission
  // Light that comes through and leaves the other side evenly, as through paper, curtains and opal
  // glass: of diffuse ones the share `diffuse_transmission` × its colour, beside base_color; of
  // metallic_roughness so much of what is diffuse passes, in that colour, in place of base_color
  // (KHR_materials_diffuse_transmission).
  FloatInput diffuse_transmission{0, no_texture, 3};
  ColorInput diffuse_transmission_color{Rgb{1}, no_texture};
  bool is_thin = false;  // dielectric, transmission: no refraction
  // Inside solid glass: the share exp(-absorption × metres) is left. Of a sheet: the exponent
  // straight through it.
  Rgb absorption{0};
  BackFaces back_faces = BackFaces::shown;
  bool is_reflectance = false;          // conductor: normal reflectance is base_color
  Rgb eta{0.2f}, k{3.9f};               // conductor
  int32_t normal_texture = no_texture;  // tangent space, linear
  float normal_scale = 1;
  FloatInput bump{0, no_texture, 0};  // height in metres; none without a texture
  bool is_alpha_masked = false;       // hits with alpha < cutoff are not there …
  bool is_alpha_blended = false;  // … or, where it is masked: alpha is the share of rays that hit
  FloatInput alpha{1, no_texture, 3};
  float alpha_cutoff = 0.5f;
  // What it would mirror goes straight through instead: scene/mirror_image.h.
  bool is_image = false;
};

// Calls visit(input) for every input that says how a material scatters light: what may be textured.
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

// Calls visit(v) for all that says how a material scatters light and where it has holes (bumps and
// names do neither): inputs, numbers, colours.
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
}

// Whether its coat has another normal than its base.
inline bool has_own_coat_normal(const Material& m) {
  return m.coat.value > 0 && m.has_coat_normal &&
         (m.coat_normal_texture >= 0 || m.normal_texture >= 0 || m.bump.texture >= 0);
}

// Whether it scatters light differently from place to place.
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

// The share of rays that meet the surface at uv: 0 where a mask makes a hole, 1 where it does not,
// between where alpha blends. Of a material that is_alpha_masked.
inline float coverage(const std::vector<Texture>& textures, const Material& m,
                      const TexturePlace& uv) {
  const float alpha = evaluate(textures, m.alpha, uv);
  if (!m.is_alpha_blended) return alpha < m.alpha_cutoff ? 0.0f : 1.0f;
  return alpha > 0 ? (alpha < 1 ? alpha : 1.0f) : 0.0f;
}

// Whether no ray meets it there.
inline bool is_cut_out(const std::vector<Texture>& textures, const Material& m,
                       const TexturePlace& uv) {
  return coverage(textures, m, uv) <= 0;
}

}  // namespace troffer
