#include "import/mesh/mtl_convert.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "import/anisotropic_roughness.h"
#include "import/mesh/mtl_image.h"

namespace troffer {

namespace {

// True if a bump map is bluish on average: exporters write normal maps as bump maps, and height
// maps are grey.
bool looks_like_normals(const std::vector<Texture>& textures, int32_t image) {
  const Texture& t = textures[size_t(image)];
  if (t.kind != TextureKind::image || t.channels < 3) return false;
  constexpr int steps = 16;
  Rgb sum;
  for (int y = 0; y < steps; ++y)
    for (int x = 0; x < steps; ++x) {
      const Vec2 at{(float(x) + 0.5f) / steps, (float(y) + 0.5f) / steps};
      sum += evaluate(textures, uint32_t(image), at).rgb * (1.0f / (steps * steps));
    }
  return sum.b > 0.7f && std::abs(sum.r - 0.5f) < 0.15f && std::abs(sum.g - 0.5f) < 0.15f;
}

// Sets a bump map. The format does not define the height of 1; it is taken as 1 cm times -bm.
void set_bump(const MtlMap& map, const std::string& folder, TextureLoader& loader, Scene& scene,
              Material& m) {
  constexpr float height = 0.01f;
  WarningLog& warnings = scene.warnings;
  int32_t image = load_mtl_image(map, false, folder, loader, scene);
  if (image == no_texture) return;
  if (looks_like_normals(scene.textures, image)) {
    if (m.normal_texture >= 0) return;
    m.normal_texture = image;
    m.normal_scale = map.strength;
    warnings.add("MTL: a bluish bump map is read as a normal map");
  } else if (scene.textures[size_t(image)].kind == TextureKind::image) {
    const int32_t channel = channel_of(map, 0, image, scene);
    m.bump = {map.strength * height, image, channel};
    warnings.add("MTL: bump maps are approximated: a height of 1 is 1 cm times -bm");
  }
}

Rgb clamped_reflectance(Rgb c, WarningLog& warnings) {
  if (clamp01(c) != c) warnings.add("MTL: reflectance above 1 is clamped");
  return clamp01(c);
}

// True if the material uses the physically based extension.
bool is_by_roughness(const MtlMaterial& mtl) {
  return mtl.roughness || mtl.metallic || !mtl.map_roughness.file.empty() ||
         !mtl.map_metallic.file.empty();
}

// True if set_surface() made a glossy coat over a diffuse base, as bright as Ks.
bool is_gloss_by_color(const MtlMaterial& mtl, const Material& m) {
  return m.kind == MaterialKind::metallic_roughness && !is_by_roughness(mtl) &&
         !mtl.specular.is_black() && m.metallic.value == 0;
}

void set_anisotropy(const MtlMaterial& mtl, Material& m) {
  if (!(mtl.anisotropy > 0)) return;
  // The square root of Burley's aspect, because set_anisotropic_roughness takes roughness, the
  // square root of a width.
  const float aspect = std::pow(1 - 0.9f * mtl.anisotropy, 0.25f);
  set_anisotropic_roughness(m, m.roughness.value / aspect, m.roughness.value * aspect);
  m.anisotropy_rotation_rad += 2 * pi_f * mtl.turn;
}

void set_surface(const MtlMaterial& mtl, Rgb kd, Material& m, WarningLog& warnings) {
  const float ks = max_component(mtl.specular);
  const int illum = mtl.illumination;
  m.ior = mtl.ior > 1 && mtl.ior < 10 ? mtl.ior : 1.5f;
  m.base_color.value = kd;
  m.metallic = {0, no_texture, 0};
  m.roughness = {alpha_from_exponent(mtl.exponent), no_texture, 0};
  const bool is_glass = mtl.opacity < 1 && (illum == 6 || illum == 7);
  if (is_by_roughness(mtl)) {
    m.kind = MaterialKind::metallic_roughness;
    m.roughness.value = mtl.roughness.value_or(1);
    m.roughness_meaning = RoughnessMeaning::alpha_is_square;
    m.metallic.value = mtl.metallic.value_or(mtl.map_metallic.file.empty() ? 0.0f : 1.0f);
    m.coat.value = mtl.coat;
    m.coat_roughness.value = mtl.coat_roughness;
    m.sheen_color.value = Rgb{mtl.sheen};
    m.sheen_roughness.value = m.roughness.value;
    set_anisotropy(mtl, m);
  } else if (is_glass) {
    m.kind = MaterialKind::dielectric;
    m.base_color.value = Rgb{1};
    m.roughness.value = 0;
    return;
  } else if (illum == 3 || illum == 5 || illum == 8) {
    m.kind = MaterialKind::metallic_roughness;
    m.base_color.value = clamped_reflectance(kd + mtl.specular, warnings);
    const float all = average(kd + mtl.specular);
    m.metallic.value = all > 0 ? average(mtl.specular) / all : 0;
    // Mirrors without an exponent are perfect.
    if (mtl.exponent == 0 || illum == 3 || illum == 5) m.roughness.value = 0;
  } else if (ks > 0 && (illum == 2 || illum < 0 || illum > 3)) {
    m.kind = MaterialKind::metallic_roughness;
    m.specular.value = std::min(ks, 1.0f);
    m.specular_color.value = mtl.specular * (1 / ks);
  }
  if (mtl.opacity < 1) {
    m.kind = MaterialKind::metallic_roughness;
    m.is_thin = true;
    m.transmission.value = 1 - mtl.opacity;
    if (!mtl.roughness) m.roughness.value = 0;  // d alone does not mean frosted
    // One base colour serves both transmitted and reflected light; the larger part decides.
    if (mtl.filter && mtl.opacity < 0.5f && !mtl.filter->is_black())
      m.base_color.value = clamp01(*mtl.filter);
  }
}

// Loads the images that hold numbers: roughness, metallic, opacity and exponent.
void set_data_images(const MtlMaterial& mtl, const std::string& folder, TextureLoader& loader,
                     Scene& scene, Material& m) {
  const auto set = [&](const MtlMap& map, FloatInput& input, int32_t fallback) {
    input.texture = load_mtl_image(map, false, folder, loader, scene);
    if (input.texture >= 0) input.channel = channel_of(map, fallback, input.texture, scene);
  };
  set(mtl.map_roughness, m.roughness, m.roughness.channel);
  set(mtl.map_metallic, m.metallic, m.metallic.channel);
  if (!mtl.map_opacity.file.empty()) {
    m.is_alpha_masked = m.is_alpha_blended = true;
    // The colour image itself holds opacity in its alpha channel.
    const bool is_color_image = mtl.map_opacity.file == mtl.map_diffuse.file;
    m.alpha.value = 1;
    set(mtl.map_opacity, m.alpha, is_color_image ? 3 : 0);
  }
  if (mtl.map_exponent.file.empty()) return;
  if (is_by_roughness(mtl) || m.kind != MaterialKind::metallic_roughness ||
      !(m.roughness.value > 0)) {
    scene.warnings.add("MTL: map_Ns without gloss by Ns is ignored");
    return;
  }
  FloatInput factor;
  set(mtl.map_exponent, factor, 0);
  if (mtl.is_of_blender && factor.texture >= 0) {
    m.roughness = {1, factor.texture, factor.channel};
    m.roughness_meaning = RoughnessMeaning::alpha_is_square;
    return;
  }
  const int32_t widths = widths_from_exponents(factor.texture, factor.channel, mtl.exponent, scene);
  if (widths >= 0) m.roughness = {1, widths, 0};
}

}  // namespace

MtlConverted convert_mtl(const MtlMaterial& mtl, const std::string& folder, TextureLoader& loader,
                         Scene& scene) {
  WarningLog& warnings = scene.warnings;
  MtlConverted out;
  Material& m = out.material;
  m.name = mtl.name;
  const bool has_image = !mtl.map_diffuse.file.empty();
  Rgb kd = mtl.diffuse.value_or(has_image ? Rgb{1} : Rgb{0.5f});
  if (has_image && kd.is_black()) kd = Rgb{1};
  set_surface(mtl, clamped_reflectance(kd, warnings), m, warnings);
  m.base_color.texture = load_mtl_image(mtl.map_diffuse, true, folder, loader, scene);
  if (is_gloss_by_color(mtl, m))
    m.specular_color.texture = load_mtl_image(mtl.map_specular, true, folder, loader, scene);
  else if (!mtl.map_specular.file.empty())
    warnings.add("MTL: map_Ks is ignored unless gloss is given by Ks alone");
  if (!is_by_roughness(mtl) && (mtl.anisotropy > 0 || mtl.sheen > 0))
    warnings.add("MTL: aniso and Ps without Pr or Pm are ignored");
  set_data_images(mtl, folder, loader, scene, m);
  m.normal_texture = load_mtl_image(mtl.map_normal, false, folder, loader, scene);
  m.normal_scale = mtl.map_normal.strength;
  set_bump(mtl.map_bump, folder, loader, scene, m);
  const bool is_imaged = !mtl.map_emission.file.empty();
  out.emission = mtl.emission.value_or(is_imaged ? Rgb{1} : Rgb{0});
  if (!out.emission.is_black())
    out.emission_texture = load_mtl_image(mtl.map_emission, true, folder, loader, scene);
  else if (is_imaged)
    warnings.add("MTL: map_Ke with a Ke of 0 is ignored");
  return out;
}

}  // namespace troffer
