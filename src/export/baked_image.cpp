#include "export/baked_image.h"

#include <algorithm>
#include <cmath>

#include "image/encode.h"

namespace troffer {

namespace {

TexturePlace place_of(const Vec2& uv) {
  return {uv, uv};
}

template <class Value>
void fill(const Texture& look, BakedImage& out, const Value& value) {
  out.width = look.width;
  out.height = look.height;
  out.texels_float.reserve(size_t(out.width) * size_t(out.height) * size_t(out.channels));
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) value(uv_of_texel(look, x, y));
}

// True for an image whose texels can be written unchanged.
bool is_whole(const Texture& t, const Texture& look) {
  return t.kind == TextureKind::image && !t.texels8.empty() && !t.is_inverted &&
         t.value == Rgb{1} && t.width == look.width && t.height == look.height &&
         is_same_place(t, look);
}

BakedImage copy_of(const Texture& t, bool is_srgb) {
  BakedImage out;
  out.width = t.width;
  out.height = t.height;
  out.channels = t.channels;
  out.texels8 = t.texels8;
  out.is_srgb = is_srgb;
  return out;
}

void set_scale(BakedImage& image) {
  const auto n = size_t(image.channels);
  for (size_t i = 0; i < image.texels_float.size(); ++i)
    if (!(image.has_alpha() && i % n == n - 1))
      image.scale = std::max(image.scale, image.texels_float[i]);
}

}  // namespace

void tell_what_is_left_out(const Scene& scene, const Material& m, bool is_gltf,
                           WarningLog& warnings) {
  if (m.bump.texture >= 0 && (is_gltf || !has_image(scene, m.bump.texture)))
    warnings.add("bumps are not written");
  if (m.back_faces == BackFaces::black) warnings.add("black back sides are written like the front");
  if (m.back_faces == BackFaces::unseen && !is_gltf)
    warnings.add("back sides that are invisible to the camera are written like the front");
  if (!is_gltf && !m.sheen_color.value.is_black()) warnings.add("sheen is not written");
  if (!is_gltf && m.kind == MaterialKind::coated_diffuse && m.coat.value > 0)
    warnings.add("second coats over diffuse bases are not written");
  if (!is_gltf && m.iridescence.value > 0) warnings.add("thin films over gloss are not written");
  if (!is_gltf && m.coat_normal_texture >= 0)
    warnings.add("normal maps of clear coats are not written");
  if (!is_gltf && m.anisotropy.value > 0)
    warnings.add("anisotropic gloss is written as isotropic, with the width across the grain");
  for_each_input(m, [&](const auto& input) {
    if (input.texture < 0) return;
    const Texture& t = scene.textures[size_t(input.texture)];
    const bool is_second = t.mapping == TextureMapping::second_uv;
    if (t.kind >= TextureKind::checks || (t.mapping != TextureMapping::uv && !is_second))
      warnings.add("patterns, noise and textures placed in space are written as one colour");
  });
}

Rgb color_at(const Scene& scene, const ColorInput& input, const Vec2& uv,
             const ColorChange& change) {
  Rgb c = evaluate(scene.textures, input, place_of(uv));
  if (change)
    for (size_t k = 0; k < 3; ++k) c[k] = change(std::clamp(c[k], 0.0f, 1.0f));
  return c;
}

BakedImage baked_color(const Scene& scene, const ColorInput& input, const Texture& look,
                       const FloatInput* alpha, const ColorChange& change) {
  const Texture* t = input.texture >= 0 ? &scene.textures[size_t(input.texture)] : nullptr;
  if (t && !change && input.value == Rgb{1} && t->is_srgb && is_whole(*t, look)) {
    const bool has_alpha = t->channels == 2 || t->channels == 4;
    const bool is_alpha_its_own =
        alpha && has_alpha && alpha->texture == input.texture && alpha->channel == 3;
    // A surplus alpha channel is harmless: readers ignore it.
    if (is_alpha_its_own || !alpha) return copy_of(*t, true);
  }
  BakedImage out;
  out.channels = alpha ? 4 : 3;
  fill(look, out, [&](const Vec2& uv) {
    const Rgb c = color_at(scene, input, uv, change);
    out.texels_float.insert(out.texels_float.end(), {c.r, c.g, c.b});
    if (alpha)
      out.texels_float.push_back(
          evaluate(scene.textures, FloatInput{1, alpha->texture, alpha->channel}, place_of(uv)));
  });
  set_scale(out);
  return out;
}

BakedImage baked_number(const Scene& scene, const FloatInput& input, const Texture& look,
                        float power) {
  BakedImage out;
  out.channels = 1;
  out.is_srgb = false;
  fill(look, out, [&](const Vec2& uv) {
    const float v = std::clamp(evaluate(scene.textures, input, place_of(uv)), 0.0f, 1.0f);
    out.texels_float.push_back(power == 1 ? v : std::pow(v, power));
  });
  return out;
}

BakedImage baked_heights(const Scene& scene, const FloatInput& input, const Texture& look) {
  BakedImage out;
  out.channels = 1;
  out.is_srgb = false;
  fill(look, out, [&](const Vec2& uv) {
    out.texels_float.push_back(evaluate(scene.textures, input, place_of(uv)));
  });
  return out;
}

BakedImage baked_holes(const Scene& scene, const Material& material, const Texture& look) {
  BakedImage out;
  out.channels = 1;
  out.is_srgb = false;
  fill(look, out, [&](const Vec2& uv) {
    out.texels_float.push_back(coverage(scene.textures, material, place_of(uv)));
  });
  return out;
}

BakedImage as_alpha(const BakedImage& number) {
  BakedImage out;
  out.width = number.width;
  out.height = number.height;
  out.channels = 4;
  out.is_srgb = false;
  for (const float v : number.texels_float)
    out.texels_float.insert(out.texels_float.end(), {1, 1, 1, v});
  return out;
}

BakedImage baked_pair(const Scene& scene, const FloatInput& green, float green_power,
                      const FloatInput& blue, const Texture& look) {
  BakedImage out;
  out.is_srgb = false;
  fill(look, out, [&](const Vec2& uv) {
    const float g = std::clamp(evaluate(scene.textures, green, place_of(uv)), 0.0f, 1.0f);
    const float b = std::clamp(evaluate(scene.textures, blue, place_of(uv)), 0.0f, 1.0f);
    out.texels_float.insert(out.texels_float.end(), {0, std::pow(g, green_power), b});
  });
  return out;
}

BakedImage baked_raw(const Scene& scene, uint32_t texture, const Texture& look) {
  const Texture& t = scene.textures[texture];
  if (is_whole(t, look) && !t.is_srgb && t.channels == 3) return copy_of(t, false);
  BakedImage out;
  out.is_srgb = false;
  fill(look, out, [&](const Vec2& uv) {
    const Rgb c = clamp01(evaluate(scene.textures, texture, place_of(uv)).rgb);
    out.texels_float.insert(out.texels_float.end(), {c.r, c.g, c.b});
  });
  return out;
}

BakedImage baked_normals(const Scene& scene, uint32_t texture, const Texture& look,
                         const Vec2& factors) {
  if (factors == Vec2{1, 1}) return baked_raw(scene, texture, look);
  BakedImage out;
  out.is_srgb = false;
  fill(look, out, [&](const Vec2& uv) {
    const Rgb c = evaluate(scene.textures, texture, place_of(uv)).rgb;
    const Vec3 n{(2 * c.r - 1) * factors.x, (2 * c.g - 1) * factors.y, 2 * c.b - 1};
    const float l = std::max(length(n), 1e-6f);
    for (size_t k = 0; k < 3; ++k)
      out.texels_float.push_back(std::clamp(0.5f + 0.5f * n[k] / l, 0.0f, 1.0f));
  });
  return out;
}

std::vector<uint8_t> png_of(const BakedImage& image) {
  if (!image.texels8.empty())
    return encode_png_texels(image.width, image.height, image.channels, image.texels8);
  const auto n = size_t(image.channels);
  std::vector<float> coded(image.texels_float.size());
  for (size_t i = 0; i < coded.size(); ++i) {
    const float v = image.texels_float[i];
    const bool is_alpha = image.has_alpha() && i % n == n - 1;
    coded[i] = is_alpha || !image.is_srgb ? v : srgb_from_linear(std::max(v, 0.0f) / image.scale);
  }
  return encode_png_texels(image.width, image.height, image.channels, coded);
}

bool needs_floats(const BakedImage& image) {
  return std::any_of(image.texels_float.begin(), image.texels_float.end(),
                     [&](float v) { return v < 0 || v > (image.is_srgb ? image.scale : 1); });
}

std::vector<uint8_t> pfm_of(const BakedImage& image) {
  Image out(image.width, image.height);
  const auto n = size_t(image.channels);
  for (size_t i = 0; i < out.pixels.size(); ++i)
    for (size_t k = 0; k < 3; ++k) out.pixels[i][k] = image.texels_float[i * n + (n >= 3 ? k : 0)];
  return encode_pfm(out);
}

}  // namespace troffer
