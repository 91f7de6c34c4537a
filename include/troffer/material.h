/// @file
/// Materials and textures for scenes that a program builds.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "troffer/types.h"

namespace troffer::api {

/// A texture of a scene, as Scene::add_texture() returns it.
struct TextureId {
  int index = -1;  ///< number in the scene; -1: no texture
};

/// An image that materials and emission look up by the texture coordinates of a mesh. (0, 0) is the
/// top left corner and v points down. Exactly one of `bytes` and `floats` is filled.
struct TextureImage {
  int width = 0;                      ///< columns
  int height = 0;                     ///< rows
  int channels = 3;                   ///< 1 grey, 2 grey and alpha, 3 rgb, 4 rgb and alpha
  std::vector<std::uint8_t> bytes{};  ///< height × width × channels values of 8 bits
  std::vector<float> floats{};        ///< height × width × channels linear values
  bool is_srgb = true;                ///< `bytes` have the sRGB curve (not in alpha); for colours
  bool is_repeated = true;            ///< repeats outside of (0, 1); else the border is extended
  bool is_filtered = true;            ///< bilinear; else the nearest texel
};

/// Reflection models.
enum class MaterialModel {
  matte,       ///< Lambertian reflection of base_color
  plastic,     ///< a dielectric coat of `ior` and `roughness` over Lambertian base_color
  metal,       ///< a rough mirror that reflects base_color at normal incidence
  mirror,      ///< a smooth mirror that reflects base_color
  principled,  ///< glTF's model: metallic, roughness, transmission, coat, sheen
  glass,       ///< a solid dielectric of `ior` and `roughness` with `absorption` inside
  thin_glass,  ///< a pane without thickness: light goes straight through
};

/// Appearance of the back of a surface.
enum class BackFace {
  shown,   ///< the same as its front
  black,   ///< it reflects nothing
  unseen,  ///< viewing rays pass; to light it is the same as its front (glTF's single-sided)
};

/// A material. A texture multiplies the number or colour that it belongs to. Colours and shares lie
/// between 0 and 1. The members are plain data; each model uses those that its description names.
struct Material {
  MaterialModel model = MaterialModel::matte;  ///< how it scatters light
  Color base_color{0.5F, 0.5F, 0.5F};          ///< reflectance
  TextureId base_color_texture{};              ///< multiplies base_color
  double roughness = 0.5;                      ///< 0 to 1; the width of GGX is its square
  TextureId roughness_texture{};               ///< its green channel multiplies roughness
  double metallic = 0;                         ///< share of metal, 0 to 1
  TextureId metallic_texture{};                ///< its blue channel multiplies metallic
  double ior = 1.5;                            ///< refractive index, 1 to 100
  double specular = 1;                         ///< strength of dielectric gloss, 0 to 1
  Color specular_color{1, 1, 1};               ///< colour of dielectric gloss
  double transmission = 0;                     ///< share of diffuse light that passes clearly
  double diffuse_transmission = 0;             ///< share that passes and leaves evenly (paper)
  bool is_thin = true;             ///< principled: `transmission` passes without refraction
  Color absorption{0, 0, 0};       ///< inside glass: exp(-absorption × metres) is left, per metre
  double coat = 0;                 ///< share that wears a clear coat, 0 to 1
  double coat_roughness = 0;       ///< 0 to 1
  double coat_ior = 1.5;           ///< 1 to 100
  Color sheen_color{0, 0, 0};      ///< reflectance of cloth's fibres
  double sheen_roughness = 0;      ///< 0 to 1
  double anisotropy = 0;           ///< 0 to 1: gloss is wider along the grain
  double anisotropy_rotation = 0;  ///< degrees from growing u, counterclockwise
  TextureId normal_texture{};      ///< normal map in tangent space; a linear image
  double normal_scale = 1;         ///< factor on the slope of the normal map
  std::optional<double> alpha_cut{};     ///< 0 to 1: holes where base_color_texture's alpha is less
  BackFace back_face = BackFace::shown;  ///< what the back is to viewers

  /// Lambertian reflection.
  static Material matte(const Color& reflectance);
  /// A glossy coat over Lambertian reflection.
  static Material plastic(const Color& reflectance, double roughness = 0.3, double ior = 1.5);
  /// Metal of a normal reflectance.
  static Material metal(const Color& reflectance, double roughness = 0.3);
  /// A smooth mirror.
  static Material mirror(const Color& reflectance = {0.95F, 0.95F, 0.95F});
  /// glTF's metallic-roughness model.
  static Material principled(const Color& base_color, double roughness = 0.5, double metallic = 0);
  /// Solid glass: a closed mesh whose front is outside.
  static Material glass(double ior = 1.5, double roughness = 0);
  /// A pane of glass: one sheet of triangles.
  static Material thin_glass(double ior = 1.5);
};

/// A number of a material that can be changed after loading. All lie between 0 and 1, but for ior,
/// which lies between 1 and 100.
enum class MaterialNumber {
  roughness,             ///< Material::roughness
  metallic,              ///< Material::metallic
  ior,                   ///< Material::ior
  specular,              ///< Material::specular
  transmission,          ///< Material::transmission
  diffuse_transmission,  ///< Material::diffuse_transmission
  coat,                  ///< Material::coat
  coat_roughness,        ///< Material::coat_roughness
};

}  // namespace troffer::api
