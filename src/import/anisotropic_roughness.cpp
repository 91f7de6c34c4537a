#include "import/anisotropic_roughness.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace troffer {

namespace {

float width_of(float roughness, RoughnessMeaning meaning) {
  const float r = std::clamp(roughness, 0.0f, 1.0f);
  return meaning == RoughnessMeaning::alpha           ? r
         : meaning == RoughnessMeaning::alpha_is_sqrt ? std::sqrt(r)
                                                      : r * r;
}

bool are_looked_up_alike(const Texture& a, const Texture& b) {
  return a.width == b.width && a.height == b.height && a.wrap_u == b.wrap_u &&
         a.wrap_v == b.wrap_v && a.is_filtered == b.is_filtered && a.mapping == b.mapping &&
         a.uv_scale == b.uv_scale && a.uv_offset == b.uv_offset &&
         a.uv_rotation_rad == b.uv_rotation_rad;
}

// Returns the value of a texel, or the constant if there is no image.
float texel_of(const std::vector<Texture>& textures, const FloatInput& in, size_t i) {
  if (in.texture < 0) return in.value;
  const Texture& t = textures[size_t(in.texture)];
  const size_t at = i * size_t(t.channels) + size_t(in.channel);
  if (!t.texels_float.empty()) return in.value * t.texels_float[at];
  const float v = float(t.texels8[at]) / 255;
  return in.value * (t.is_srgb ? linear_from_srgb(v) : v);
}

}  // namespace

bool set_anisotropic_roughness(Scene& scene, Material& m, const FloatInput& along_u,
                               const FloatInput& along_v) {
  const Texture* image = nullptr;
  for (const FloatInput* in : {&along_u, &along_v}) {
    if (in->texture < 0) continue;
    const Texture& t = scene.textures[size_t(in->texture)];
    const bool is_usable = t.kind == TextureKind::image && t.value == Rgb{1} && !t.is_inverted &&
                           in->channel < t.channels && (!image || are_looked_up_alike(*image, t));
    if (!is_usable) return false;
    image = &t;
  }
  if (!image) {
    set_anisotropic_roughness(m, along_u.value, along_v.value);
    return true;
  }
  Texture narrow = *image, grain = *image;
  for (Texture* t : {&narrow, &grain}) {
    t->name += t == &grain ? ": grain" : ": narrower width";
    t->is_srgb = false;
    t->texels8.clear();
    t->texels_float.clear();
  }
  narrow.channels = 1;
  grain.channels = 3;  // direction in red and green, -1 to 1; strength in blue
  const size_t texels = size_t(image->width) * size_t(image->height);
  for (size_t i = 0; i < texels; ++i) {
    const float u = texel_of(scene.textures, along_u, i), v = texel_of(scene.textures, along_v, i);
    Material one;
    one.roughness_meaning = m.roughness_meaning;
    set_anisotropic_roughness(one, u, v);
    narrow.texels_float.push_back(one.roughness.value);
    const float x = u >= v ? 1.0f : 0.5f, y = u >= v ? 0.5f : 1.0f;
    grain.texels_float.insert(grain.texels_float.end(), {x, y, one.anisotropy.value});
  }
  scene.textures.push_back(std::move(narrow));
  m.roughness = {1, int32_t(scene.textures.size()) - 1, 0};
  scene.textures.push_back(std::move(grain));
  m.anisotropy = {1, int32_t(scene.textures.size()) - 1, 2};
  return true;
}

// The narrower width becomes the roughness; the wider one is alpha + (1 - alpha) × anisotropy².
void set_anisotropic_roughness(Material& m, float along_u, float along_v) {
  const float narrow = std::min(along_u, along_v), wide = std::max(along_u, along_v);
  m.roughness = {narrow, no_texture, m.roughness.channel};
  const float a = width_of(narrow, m.roughness_meaning), b = width_of(wide, m.roughness_meaning);
  if (!(b > a)) return;
  m.anisotropy.value = std::sqrt((b - a) / (1 - a));
  m.anisotropy_rotation_rad = along_v > along_u ? 0.5f * pi_f : 0;
}

}  // namespace troffer
