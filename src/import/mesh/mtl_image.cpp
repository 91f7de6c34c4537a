#include "import/mesh/mtl_image.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "import/file.h"

namespace troffer {

namespace {

int32_t append(Scene& scene, Texture t) {
  scene.textures.push_back(std::move(t));
  return int32_t(scene.textures.size()) - 1;
}

bool has_texels(const Scene& scene, int32_t image) {
  return image >= 0 && scene.textures[size_t(image)].kind == TextureKind::image;
}

bool is_alpha(const Texture& t, size_t texel) {
  const auto channels = size_t(t.channels);
  return channels % 2 == 0 && texel % channels == channels - 1;
}

// Applies -mm to the stored values, except alpha: maps 0..1 to base..base + gain.
Texture ranged(Texture t, float base, float gain) {
  for (size_t i = 0; i < t.texels8.size(); ++i) {
    if (is_alpha(t, i)) continue;
    const float v = base + gain * float(t.texels8[i]) / 255;
    t.texels8[i] = uint8_t(std::lround(255 * std::clamp(v, 0.0f, 1.0f)));
  }
  for (size_t i = 0; i < t.texels_float.size(); ++i)
    if (!is_alpha(t, i)) t.texels_float[i] = std::max(base + gain * t.texels_float[i], 0.0f);
  return t;
}

// Returns a grey image. `of` computes a texel's value from its channels, which lie in [0,1] for
// 8-bit images.
template <class Of>
Texture grey(const Texture& t, const Of& of) {
  Texture out = t;
  out.channels = 1;
  out.is_srgb = false;
  out.texels8.clear();
  const auto stride = size_t(t.channels), texels = size_t(t.width) * size_t(t.height);
  out.texels_float.resize(texels);
  const auto value = [&](size_t i) {
    return t.texels8.empty() ? t.texels_float[i] : float(t.texels8[i]) / 255;
  };
  for (size_t i = 0; i < texels; ++i)
    out.texels_float[i] = of([&](size_t channel) { return value(i * stride + channel); });
  return out;
}

// Location of an image: the path in `map`, or beside the scene.
struct ImagePlace {
  std::string path;     // empty: not found
  std::string problem;  // reason if the path is empty
  bool is_beside = false;
};

ImagePlace place_of(const MtlMap& map, const std::string& folder) {
  const ConfinedPath path = confined_path(folder, map.file);
  std::error_code error;
  if (path.is_fine() && std::filesystem::exists(path.path, error)) return {path.path, "", false};
  const std::string beside = path_beside(folder, map.file);
  if (!beside.empty()) return {beside, "", true};
  return {path.is_fine() ? path.path : "", path.problem, false};
}

}  // namespace

void expect_mtl_images(const MtlMaterial& material, const std::string& folder,
                       TextureLoader& loader) {
  if (!loader.decodes_ahead()) return;
  for (const MtlMap* map : {&material.map_diffuse, &material.map_specular, &material.map_emission,
                            &material.map_opacity, &material.map_roughness, &material.map_metallic,
                            &material.map_exponent, &material.map_normal, &material.map_bump})
    if (!map->file.empty())
      if (const ImagePlace place = place_of(*map, folder); !place.path.empty())
        loader.expect_file(place.path);
}

float alpha_from_exponent(float exponent) {
  return std::sqrt(2 / (exponent + 2));
}

int32_t load_mtl_image(const MtlMap& map, bool is_color, const std::string& folder,
                       TextureLoader& loader, Scene& scene) {
  if (map.file.empty()) return no_texture;
  Texture look;
  look.is_srgb = is_color && !map.is_linear;
  look.uv_scale = {map.scale.x, -map.scale.y};
  look.uv_offset = {map.offset.x, 1 - map.offset.y};
  if (map.is_clamped) look.wrap_u = look.wrap_v = WrapMode::clamp;
  const ImagePlace place = place_of(map, folder);
  if (place.is_beside)
    scene.warnings.add(
        "MTL: images that are not found at their path are read from the scene's folder");
  if (map.is_turbulent)
    scene.warnings.add("MTL: -t of maps is not supported: turbulence is left out");
  const int32_t image = place.path.empty() ? loader.missing(map.file, place.problem, look)
                                           : loader.from_file(place.path, look);
  if ((map.base == 0 && map.gain == 1) || !has_texels(scene, image)) return image;
  return append(scene, ranged(scene.textures[size_t(image)], map.base, map.gain));
}

int32_t channel_of(const MtlMap& map, int32_t fallback, int32_t& image, Scene& scene) {
  switch (map.channel) {
    case 'r':
      return 0;
    case 'g':
      return 1;
    case 'b':
      return 2;
    case 'm':
      return 3;
    case 'l':
      if (has_texels(scene, image) && scene.textures[size_t(image)].channels >= 3)
        image = append(scene, grey(scene.textures[size_t(image)], [](const auto& channel) {
                         return luminance(Rgb{channel(0), channel(1), channel(2)});
                       }));
      return 0;
    default:
      return fallback;
  }
}

int32_t widths_from_exponents(int32_t image, int32_t channel, float exponent, Scene& scene) {
  if (!has_texels(scene, image)) return no_texture;
  const Texture& t = scene.textures[size_t(image)];
  const bool has_alpha = t.channels % 2 == 0;
  const size_t at = channel == 3      ? (has_alpha ? size_t(t.channels) - 1 : 0)
                    : t.channels >= 3 ? size_t(channel)
                                      : 0;
  return append(scene, grey(t, [&](const auto& texel) {
                  return alpha_from_exponent(exponent * std::max(texel(at), 0.0f));
                }));
}

}  // namespace troffer
