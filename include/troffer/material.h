/// @file
/// Materials and textures for scenes that are built from arrays.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "troffer/types.h"

namespace troffer::api {

/// A texture of a scene, returned by Scene::add_texture().
struct TextureId {
  int index = -1;  ///< number in the scene; -1: no texture
};

/// An image on a surface, for materials and emission. Meshes give its texture coordinates (u, v):
/// (0, 0) is the top left corner and v points down. Exactly one of `bytes` and `floats` is filled.
struct TextureImage {
  int width = 0;                      ///< columns
  int height = 0;                     ///< rows
  int channels = 3;                   ///< 1 grey, 2 grey and alpha, 3 rgb, 4 rgb and alpha
  std::vector<std::uint8_t> bytes{};  ///< height × width × channels values of 8 bits
  std::vector<float> floats{};        ///< height × width × channels linear values
  bool is_srgb = true;                ///< `bytes` are sRGB values, except alpha; set for colours
  bool is_repeated = true;            ///< repeats outside [0, 1]; if false, extends the border
  bool is_filtered = true;            ///< bilinear filter; if false, the nearest texel
};

/// Reflection models.
enum class MaterialModel {
  matte,       ///< Lambertian reflection of base_color
  plastic,     ///< a dielectric coat of `ior` and `roughness` over Lambertian base_color
  metal,       ///< a conductor that reflects base_color at normal incidence
  mirror,      ///< a smooth mirror that reflects base_color
  principled,  ///< glTF's model: metallic, roughness, transmission, coat, sheen
  glass,       ///< a solid dielectric of `ior` and `roughness` with `absorption` inside
  thin_glass,  ///< a pane: thin clear glass that does not bend light
};

/// Appearance of the back of a surface.
enum class BackFace {
  shown,   ///< the same as the front
  black,   ///< reflects nothing
  unseen,  ///< viewing rays pass through; for light the same as the front (glTF's single-sided)
};

/// A material. A texture is a factor on the number or colour of the same name. Colours and shares
/// lie between 0 and 1. Each model reads only some of the members (docs/reference/cpp.md).
struct Material {
  MaterialModel model = MaterialModel::matte;  ///< how it scatters light
  Color base_color{0.5F, 0.5F, 0.5F};          ///< reflectance
  TextureId base_color_texture{};              ///< factor on base_color
  double roughness = 0.5;                      ///< 0 to 1; the GGX width is its square
  TextureId roughness_texture{};               ///< factor on roughness, in its green channel
  double metallic = 0;                         ///< share of metal, 0 to 1
  TextureId metallic_texture{};                ///< factor on metallic, in its blue channel
  double ior = 1.5;                            ///< refractive index, 1 to 100
  double specular = 1;                         ///< strength of dielectric gloss, 0 to 1
  Color specular_color{1, 1, 1};               ///< colour of dielectric gloss
  double transmission = 0;          ///< share of diffuse light that passes as through glass
  double diffuse_transmission = 0;  ///< share that is transmitted diffusely, as by paper
  bool is_thin = true;              ///< principled: `transmission` passes without refraction
  Color absorption{0, 0, 0};       ///< per metre in solid glass; thin: exponent at normal incidence
  double coat = 0;                 ///< share of the surface under a clear coat, 0 to 1
  double coat_roughness = 0;       ///< of the coat, 0 to 1
  double coat_ior = 1.5;           ///< refractive index of the coat, 1 to 100
  Color sheen_color{0, 0, 0};      ///< reflectance of cloth fibres
  double sheen_roughness = 0;      ///< of the fibres, 0 to 1
  double anisotropy = 0;           ///< 0 to 1; above 0, gloss is wider along the grain
  double anisotropy_rotation = 0;  ///< of the grain, degrees counterclockwise from growing u
  TextureId normal_texture{};      ///< normal map in tangent space; TextureImage::is_srgb is false
  double normal_scale = 1;         ///< factor on the slopes of the normal map
  std::optional<double> alpha_cut{};     ///< 0 to 1; holes where the texture's alpha is less
  BackFace back_face = BackFace::shown;  ///< appearance of the back

  /// Lambertian reflection.
  static Material matte(const Color& reflectance);
  /// A glossy coat over Lambertian reflection.
  static Material plastic(const Color& reflectance, double roughness = 0.3, double ior = 1.5);
  /// Metal, by its reflectance at normal incidence.
  static Material metal(const Color& reflectance, double roughness = 0.3);
  /// A smooth mirror.
  static Material mirror(const Color& reflectance = {0.95F, 0.95F, 0.95F});
  /// glTF's metallic-roughness model.
  static Material principled(const Color& base_color, double roughness = 0.5, double metallic = 0);
  /// Solid glass, for closed meshes whose front is outside.
  static Material glass(double ior = 1.5, double roughness = 0);
  /// A pane, for single sheets of triangles.
  static Material thin_glass(double ior = 1.5);
};

/// A number of a material that can be changed later. ior lies between 1 and 100, all others between
/// 0 and 1.
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
