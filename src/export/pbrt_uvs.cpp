#include "export/pbrt_uvs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace troffer {

namespace {

constexpr double rounding = 1e-6;

// Returns the map from a mesh's (u,v) to the position in the image, v up.
UvMap map_of(const Texture& look) {
  const Vec2d at(place_in_image(look, {0, 0}));
  Vec2d u = Vec2d(place_in_image(look, {1, 0})) - at, v = Vec2d(place_in_image(look, {0, 1})) - at;
  return {{u.x, -u.y}, {v.x, -v.y}, {at.x, 1 - at.y}};
}

bool is_within(const UvBox& places) {
  constexpr float off = 1e-4f;
  return places.lower.x >= -off && places.lower.y >= -off && places.upper.x <= 1 + off &&
         places.upper.y <= 1 + off;
}

bool is_one(const Texture& look, WrapMode wrap) {
  return look.wrap_u == wrap && look.wrap_v == wrap;
}

// Within the image, mirroring equals clamping; repeating blends opposite edges.
bool is_clamped_within(const Texture& look, const UvBox& places) {
  const auto is_clamped = [&](WrapMode w) {
    return !look.is_filtered || w == WrapMode::clamp || w == WrapMode::mirror;
  };
  return is_within(places) && is_clamped(look.wrap_u) && is_clamped(look.wrap_v);
}

const char* wrap_name(WrapMode mode) {
  return mode == WrapMode::clamp ? "clamp" : mode == WrapMode::black ? "black" : "repeat";
}

}  // namespace

PbrtUvs::PbrtUvs(const Scene& scene, const MaterialUvs& uvs, uint32_t material, const Light* light,
                 WarningLog& warnings)
    : scene_(scene), uvs_(uvs), material_(material), warnings_(warnings) {
  const Material& m = scene.materials[material];
  const int32_t emission = light ? light->texture : no_texture;
  std::vector<int32_t> others;
  for_each_input(m, [&](const auto& input) {
    if (has_image(scene, input.texture)) others.push_back(input.texture);
  });
  for (const int32_t t : {m.bump.texture, m.is_alpha_masked ? m.alpha.texture : no_texture})
    if (has_image(scene, t)) others.push_back(t);
  std::vector<int32_t> all = others;
  const auto look = [&](int32_t texture) -> std::optional<Texture> {
    if (!has_image(scene, texture)) return std::nullopt;
    all.insert(all.begin(), texture);
    return common_look(scene, std::array{texture}, uvs_, material_)->look;
  };
  normal_ = look(m.normal_texture);
  emission_ = look(emission);
  is_used_ = !all.empty();
  choose_set(all);
  place_fixed(others);
}

void PbrtUvs::choose_set(const std::vector<int32_t>& textures) {
  const auto is_by_second = [&](int32_t t) {
    const auto common = common_look(scene_, std::array{t}, uvs_, material_);
    return common && common->look.mapping == TextureMapping::second_uv;
  };
  if (textures.empty()) return;
  is_second_ = is_by_second(textures.front());
  for (const int32_t t : textures)
    if (is_by_second(t) != is_second_)
      warnings_.add(
          is_second_
              ? "textures on the first set of texture coordinates are written for the second set"
              : "textures on a second set of texture coordinates are written for the first set");
}

void PbrtUvs::lead(const Texture& look) {
  const UvMap map = map_of(look);
  const double area = map.along_u.x * map.along_v.y - map.along_u.y * map.along_v.x;
  if (std::abs(area) > 1e-12 && std::isfinite(area)) written_ = map;
}

// Places the images that pbrt cannot place: normals and emission.
void PbrtUvs::place_fixed(const std::vector<int32_t>& others) {
  const UvBox box = uvs_.of(material_, is_second_);
  if (!normal_ && !emission_) {
    // Only a rotation shared by all images is a problem: no texture has one.
    std::optional<Texture> first;
    bool is_rotated = false;
    for (const int32_t t : others) {
      const Texture look = common_look(scene_, std::array{t}, uvs_, material_)->look;
      if (!first) first = look;
      is_rotated = is_rotated || look.uv_rotation_rad != 0;
      if (look.uv_rotation_rad != first->uv_rotation_rad || look.uv_scale != first->uv_scale)
        return;
    }
    if (is_rotated) lead(*first);
    return;
  }
  // pbrt always filters both: unfiltered images are enlarged.
  for (std::optional<Texture>* look : {&normal_, &emission_}) {
    if (!*look || (*look)->is_filtered) continue;
    const int times = std::clamp(2048 / std::max((*look)->width, (*look)->height), 1, 16);
    (*look)->width *= times;
    (*look)->height *= times;
  }
  const Texture first = normal_ ? *normal_ : *emission_;
  const UvBox places = places_over(first, box);
  const bool is_one_place = !normal_ || !emission_ || is_same_place(*normal_, *emission_);
  const bool is_clamped = is_clamped_within(first, places);
  const bool is_plain = normal_ ? !emission_ && is_one(first, WrapMode::repeat)
                                : is_clamped || is_one(first, WrapMode::clamp);
  // The frame of a normal map turns with (u,v).
  if (is_one_place && is_plain && !(normal_ && first.uv_rotation_rad != 0)) {
    lead(first);
    return;
  }
  std::optional<Texture> whole = tiled(first, box);
  const bool is_one_size =
      !normal_ || !emission_ ||
      (normal_->width == emission_->width && normal_->height == emission_->height);
  const bool is_exact = whole && is_one_place && is_one_size;
  if (!whole) whole = look_over(first, box);
  // Each image keeps its resolution over the area that all of them cover.
  const auto over_whole = [&](std::optional<Texture>& look) {
    if (!look) return;
    const Texture own = look_over(*look, box);
    const auto texels = [](int size, float share) {
      return std::isfinite(share) ? int(std::clamp(std::ceil(float(size) * share), 1.0f, 8192.0f))
                                  : 1;
    };
    look = *whole;
    if (is_exact) return;
    look->width = texels(own.width, own.uv_scale.x / std::abs(whole->uv_scale.x));
    look->height = texels(own.height, own.uv_scale.y / std::abs(whole->uv_scale.y));
  };
  over_whole(normal_);
  over_whole(emission_);
  if (!is_exact)
    warnings_.add(
        "normal maps and emission images are resampled: pbrt cannot place them separately");
  lead(*whole);
}

bool PbrtUvs::is_turned(const Mesh& mesh, const Triangle& t) const {
  const std::vector<Vec2>& uvs = is_second_ ? mesh.uvs_2 : mesh.uvs;
  if (uvs.empty()) return false;
  const Vec2 a = uvs[t[1]] - uvs[t[0]], b = uvs[t[2]] - uvs[t[0]];
  return a.x * b.y - a.y * b.x < 0;
}

// The y of a map points up in the image on the surface (trace/surface.cpp). pbrt's y is normal × x,
// with x along increasing written u.
Vec2 PbrtUvs::normal_signs(bool is_turned, bool is_v_up) const {
  const float x = written_.along_u.x < 0 ? -1.0f : 1.0f;
  return {x, is_turned != is_v_up ? x : -x};
}

std::vector<Vec2> PbrtUvs::of(const Mesh& mesh) const {
  const std::vector<Vec2>& uvs = is_second_ ? mesh.uvs_2 : mesh.uvs;
  std::vector<Vec2> out;
  if (!is_used_) return mesh.uvs;
  if (uvs.empty()) {
    // Otherwise pbrt gives each triangle its own coordinates.
    out.assign(mesh.positions.size(), Vec2(written_({0, 0})));
    return out;
  }
  out.reserve(uvs.size());
  for (const Vec2& uv : uvs) out.emplace_back(written_(uv));
  return out;
}

// Returns the map from written coordinates to the position in the image, v up.
UvMap PbrtUvs::relative(const Texture& look) const {
  const UvMap to = map_of(look);
  const Vec2d &u = written_.along_u, &v = written_.along_v;
  const double area = u.x * v.y - u.y * v.x;
  // Columns of the inverse of the written map.
  const Vec2d x{v.y / area, -u.y / area}, y{-v.x / area, u.x / area};
  UvMap out;
  out.along_u = to.along_u * x.x + to.along_v * x.y;
  out.along_v = to.along_u * y.x + to.along_v * y.y;
  out.offset = to.offset - out.along_u * written_.offset.x - out.along_v * written_.offset.y;
  return out;
}

std::optional<PbrtUvs::Placing> PbrtUvs::placing(std::span<const int32_t> textures) {
  std::optional<CommonLook> common = common_look(scene_, textures, uvs_, material_);
  if (!common) return std::nullopt;
  Texture look = common->look;
  if (common->is_resampled)
    warnings_.add("products of images with different placements are resampled into one image");
  const UvBox box = uvs_.of(material_, is_second_);
  const bool is_said = look.wrap_u == look.wrap_v && look.wrap_u != WrapMode::mirror;
  if (!is_said && !is_clamped_within(look, places_over(look, box))) {
    const std::optional<Texture> all = tiled(look, box);
    if (!all)
      warnings_.add(
          "images that are mirrored, or wrapped differently along u and v, are "
          "resampled");
    look = all ? *all : look_over(look, box);
  } else if (!is_said) {
    look.wrap_u = look.wrap_v = WrapMode::clamp;
  }
  UvMap map = relative(look);
  const auto is_straight = [&] {
    const double size = std::abs(map.along_u.x) + std::abs(map.along_v.y);
    return std::abs(map.along_u.y) + std::abs(map.along_v.x) <= rounding * size;
  };
  if (!is_straight()) {
    warnings_.add("rotated images are resampled: pbrt cannot rotate textures");
    look = look_over(look, box);
    map = relative(look);
  }
  const auto number = [](double v) {
    const double near = std::round(v * 1024) / 1024;
    return std::abs(v - near) < rounding ? near + 0.0 : v;
  };
  return Placing{
      look,
      fmt::format(" \"float uscale\" {} \"float vscale\" {} \"float udelta\" {} \"float vdelta\" "
                  "{} \"string wrap\" \"{}\" \"string filter\" \"{}\"",
                  float(number(map.along_u.x)), float(number(map.along_v.y)),
                  float(number(map.offset.x)), float(number(map.offset.y)), wrap_name(look.wrap_u),
                  look.is_filtered ? "bilinear" : "point")};
}

}  // namespace troffer
