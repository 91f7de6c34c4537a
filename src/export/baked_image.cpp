#include "export/baked_image.h"

#include <algorithm>
#include <cmath>

#include "image/encode.h"

namespace troffer {

namespace {

// Sizes of the image a texture is baked at: that of its (first) image.
void set_size(const Texture* image, BakedImage& out) {
  if (!image) return;
  out.width = image->width;
  out.height = image->height;
}

// (u,v) at which the texture's image shows the middle of a texel: its transform undone.
Vec2 uv_of(const Texture& t, int x, int y) {
  Vec2 uv{(float(x) + 0.5f) / float(t.width), (float(y) + 0.5f) / float(t.height)};
  uv = uv - t.uv_offset;
  if (t.uv_rotation_rad != 0) {
    const float c = std::cos(t.uv_rotation_rad), s = std::sin(t.uv_rotation_rad);
    uv = {c * uv.x - s * uv.y, s * uv.x + c * uv.y};
  }
  return {t.uv_scale.x != 0 ? uv.x / t.uv_scale.x : 0, t.uv_scale.y != 0 ? uv.y / t.uv_scale.y : 0};
}

template <class Value>
void fill(const Texture* image, BakedImage& out, const Value& value) {
  set_size(image, out);
  out.texels_float.reserve(size_t(out.width) * size_t(out.height) * size_t(out.channels));
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) value(image ? uv_of(*image, x, y) : Vec2{0, 0});
}

}  // namespace

const Texture* image_of(const Scene& scene, int32_t texture) {
  if (texture < 0) return nullptr;
  const Texture& t = scene.textures[size_t(texture)];
  if (t.kind == TextureKind::image) return &t;
  if (t.kind != TextureKind::product) return nullptr;
  // Factors have lower indices, so this ends.
  const Texture* a = image_of(scene, int32_t(t.factor_a));
  return a ? a : image_of(scene, int32_t(t.factor_b));
}

void tell_what_is_left_out(const Scene& scene, const Material& m, bool is_gltf,
                           WarningLog& warnings) {
  if (m.bump.texture >= 0) warnings.add("bumps are not written");
  if (m.back_faces == BackFaces::black) warnings.add("black backs are written as their fronts");
  if (m.back_faces == BackFaces::unseen && !is_gltf)
    warnings.add("backs that the eye does not see are written as their fronts");
  if (!is_gltf && !m.sheen_color.value.is_black()) warnings.add("sheen is not written");
  if (!is_gltf && m.kind == MaterialKind::coated_diffuse && m.coat.value > 0)
    warnings.add("second coats over diffuse bases are not written");
  if (!is_gltf && m.iridescence.value > 0) warnings.add("thin films over gloss are not written");
  if (!is_gltf && m.coat_normal_texture >= 0)
    warnings.add("normal maps of clear coats are not written");
  if (!is_gltf && m.anisotropy.value > 0)
    warnings.add("gloss with a grain is written as wide as across it");
  for_each_input(m, [&](const auto& input) {
    if (input.texture < 0) return;
    const Texture& t = scene.textures[size_t(input.texture)];
    const bool is_second = t.mapping == TextureMapping::second_uv;
    if (is_second && !is_gltf)
      warnings.add("textures by a second set of coordinates are written by the first");
    if (t.kind >= TextureKind::checks || (t.mapping != TextureMapping::uv && !is_second))
      warnings.add("patterns, noise and textures placed in space are written as one colour");
  });
}

Rgb color_at(const Scene& scene, const ColorInput& input, const Vec2& uv,
             const ColorChange& change) {
  Rgb c = evaluate(scene.textures, input, uv);
  if (change)
    for (size_t k = 0; k < 3; ++k) c[k] = change(std::clamp(c[k], 0.0f, 1.0f));
  return c;
}

BakedImage baked_color(const Scene& scene, const ColorInput& input, bool with_alpha,
                       const ColorChange& change) {
  BakedImage out;
  const Texture* image = image_of(scene, input.texture);
  const Texture* t = input.texture >= 0 ? &scene.textures[size_t(input.texture)] : nullptr;
  const bool has_alpha = image && (image->channels == 2 || image->channels == 4);
  const bool is_plain = !change && image && image == t && !image->texels8.empty() &&
                        image->is_srgb && !image->is_inverted &&
                        image->value * input.value == Rgb{1} && has_alpha == with_alpha;
  if (is_plain) {
    set_size(image, out);
    out.channels = image->channels;
    out.texels8 = image->texels8;
    return out;
  }
  out.channels = with_alpha ? 4 : 3;
  fill(image, out, [&](const Vec2& uv) {
    const Rgb c = color_at(scene, input, uv, change);
    out.texels_float.insert(out.texels_float.end(), {c.r, c.g, c.b});
    if (with_alpha)
      out.texels_float.push_back(t ? evaluate(scene.textures, uint32_t(input.texture), uv).alpha
                                   : 1);
  });
  const auto is_alpha = [&](size_t i) { return with_alpha && i % 4 == 3; };
  for (size_t i = 0; i < out.texels_float.size(); ++i)
    if (!is_alpha(i)) out.scale = std::max(out.scale, out.texels_float[i]);
  for (size_t i = 0; i < out.texels_float.size(); ++i)
    if (!is_alpha(i))
      out.texels_float[i] = srgb_from_linear(std::max(out.texels_float[i], 0.0f) / out.scale);
  return out;
}

BakedImage baked_number(const Scene& scene, const FloatInput& input, float power) {
  BakedImage out;
  out.channels = 1;
  out.is_srgb = false;
  fill(image_of(scene, input.texture), out, [&](const Vec2& uv) {
    const float v = std::clamp(evaluate(scene.textures, input, uv), 0.0f, 1.0f);
    out.texels_float.push_back(std::pow(v, power));
  });
  return out;
}

BakedImage baked_pair(const Scene& scene, const FloatInput& green, float green_power,
                      const FloatInput& blue) {
  BakedImage out;
  out.is_srgb = false;
  const Texture* image = image_of(scene, green.texture >= 0 ? green.texture : blue.texture);
  fill(image, out, [&](const Vec2& uv) {
    const float g = std::clamp(evaluate(scene.textures, green, uv), 0.0f, 1.0f);
    const float b = std::clamp(evaluate(scene.textures, blue, uv), 0.0f, 1.0f);
    out.texels_float.insert(out.texels_float.end(), {0, std::pow(g, green_power), b});
  });
  return out;
}

BakedImage baked_raw(const Scene& scene, uint32_t texture) {
  BakedImage out;
  out.is_srgb = false;
  const Texture* image = image_of(scene, int32_t(texture));
  if (image && !image->texels8.empty() && image->channels == 3) {
    set_size(image, out);
    out.texels8 = image->texels8;
    return out;
  }
  fill(image, out, [&](const Vec2& uv) {
    const Rgb c = clamp01(evaluate(scene.textures, texture, uv).rgb);
    out.texels_float.insert(out.texels_float.end(), {c.r, c.g, c.b});
  });
  return out;
}

std::vector<uint8_t> png_of(const BakedImage& image) {
  return image.texels8.empty()
             ? encode_png_texels(image.width, image.height, image.channels, image.texels_float)
             : encode_png_texels(image.width, image.height, image.channels, image.texels8);
}

}  // namespace troffer
