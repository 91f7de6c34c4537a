#include "export/gltf_materials.h"

#include <fmt/format.h>

#include <cmath>

#include "base/coat.h"
#include "export/vertex_colors.h"

namespace troffer {

namespace {

using Json = GltfMaterialWriter::Json;

Json list(Rgb c) {
  return {c.r, c.g, c.b};
}

int wrap_code(WrapMode mode) {
  return mode == WrapMode::repeat ? 10497 : mode == WrapMode::mirror ? 33648 : 33071;
}

// glTF's roughness is the square root of the GGX width.
float power_for_gltf(RoughnessMeaning meaning) {
  return meaning == RoughnessMeaning::alpha           ? 0.5f
         : meaning == RoughnessMeaning::alpha_is_sqrt ? 0.25f
                                                      : 1;
}

Rgb normal_reflectance(const Material& m) {
  const float over = m.coat.value > 0 ? m.coat_ior : 1;
  const Rgb eta = m.eta / over, k = m.k / over;
  const Rgb one{1}, below = eta - one, above = eta + one, k2 = k * k;
  return (below * below + k2) / (above * above + k2);
}

}  // namespace

std::optional<Texture> GltfMaterialWriter::look_of_all(std::span<const int32_t> textures) {
  const auto common = common_look(scene_, textures, mesh_uvs_, material_);
  if (!common) return std::nullopt;
  if (common->is_resampled)
    warnings_.add("images with different placements that glTF stores in one image are resampled");
  Texture look = common->look;
  if (look.wrap_u != WrapMode::black && look.wrap_v != WrapMode::black) return look;
  warnings_.add("images that are black beyond their edges are written with clamped edges");
  return look;
}

Json GltfMaterialWriter::texture(const std::string& key, const Texture& look,
                                 const std::function<BakedImage(const Texture&)>& bake) {
  const std::string whole = fmt::format(
      "{} at {} {} {} {} {} {} {} {} {} {} {}", key, look.width, look.height, look.uv_scale.x,
      look.uv_scale.y, look.uv_offset.x, look.uv_offset.y, look.uv_rotation_rad, int(look.mapping),
      int(look.wrap_u), int(look.wrap_v), look.is_filtered);
  const auto found = texture_by_key_.find(whole);
  const size_t index =
      found != texture_by_key_.end() ? found->second : add_texture(png_of(bake(look)), look, "");
  texture_by_key_[whole] = index;
  Json out{{"index", index}};
  if (look.mapping == TextureMapping::second_uv) out["texCoord"] = 1;
  Json t = Json::object();
  if (look.uv_scale.x != 1 || look.uv_scale.y != 1) t["scale"] = {look.uv_scale.x, look.uv_scale.y};
  if (look.uv_offset.x != 0 || look.uv_offset.y != 0)
    t["offset"] = {look.uv_offset.x, look.uv_offset.y};
  if (look.uv_rotation_rad != 0) t["rotation"] = look.uv_rotation_rad;
  if (!t.empty()) out["extensions"]["KHR_texture_transform"] = t;
  return out;
}

size_t GltfMaterialWriter::add_texture(std::vector<uint8_t> png, const Texture& look,
                                       const std::string& name) {
  images_.push_back({{"bufferView", buffer_.add_view(png)}, {"mimeType", "image/png"}});
  if (!name.empty()) images_.back()["name"] = name;
  const int filter = look.is_filtered ? 9729 : 9728;
  samplers_.push_back({{"magFilter", filter},
                       {"minFilter", filter},
                       {"wrapS", wrap_code(look.wrap_u)},
                       {"wrapT", wrap_code(look.wrap_v)}});
  textures_.push_back({{"source", images_.size() - 1}, {"sampler", samplers_.size() - 1}});
  return textures_.size() - 1;
}

// Writes alpha mode and cutoff. add_base() writes the alpha image and factor.
void GltfMaterialWriter::add_alpha(const Material& m, Json& out) {
  if (!m.is_alpha_masked) return;
  out["alphaMode"] = m.is_alpha_blended ? "BLEND" : "MASK";
  if (!m.is_alpha_blended) out["alphaCutoff"] = m.alpha_cutoff;
}

// Writes base colour and alpha.
void GltfMaterialWriter::add_base(const Material& m, Json& out) {
  // Complete `out` before taking a reference into it: adding entries moves its contents.
  out["pbrMetallicRoughness"] = Json();
  add_alpha(m, out);
  Json& pbr = out["pbrMetallicRoughness"];
  ColorInput base = m.base_color;
  if (m.kind == MaterialKind::conductor && !m.is_reflectance)
    base = {normal_reflectance(m) * m.specular_color.value, m.specular_color.texture};
  ColorChange change;
  if (m.kind == MaterialKind::coated_diffuse)
    change = [f = mean_reflectance_inside(double(m.ior))](float v) { return to_white_base(v, f); };
  const bool has_alpha_image = m.is_alpha_masked && has_image(scene_, m.alpha.texture);
  const float alpha = !m.is_alpha_masked ? 1
                      : has_alpha_image  ? m.alpha.value
                                         : evaluate(scene_.textures, m.alpha, Vec2{0, 0});
  const bool has_color_image = has_image(scene_, base.texture);
  if (!has_color_image) {
    base.value = clamp01(color_at(scene_, base, {0, 0}, change));
    base.texture = no_texture;
    change = {};
  }
  // Keeps the value as a factor if glTF allows it.
  const bool is_factor = !change && max_component(base.value) <= 1;
  const Rgb factor = is_factor ? base.value : Rgb{1};
  if (is_factor) base.value = Rgb{1};
  pbr["baseColorFactor"] = {factor.r, factor.g, factor.b, std::clamp(alpha, 0.0f, 1.0f)};
  const auto look =
      look_of_all(std::array{base.texture, has_alpha_image ? m.alpha.texture : no_texture});
  if (!look) return;
  const std::string key = fmt::format(
      "color {} {} {} {} {}{}", base.texture, base.value.r, base.value.g, base.value.b,
      change ? fmt::format("{} ", change(0.5f)) : "",
      has_alpha_image ? fmt::format("alpha {} {}", m.alpha.texture, m.alpha.channel) : "");
  pbr["baseColorTexture"] = texture(key, *look, [&](const Texture& t) {
    BakedImage image = baked_color(scene_, base, t, has_alpha_image ? &m.alpha : nullptr, change);
    if (image.scale > 1) warnings_.add("surface colours above 1 are written as 1");
    image.scale = 1;
    return image;
  });
}

void GltfMaterialWriter::add_roughness(const Material& m, Json& pbr) {
  const bool is_mixed = m.kind == MaterialKind::metallic_roughness;
  const float power = power_for_gltf(m.roughness_meaning);
  FloatInput rough = m.roughness;
  // Light that leaves a refracting coat at normal incidence is spread by the coat's index.
  if (m.kind == MaterialKind::conductor && m.coat.value > 0)
    rough.value *= std::pow(m.coat_ior, power > 0 ? 0.5f / power : 1.0f);
  FloatInput metal = is_mixed ? m.metallic : FloatInput{0, no_texture, 0};
  if (m.kind == MaterialKind::conductor) metal.value = 1;
  const auto look = look_of_all(std::array{rough.texture, metal.texture});
  if (!look) {
    pbr["roughnessFactor"] =
        std::pow(std::clamp(evaluate(scene_.textures, rough, Vec2{0, 0}), 0.0f, 1.0f), power);
    pbr["metallicFactor"] = std::clamp(evaluate(scene_.textures, metal, Vec2{0, 0}), 0.0f, 1.0f);
    return;
  }
  const std::string key =
      fmt::format("rough {} {} {} {} metal {} {} {}", rough.texture, rough.channel, rough.value,
                  power, metal.texture, metal.channel, metal.value);
  pbr["metallicRoughnessTexture"] = texture(
      key, *look, [&](const Texture& t) { return baked_pair(scene_, rough, power, metal, t); });
}

void GltfMaterialWriter::add_normal(int32_t normal, float scale, const char* name, Json& out) {
  const auto look = look_of_all(std::array{normal});
  if (!look) return;
  out[name] = texture(fmt::format("raw {}", normal), *look,
                      [&](const Texture& t) { return baked_raw(scene_, uint32_t(normal), t); });
  if (scale != 1) out[name]["scale"] = scale;
}

Json GltfMaterialWriter::surface(const Material& m) {
  if (m.kind == MaterialKind::angular) {
    warnings_.add("matrices of directional scattering (BSDF) are written as clear glass");
    Material glass;
    glass.name = m.name;
    glass.kind = MaterialKind::dielectric;
    glass.base_color.value = Rgb{1};
    glass.is_thin = true;
    return surface(glass);
  }
  Json out;
  if (!m.name.empty()) out["name"] = m.name;
  add_base(m, out);
  add_normal(m.normal_texture, m.normal_scale, "normalTexture", out);
  Json& pbr = out["pbrMetallicRoughness"];
  if (m.kind == MaterialKind::diffuse) {  // no specular reflection: Lambertian
    pbr["metallicFactor"] = 0;
    out["extensions"]["KHR_materials_specular"] = {{"specularFactor", 0}};
    add_diffuse_transmission(m, out);
    return out;
  }
  add_roughness(m, pbr);
  add_cloth_and_grain(m, out);
  add_clear_coat(m, out);
  add_film(m, out);
  if (m.kind == MaterialKind::conductor) {
    if (m.coat.value > 0)
      warnings_.add("metals under a coat are written as glTF's, without refraction in the coat");
    if (!m.is_reflectance)
      warnings_.add("metals are written by their reflectance at normal incidence");
    return out;
  }
  if (m.kind == MaterialKind::coated_diffuse)
    warnings_.add("coats over diffuse bases are written as glTF's, which differ slightly");
  out["extensions"]["KHR_materials_ior"] = {{"ior", m.ior >= 1 || m.ior == 0 ? m.ior : 1.5f}};
  if (m.kind == MaterialKind::metallic_roughness) add_diffuse_transmission(m, out);
  add_specular(m, out);
  add_glass(m, out);
  return out;
}

void GltfMaterialWriter::add_emission(const Light& light, Rgb radiance, Json& out) {
  double strength = double(max_component(radiance)) * unit_;
  Rgb color = radiance / std::max(max_component(radiance), 1e-30f);
  if (const auto look = look_of_all(std::array{light.texture})) {
    const BakedImage image = baked_color(scene_, {Rgb{1}, light.texture}, *look, nullptr);
    strength *= double(image.scale);
    out["emissiveTexture"] = texture(fmt::format("emission {}", light.texture), *look,
                                     [&](const Texture&) { return image; });
  }
  out["emissiveFactor"] = list(color);
  out["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strength}};
  if (light.is_two_sided) out["doubleSided"] = true;
}

// Returns the texture of a lightmap page. Its texels must not blend with a neighbour across an
// edge, nor in smaller copies.
size_t GltfMaterialWriter::page_texture(int32_t page) {
  const std::string key = fmt::format("baked {}", page);
  const auto found = texture_by_key_.find(key);
  if (found != texture_by_key_.end()) return found->second;
  Texture look;
  look.wrap_u = look.wrap_v = WrapMode::clamp;
  return texture_by_key_[key] =
             add_texture(baked_->pages[size_t(page)], look, fmt::format("light{}", page));
}

void GltfMaterialWriter::add_baked(const Material& m, const GltfPlace& place, Json& out) {
  Json texture;
  if (place.page >= 0) texture = {{"index", page_texture(place.page)}, {"texCoord", place.set}};
  if (baked_->shading == BakedShading::lightmap) {
    texture["intensity"] = baked_->white;
    out["extensions"]["MOZ_lightmap"] = texture;
  } else if (baked_->shading == BakedShading::emissive) {
    // Keeps the holes of the base colour's image.
    for (size_t k = 0; k < 3; ++k) out["pbrMetallicRoughness"]["baseColorFactor"][k] = 0;
    out["pbrMetallicRoughness"]["metallicFactor"] = 0;
    out["pbrMetallicRoughness"].erase("metallicRoughnessTexture");
    out["extensions"] = Json{{"KHR_materials_emissive_strength", {{"emissiveStrength", 1}}},
                             {"KHR_materials_specular", {{"specularFactor", 0}}}};
    out["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = baked_->white;
    out["emissiveFactor"] = {1, 1, 1};
    out["emissiveTexture"] = texture;
  } else {
    out["extensions"] = Json{{"KHR_materials_unlit", Json::object()}};
    out.erase("normalTexture");
    Json& pbr = out["pbrMetallicRoughness"];
    pbr["metallicFactor"] = 0;
    pbr["roughnessFactor"] = 1;
    pbr.erase("metallicRoughnessTexture");
    if (baked_->shading == BakedShading::unlit) {
      pbr["baseColorFactor"] = {1, 1, 1, 1};  // the page contains alpha as well
      pbr["baseColorTexture"] = texture;
    }
  }
  out["doubleSided"] = m.back_faces != BackFaces::unseen;
}

size_t GltfMaterialWriter::index_of(uint32_t material, const Light* light, Rgb radiance,
                                    const GltfPlace& place) {
  std::string emission;
  if (light)
    emission = fmt::format("{} {} {} {} {}", radiance.r, radiance.g, radiance.b, light->texture,
                           light->is_two_sided);
  if (place.is_baked())
    emission += fmt::format("baked {} {} {}", place.page, place.set, place.has_light_colors);
  emission += fmt::format(" colours {}", place.vertex_colors);
  const auto key = std::pair{material, emission};
  const auto found = made_.find(key);
  if (found != made_.end()) return found->second;
  material_ = material;
  Material m = scene_.materials[material];
  if (place.vertex_colors != no_texture) m = without_vertex_colors(scene_, m, place.vertex_colors);
  Json out = surface(m);
  if (light)
    add_emission(*light, radiance, out);
  else
    out["doubleSided"] = m.back_faces != BackFaces::unseen;
  if (place.is_baked()) add_baked(m, place, out);
  tell_what_is_left_out(scene_, m, true, warnings_);
  materials_.push_back(std::move(out));
  return made_[key] = materials_.size() - 1;
}

void GltfMaterialWriter::finish(Json& file) const {
  for (const auto& [name, rows] : {std::pair<const char*, const Json&>{"materials", materials_},
                                   {"textures", textures_},
                                   {"images", images_},
                                   {"samplers", samplers_}})
    if (!rows.empty()) file[name] = rows;
}

}  // namespace troffer
