#include "export/gltf_materials.h"

#include <fmt/format.h>

#include <cmath>

#include "base/coat.h"

namespace troffer {

namespace {

using Json = GltfMaterialWriter::Json;

Json list(Rgb c) {
  return {c.r, c.g, c.b};
}

int wrap_code(WrapMode mode) {
  return mode == WrapMode::repeat ? 10497 : mode == WrapMode::mirror ? 33648 : 33071;
}

// glTF's roughness is the root of the width of ggx.
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

Json GltfMaterialWriter::reference(size_t texture, const Texture& look) const {
  Json out{{"index", texture}};
  if (look.mapping == TextureMapping::second_uv) out["texCoord"] = 1;
  Json t = Json::object();
  if (look.uv_scale.x != 1 || look.uv_scale.y != 1) t["scale"] = {look.uv_scale.x, look.uv_scale.y};
  if (look.uv_offset.x != 0 || look.uv_offset.y != 0)
    t["offset"] = {look.uv_offset.x, look.uv_offset.y};
  if (look.uv_rotation_rad != 0) t["rotation"] = look.uv_rotation_rad;
  if (!t.empty()) out["extensions"]["KHR_texture_transform"] = t;
  return out;
}

size_t GltfMaterialWriter::texture(const std::string& key, const BakedImage& image,
                                   const Texture& look) {
  const auto found = texture_by_key_.find(key);
  if (found != texture_by_key_.end()) return found->second;
  images_.push_back({{"bufferView", buffer_.add_view(png_of(image))}, {"mimeType", "image/png"}});
  const int filter = look.is_filtered ? 9729 : 9728;
  samplers_.push_back({{"magFilter", filter},
                       {"minFilter", filter},
                       {"wrapS", wrap_code(look.wrap_u)},
                       {"wrapT", wrap_code(look.wrap_v)}});
  textures_.push_back({{"source", images_.size() - 1}, {"sampler", samplers_.size() - 1}});
  return texture_by_key_[key] = textures_.size() - 1;
}

// Base colour, and with it alpha.
void GltfMaterialWriter::add_base(const Material& m, Json& out) {
  // All that `out` gets itself before a reference into it is held: it moves what it has.
  out["pbrMetallicRoughness"] = Json();
  if (m.is_alpha_masked) {
    out["alphaMode"] = "MASK";
    out["alphaCutoff"] = m.alpha_cutoff;
  }
  Json& pbr = out["pbrMetallicRoughness"];
  ColorInput base = m.base_color;
  if (m.kind == MaterialKind::conductor && !m.is_reflectance)
    base = {normal_reflectance(m) * m.specular_color.value, m.specular_color.texture};
  const Texture* look = image_of(scene_, base.texture);
  const Texture* alpha = m.is_alpha_masked ? image_of(scene_, m.alpha.texture) : nullptr;
  ColorChange change;
  if (m.kind == MaterialKind::coated_diffuse)
    change = [f = mean_reflectance_inside(double(m.ior))](float v) {
      return as_of_white_base(v, f);
    };
  float factor = 1;
  if (m.is_alpha_masked) {
    const bool is_same = alpha && alpha == look && m.alpha.channel == 3;
    factor = alpha ? m.alpha.value : evaluate(scene_.textures, m.alpha, Vec2{0, 0});
    if (alpha && !is_same) {
      // Numbers that cut holes become the alpha of the colour's image, by the holes' own (u,v).
      BakedImage colors = baked_color(scene_, {base.value, no_texture}, true, change);
      const BakedImage holes = baked_number(scene_, {1, m.alpha.texture, m.alpha.channel}, 1);
      if (look) warnings_.add("colours under alpha masks of another image are written even");
      const std::vector<float> one = colors.texels_float;
      colors.width = holes.width;
      colors.height = holes.height;
      colors.texels_float.clear();
      for (const float a : holes.texels_float)
        colors.texels_float.insert(colors.texels_float.end(), {one[0], one[1], one[2], a});
      const std::string key =
          fmt::format("holes {} {} {}", m.alpha.texture, m.alpha.channel, m.name);
      pbr["baseColorTexture"] = reference(texture(key, colors, *alpha), *alpha);
      pbr["baseColorFactor"] = {1, 1, 1, std::min(factor, 1.0f)};
      return;
    }
  }
  const Rgb even = look ? Rgb{1} : clamp01(color_at(scene_, base, {0, 0}, change));
  pbr["baseColorFactor"] = {even.r, even.g, even.b, std::clamp(factor, 0.0f, 1.0f)};
  if (!look) return;
  const Rgb v = base.value;
  const std::string key = fmt::format("color {} {} {} {} {} {}", base.texture, v.r, v.g, v.b,
                                      alpha != nullptr, change ? change(0.5f) : 0.0f);
  pbr["baseColorTexture"] =
      reference(texture(key, baked_color(scene_, base, alpha != nullptr, change), *look), *look);
}

void GltfMaterialWriter::add_roughness(const Material& m, Json& pbr) {
  const bool is_mixed = m.kind == MaterialKind::metallic_roughness;
  const float power = power_for_gltf(m.roughness_meaning);
  FloatInput rough = m.roughness;
  // Straight on, light that leaves a coat in which it bends spreads by its index.
  if (m.kind == MaterialKind::conductor && m.coat.value > 0)
    rough.value *= std::pow(m.coat_ior, power > 0 ? 0.5f / power : 1.0f);
  FloatInput metal = is_mixed ? m.metallic : FloatInput{0, no_texture, 0};
  if (m.kind == MaterialKind::conductor) metal.value = 1;
  const Texture* rough_image = image_of(scene_, m.roughness.texture);
  const Texture* metal_image = image_of(scene_, metal.texture);
  const Texture* look = rough_image ? rough_image : metal_image;
  if (look) {
    const std::string key =
        fmt::format("rough {} {} {} {} metal {} {} {}", m.roughness.texture, m.roughness.channel,
                    m.roughness.value, power, metal.texture, metal.channel, metal.value);
    pbr["metallicRoughnessTexture"] =
        reference(texture(key, baked_pair(scene_, m.roughness, power, metal), *look), *look);
    return;
  }
  pbr["roughnessFactor"] =
      std::pow(std::clamp(evaluate(scene_.textures, m.roughness, Vec2{0, 0}), 0.0f, 1.0f), power);
  pbr["metallicFactor"] = std::clamp(evaluate(scene_.textures, metal, Vec2{0, 0}), 0.0f, 1.0f);
}

void GltfMaterialWriter::add_glass(const Material& m, Json& out) {
  const bool is_glass = m.kind == MaterialKind::dielectric;
  const float share = is_glass ? 1 : m.transmission.value;
  if (share <= 0) return;
  if (!is_glass && m.transmission.texture >= 0)
    warnings_.add("textures of transmission are written as one value");
  out["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", share}};
  if (m.is_thin) {
    if (!m.absorption.is_black()) warnings_.add("what sheets of glass absorb is not written");
    return;
  }
  Json& volume = out["extensions"]["KHR_materials_volume"];
  volume["thicknessFactor"] = 1;
  if (m.absorption.is_black()) return;
  // What is left after the way on which the strongest colour falls to 1/e.
  const float most = max_component(m.absorption);
  volume["attenuationDistance"] = 1 / most;
  volume["attenuationColor"] = {std::exp(-m.absorption.r / most), std::exp(-m.absorption.g / most),
                                std::exp(-m.absorption.b / most)};
}

// Sheen and grain, where they are even.
void GltfMaterialWriter::add_cloth_and_grain(const Material& m, Json& out) {
  if (m.sheen_color.texture >= 0 || m.sheen_roughness.texture >= 0 || m.anisotropy.texture >= 0)
    warnings_.add("textures of sheen and of gloss with a grain are written as one value");
  if (!m.sheen_color.value.is_black())
    out["extensions"]["KHR_materials_sheen"] = {{"sheenColorFactor", list(m.sheen_color.value)},
                                                {"sheenRoughnessFactor", m.sheen_roughness.value}};
  if (m.anisotropy.value > 0)
    out["extensions"]["KHR_materials_anisotropy"] = {
        {"anisotropyStrength", m.anisotropy.value},
        {"anisotropyRotation", m.anisotropy_rotation_rad}};
}

// Factor and texture; an image of one number holds it in every channel.
void GltfMaterialWriter::add_number(const FloatInput& input, float power, const std::string& name,
                                    Json& extension) {
  const Texture* look = image_of(scene_, input.texture);
  if (!look) {
    const float value = std::clamp(evaluate(scene_.textures, input, Vec2{0, 0}), 0.0f, 1.0f);
    extension[name + "Factor"] = std::pow(value, power);
    return;
  }
  const std::string key =
      fmt::format("number {} {} {} {}", input.texture, input.channel, input.value, power);
  extension[name + "Factor"] = 1;
  extension[name + "Texture"] =
      reference(texture(key, baked_number(scene_, input, power), *look), *look);
}

void GltfMaterialWriter::add_clear_coat(const Material& m, Json& out) {
  if (m.coat.value <= 0 || m.kind == MaterialKind::diffuse) return;
  if (m.kind == MaterialKind::coated_diffuse || std::abs(m.coat_ior - 1.5f) > 0.01f)
    warnings_.add("clear coats are written as glTF's, of index 1.5");
  Json coat = Json::object();
  add_number(m.coat, 1, "clearcoat", coat);
  add_number(m.coat_roughness, power_for_gltf(m.roughness_meaning), "clearcoatRoughness", coat);
  const bool leans = !m.has_coat_normal && m.normal_texture >= 0;
  const int32_t normal = leans ? m.normal_texture : m.coat_normal_texture;
  if (const Texture* look = image_of(scene_, normal)) {
    const std::string key = fmt::format("raw {}", normal);
    coat["clearcoatNormalTexture"] =
        reference(texture(key, baked_raw(scene_, uint32_t(normal)), *look), *look);
    const float scale = leans ? m.normal_scale : m.coat_normal_scale;
    if (scale != 1) coat["clearcoatNormalTexture"]["scale"] = scale;
  }
  out["extensions"]["KHR_materials_clearcoat"] = coat;
}

void GltfMaterialWriter::add_film(const Material& m, Json& out) {
  if (m.iridescence.value <= 0 || m.kind != MaterialKind::metallic_roughness) return;
  Json film = Json::object();
  add_number(m.iridescence, 1, "iridescence", film);
  film["iridescenceIor"] = m.film_ior;
  film["iridescenceThicknessMinimum"] = m.film_thinnest_nm;
  film["iridescenceThicknessMaximum"] = m.film_thickest_nm;
  Json thickness = Json::object();
  add_number(m.film_thickness, 1, "iridescenceThickness", thickness);
  if (thickness.contains("iridescenceThicknessTexture"))
    film["iridescenceThicknessTexture"] = thickness["iridescenceThicknessTexture"];
  else
    film["iridescenceThicknessMaximum"] =
        lerp(m.film_thinnest_nm, m.film_thickest_nm,
             thickness["iridescenceThicknessFactor"].get<float>());
  out["extensions"]["KHR_materials_iridescence"] = film;
}

// KHR_materials_diffuse_transmission: the base is what does not come through.
void GltfMaterialWriter::add_diffuse_transmission(const Material& m, Json& out) {
  if (m.diffuse_transmission.value <= 0) return;
  if (m.diffuse_transmission.texture >= 0 || m.diffuse_transmission_color.texture >= 0)
    warnings_.add("textures of diffuse transmission are written as one value");
  const float share =
      std::clamp(evaluate(scene_.textures, m.diffuse_transmission, Vec2{0, 0}), 0.0f, 1.0f);
  Rgb color = clamp01(evaluate(scene_.textures, m.diffuse_transmission_color, Vec2{0, 0}));
  float factor = share;
  if (m.kind == MaterialKind::diffuse) {
    const float back = max_component(clamp01(evaluate(scene_.textures, m.base_color, Vec2{0, 0})));
    const float most = share * max_component(color);
    if (!(most > 0)) return;
    factor = most / std::max(most + back, 1.0f);
    color = clamp01(color * (share / factor));
    Json& pbr = out["pbrMetallicRoughness"];
    if (pbr.contains("baseColorTexture"))
      warnings_.add("textures of what lets light through are written darker than they are");
    for (size_t k = 0; k < 3 && factor < 1; ++k)
      pbr["baseColorFactor"][k] =
          std::min(pbr["baseColorFactor"][k].get<float>() / (1 - factor), 1.0f);
  }
  out["extensions"]["KHR_materials_diffuse_transmission"] = {
      {"diffuseTransmissionFactor", factor}, {"diffuseTransmissionColorFactor", list(color)}};
}

Json GltfMaterialWriter::surface(const Material& m) {
  Json out;
  if (!m.name.empty()) out["name"] = m.name;
  add_base(m, out);
  if (m.normal_texture >= 0) {
    const Texture* look = image_of(scene_, m.normal_texture);
    if (look) {
      const std::string key = fmt::format("raw {}", m.normal_texture);
      out["normalTexture"] =
          reference(texture(key, baked_raw(scene_, uint32_t(m.normal_texture)), *look), *look);
      if (m.normal_scale != 1) out["normalTexture"]["scale"] = m.normal_scale;
    }
  }
  Json& pbr = out["pbrMetallicRoughness"];
  if (m.kind == MaterialKind::diffuse) {  // without specular reflection: Lambert's model
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
      warnings_.add("metals under a coat are written as glTF's, into which light does not bend");
    if (!m.is_reflectance)
      warnings_.add("metals are written by their reflectance at normal incidence");
    return out;
  }
  if (m.kind == MaterialKind::coated_diffuse)
    warnings_.add("coats over diffuse bases are written as glTF's, which differ a little");
  out["extensions"]["KHR_materials_ior"] = {{"ior", m.ior >= 1 || m.ior == 0 ? m.ior : 1.5f}};
  const bool is_mixed = m.kind == MaterialKind::metallic_roughness;
  if (is_mixed) add_diffuse_transmission(m, out);
  if (!is_mixed && (m.specular_color.texture >= 0 || m.specular_color.value != Rgb{1}))
    warnings_.add("factors on what coats and glass reflect are written as glTF's, which differ");
  if (m.specular.texture >= 0 || m.specular_color.texture >= 0)
    warnings_.add("textures of specular reflection are written as one value");
  if (m.specular.value != 1 || m.specular_color.value != Rgb{1} || m.specular.texture >= 0)
    out["extensions"]["KHR_materials_specular"] = {
        {"specularFactor", m.specular.value},
        {"specularColorFactor", list(m.specular_color.value)}};
  add_glass(m, out);
  return out;
}

void GltfMaterialWriter::add_emission(const Light& light, Rgb radiance, Json& out) {
  const Texture* look = image_of(scene_, light.texture);
  double strength = double(max_component(radiance)) * unit_;
  Rgb color = radiance / std::max(max_component(radiance), 1e-30f);
  if (look) {
    const BakedImage image = baked_color(scene_, {color, light.texture}, false);
    strength *= double(image.scale);
    const std::string key =
        fmt::format("emission {} {} {} {}", light.texture, color.r, color.g, color.b);
    out["emissiveTexture"] = reference(texture(key, image, *look), *look);
    color = Rgb{1};
  }
  out["emissiveFactor"] = list(color);
  out["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strength}};
  if (light.is_two_sided) out["doubleSided"] = true;
}

// Texels of lightmaps stand for themselves alone: no neighbour across an edge, no smaller copies.
size_t GltfMaterialWriter::page_texture(int32_t page) {
  const std::string key = fmt::format("baked {}", page);
  const auto found = texture_by_key_.find(key);
  if (found != texture_by_key_.end()) return found->second;
  images_.push_back({{"bufferView", buffer_.add_view(baked_->pages[size_t(page)])},
                     {"mimeType", "image/png"},
                     {"name", fmt::format("light{}", page)}});
  samplers_.push_back(
      {{"magFilter", 9729}, {"minFilter", 9729}, {"wrapS", 33071}, {"wrapT", 33071}});
  textures_.push_back({{"source", images_.size() - 1}, {"sampler", samplers_.size() - 1}});
  return texture_by_key_[key] = textures_.size() - 1;
}

void GltfMaterialWriter::add_baked(const Material& m, const BakedPlace& place, Json& out) {
  Json texture;
  if (place.page >= 0) texture = {{"index", page_texture(place.page)}, {"texCoord", place.set}};
  if (baked_->shading == BakedShading::lightmap) {
    texture["intensity"] = baked_->white;
    out["extensions"]["MOZ_lightmap"] = texture;
  } else if (baked_->shading == BakedShading::emissive) {
    // Holes stay where the base colour's image has them.
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
      pbr["baseColorFactor"] = {1, 1, 1, 1};  // alpha too is in the page
      pbr["baseColorTexture"] = texture;
    }
  }
  out["doubleSided"] = m.back_faces != BackFaces::unseen;
}

size_t GltfMaterialWriter::index_of(uint32_t material, const Light* light, Rgb radiance,
                                    const BakedPlace& place) {
  std::string emission;
  if (light)
    emission = fmt::format("{} {} {} {} {}", radiance.r, radiance.g, radiance.b, light->texture,
                           light->is_two_sided);
  if (place.is_baked())
    emission += fmt::format("baked {} {} {}", place.page, place.set, place.has_colors);
  const auto key = std::pair{material, emission};
  const auto found = made_.find(key);
  if (found != made_.end()) return found->second;
  const Material& m = scene_.materials[material];
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
