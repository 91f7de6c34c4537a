#include "export/texture_look.h"

#include <algorithm>
#include <cmath>

namespace troffer {

namespace {

constexpr int most_texels_across = 8192;  // limit on tiled images: 64 Mi texels
constexpr float texel_rounding = 1e-4f;   // in texels: within this of an edge counts as on it

Vec2 turned(const Texture& t, const Vec2& way) {
  const Vec2 uv{way.x * t.uv_scale.x, way.y * t.uv_scale.y};
  if (t.uv_rotation_rad == 0) return uv;
  const float c = std::cos(t.uv_rotation_rad), s = std::sin(t.uv_rotation_rad);
  return {c * uv.x + s * uv.y, -s * uv.x + c * uv.y};
}

void collect_images(const Scene& scene, int32_t texture, std::vector<const Texture*>& out) {
  if (texture < 0) return;
  const Texture& t = scene.textures[size_t(texture)];
  if (t.kind == TextureKind::image) out.push_back(&t);
  if (t.kind != TextureKind::product) return;
  // Factors have lower indices, so the recursion ends.
  collect_images(scene, int32_t(t.factor_a), out);
  collect_images(scene, int32_t(t.factor_b), out);
}

}  // namespace

void UvBox::add(const Vec2& uv) {
  if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return;
  lower = {std::min(lower.x, uv.x), std::min(lower.y, uv.y)};
  upper = {std::max(upper.x, uv.x), std::max(upper.y, uv.y)};
}

MaterialUvs::MaterialUvs(const Scene& scene) : boxes_(scene.materials.size()) {
  const auto add = [&](const std::vector<Mesh>& meshes) {
    for (const Mesh& m : meshes) {
      if (m.material >= boxes_.size()) continue;
      for (const Vec2& uv : m.uvs) boxes_[m.material][0].add(uv);
      for (const Vec2& uv : m.uvs_2) boxes_[m.material][1].add(uv);
    }
  };
  add(scene.meshes);
  add(scene.instanced_meshes);
}

UvBox MaterialUvs::of(uint32_t material, bool is_second) const {
  UvBox box = material < boxes_.size() ? boxes_[material][is_second ? 1 : 0] : UvBox();
  if (box.is_empty()) {
    box.add({0, 0});
    box.add({1, 1});
  }
  return box;
}

bool has_image(const Scene& scene, int32_t texture) {
  std::vector<const Texture*> images;
  collect_images(scene, texture, images);
  return !images.empty();
}

Texture look_of(const Texture& image) {
  Texture look;
  look.kind = TextureKind::image;
  look.width = image.width;
  look.height = image.height;
  look.is_filtered = image.is_filtered;
  look.wrap_u = image.wrap_u;
  look.wrap_v = image.wrap_v;
  look.uv_scale = image.uv_scale;
  look.uv_offset = image.uv_offset;
  look.uv_rotation_rad = image.uv_rotation_rad;
  look.mapping = image.mapping;
  return look;
}

bool is_same_place(const Texture& a, const Texture& b) {
  return a.uv_scale == b.uv_scale && a.uv_offset == b.uv_offset &&
         a.uv_rotation_rad == b.uv_rotation_rad && a.wrap_u == b.wrap_u && a.wrap_v == b.wrap_v &&
         a.mapping == b.mapping;
}

Vec2 place_in_image(const Texture& look, const Vec2& uv) {
  return turned(look, uv) + look.uv_offset;
}

Vec2 uv_of_texel(const Texture& t, int x, int y) {
  Vec2 uv{(float(x) + 0.5f) / float(t.width), (float(y) + 0.5f) / float(t.height)};
  uv = uv - t.uv_offset;
  if (t.uv_rotation_rad != 0) {
    const float c = std::cos(t.uv_rotation_rad), s = std::sin(t.uv_rotation_rad);
    uv = {c * uv.x - s * uv.y, s * uv.x + c * uv.y};
  }
  return {t.uv_scale.x != 0 ? uv.x / t.uv_scale.x : 0, t.uv_scale.y != 0 ? uv.y / t.uv_scale.y : 0};
}

UvBox places_over(const Texture& look, const UvBox& uvs) {
  UvBox out;
  for (const float u : {uvs.lower.x, uvs.upper.x})
    for (const float v : {uvs.lower.y, uvs.upper.y}) out.add(place_in_image(look, {u, v}));
  return out;
}

std::optional<Texture> tiled(const Texture& look, const UvBox& uvs) {
  if (look.uv_rotation_rad != 0) return std::nullopt;
  const UvBox places = places_over(look, uvs);
  Texture out = look;
  // Texels that are blended at the edges of the outer copies.
  const int rim = look.is_filtered ? 1 : 0;
  for (size_t axis = 0; axis < 2; ++axis) {
    const float first = std::floor(places.lower[axis] + texel_rounding),
                end = std::ceil(places.upper[axis] - texel_rounding);
    const float n = std::max(end - first, 1.0f);
    int& size = axis == 0 ? out.width : out.height;
    if (!(n * float(size) <= float(most_texels_across))) return std::nullopt;
    const auto before = float(size);
    size = size * int(n) + 2 * rim;
    out.uv_scale[axis] *= before / float(size);
    out.uv_offset[axis] = ((out.uv_offset[axis] - first) * before + float(rim)) / float(size);
  }
  out.wrap_u = out.wrap_v = WrapMode::clamp;
  return out;
}

Texture look_over(const Texture& look, const UvBox& uvs) {
  constexpr float most = 4096, least_extent = 1e-6f;
  Texture out = look;
  const Vec2 extent{std::max(uvs.upper.x - uvs.lower.x, least_extent),
                    std::max(uvs.upper.y - uvs.lower.y, least_extent)};
  const auto texels = [&](const Vec2& way) {
    const Vec2 t = turned(look, way);
    return std::hypot(t.x * float(look.width), t.y * float(look.height));
  };
  out.width = int(std::ceil(std::clamp(texels({extent.x, 0}) - texel_rounding, 1.0f, most)));
  out.height = int(std::ceil(std::clamp(texels({0, extent.y}) - texel_rounding, 1.0f, most)));
  out.uv_scale = {1 / extent.x, 1 / extent.y};
  out.uv_offset = {-uvs.lower.x / extent.x, -uvs.lower.y / extent.y};
  out.uv_rotation_rad = 0;
  out.wrap_u = out.wrap_v = WrapMode::clamp;
  return out;
}

std::optional<CommonLook> common_look(const Scene& scene, std::span<const int32_t> textures,
                                      const MaterialUvs& uvs, uint32_t material) {
  std::vector<const Texture*> images;
  for (const int32_t t : textures) collect_images(scene, t, images);
  if (images.empty()) return std::nullopt;
  CommonLook out{look_of(*images[0]), false};
  for (const Texture* image : images) out.is_resampled |= !is_same_place(*image, out.look);
  const UvBox box = uvs.of(material, out.look.mapping == TextureMapping::second_uv);
  if (out.is_resampled) out.look = look_over(out.look, box);
  for (const Texture* image : images) {
    const Texture look = out.is_resampled ? look_over(look_of(*image), box) : look_of(*image);
    out.look.width = std::max(out.look.width, look.width);
    out.look.height = std::max(out.look.height, look.height);
    out.look.is_filtered |= look.is_filtered;
  }
  return out;
}

}  // namespace troffer
