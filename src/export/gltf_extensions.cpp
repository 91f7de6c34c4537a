// Writes the material extensions of glTF.
#include <fmt/format.h>

#include <cmath>

#include "export/gltf_materials.h"

namespace troffer {

namespace {

using Json = GltfMaterialWriter::Json;

Json json_list(Rgb c) {
  return {c.r, c.g, c.b};
}

}  // namespace

void GltfMaterialWriter::add_number(const FloatInput& input, float power, const std::string& name,
                                    bool is_alpha, Json& extension) {
  const auto look = look_of_all(std::array{input.texture});
  if (!look) {
    const float value = std::clamp(evaluate(scene_.textures, input, Vec2{0, 0}), 0.0f, 1.0f);
    extension[name + "Factor"] = power == 1 ? value : std::pow(value, power);
    return;
  }
  // Keeps the value as a factor if glTF allows it.
  const bool is_factor = power == 1 && input.value <= 1;
  const FloatInput baked{is_factor ? 1 : input.value, input.texture, input.channel};
  const std::string key = fmt::format("number {} {} {} {} {}", baked.texture, baked.channel,
                                      baked.value, power, is_alpha);
  extension[name + "Factor"] = is_factor ? input.value : 1;
  extension[name + "Texture"] = texture(key, *look, [&](const Texture& t) {
    const BakedImage number = baked_number(scene_, baked, t, power);
    return is_alpha ? as_alpha(number) : number;
  });
}

void GltfMaterialWriter::add_color(const ColorInput& input, const std::string& name,
                                   Json& extension) {
  const auto look = look_of_all(std::array{input.texture});
  if (!look) {
    extension[name + "Factor"] = json_list(evaluate(scene_.textures, input, Vec2{0, 0}));
    return;
  }
  extension[name + "Factor"] = json_list(input.value);
  extension[name + "Texture"] =
      texture(fmt::format("color {} 1 1 1", input.texture), *look, [&](const Texture& t) {
        return baked_color(scene_, {Rgb{1}, input.texture}, t, nullptr);
      });
}

void GltfMaterialWriter::add_glass(const Material& m, Json& out) {
  const bool is_glass = m.kind == MaterialKind::dielectric;
  if (!is_glass && m.transmission.value <= 0) return;
  Json transmission = Json::object();
  add_number(is_glass ? FloatInput{1, no_texture, 0} : m.transmission, 1, "transmission", false,
             transmission);
  out["extensions"]["KHR_materials_transmission"] = transmission;
  if (m.is_thin) {
    if (!m.absorption.is_black()) warnings_.add("absorption in sheets of glass is not written");
    return;
  }
  Json& volume = out["extensions"]["KHR_materials_volume"];
  volume["thicknessFactor"] = 1;
  if (m.absorption.is_black()) return;
  // Colour at the distance where the most absorbed channel falls to 1/e.
  const float most = max_component(m.absorption);
  volume["attenuationDistance"] = 1 / most;
  volume["attenuationColor"] = {std::exp(-m.absorption.r / most), std::exp(-m.absorption.g / most),
                                std::exp(-m.absorption.b / most)};
}

void GltfMaterialWriter::add_specular(const Material& m, Json& out) {
  const bool is_mixed = m.kind == MaterialKind::metallic_roughness;
  const bool is_colored = m.specular_color.texture >= 0 || m.specular_color.value != Rgb{1};
  if (!is_mixed && is_colored)
    warnings_.add(
        "factors on the reflection of coats and glass are written as glTF's, which work "
        "differently");
  if (m.specular.value == 1 && m.specular.texture < 0 && !is_colored) return;
  Json specular = Json::object();
  add_number(m.specular, 1, "specular", true, specular);
  add_color(m.specular_color, "specularColor", specular);
  out["extensions"]["KHR_materials_specular"] = specular;
}

void GltfMaterialWriter::add_cloth_and_grain(const Material& m, Json& out) {
  if (!m.sheen_color.value.is_black()) {
    Json sheen = Json::object();
    add_color(m.sheen_color, "sheenColor", sheen);
    add_number(m.sheen_roughness, 1, "sheenRoughness", true, sheen);
    out["extensions"]["KHR_materials_sheen"] = sheen;
  }
  if (m.anisotropy.value <= 0) return;
  Json grain{{"anisotropyStrength", m.anisotropy.value},
             {"anisotropyRotation", m.anisotropy_rotation_rad}};
  if (const auto look = look_of_all(std::array{m.anisotropy.texture}))
    grain["anisotropyTexture"] = texture(
        fmt::format("raw {}", m.anisotropy.texture), *look,
        [&](const Texture& t) { return baked_raw(scene_, uint32_t(m.anisotropy.texture), t); });
  out["extensions"]["KHR_materials_anisotropy"] = grain;
}

void GltfMaterialWriter::add_clear_coat(const Material& m, Json& out) {
  if (m.coat.value <= 0 || m.kind == MaterialKind::diffuse) return;
  if (m.kind == MaterialKind::coated_diffuse || std::abs(m.coat_ior - 1.5f) > 0.01f)
    warnings_.add("clear coats are written with glTF's index of refraction, 1.5");
  // glTF's roughness is the square root of the GGX width.
  const float power = m.roughness_meaning == RoughnessMeaning::alpha           ? 0.5f
                      : m.roughness_meaning == RoughnessMeaning::alpha_is_sqrt ? 0.25f
                                                                               : 1;
  Json coat = Json::object();
  add_number(m.coat, 1, "clearcoat", false, coat);
  add_number(m.coat_roughness, power, "clearcoatRoughness", false, coat);
  const bool leans = !m.has_coat_normal && m.normal_texture >= 0;
  add_normal(leans ? m.normal_texture : m.coat_normal_texture,
             leans ? m.normal_scale : m.coat_normal_scale, "clearcoatNormalTexture", coat);
  out["extensions"]["KHR_materials_clearcoat"] = coat;
}

void GltfMaterialWriter::add_film(const Material& m, Json& out) {
  if (m.iridescence.value <= 0 || m.kind != MaterialKind::metallic_roughness) return;
  Json film = Json::object();
  add_number(m.iridescence, 1, "iridescence", false, film);
  film["iridescenceIor"] = m.film_ior;
  film["iridescenceThicknessMinimum"] = m.film_thinnest_nm;
  film["iridescenceThicknessMaximum"] = m.film_thickest_nm;
  Json thickness = Json::object();
  add_number(m.film_thickness, 1, "iridescenceThickness", false, thickness);
  const float most = lerp(m.film_thinnest_nm, m.film_thickest_nm,
                          thickness["iridescenceThicknessFactor"].get<float>());
  film["iridescenceThicknessMaximum"] = most;
  if (thickness.contains("iridescenceThicknessTexture"))
    film["iridescenceThicknessTexture"] = thickness["iridescenceThicknessTexture"];
  out["extensions"]["KHR_materials_iridescence"] = film;
}

// glTF's base reflects only the light that is not transmitted, while a diffuse material states
// reflection and transmission separately. Its base colour is therefore divided by the share of
// light that glTF leaves to the base.
void GltfMaterialWriter::add_diffuse_transmission(const Material& m, Json& out) {
  if (m.diffuse_transmission.value <= 0) return;
  Json passing = Json::object();
  if (m.kind != MaterialKind::diffuse) {
    add_number(m.diffuse_transmission, 1, "diffuseTransmission", true, passing);
    add_color(m.diffuse_transmission_color, "diffuseTransmissionColor", passing);
    out["extensions"]["KHR_materials_diffuse_transmission"] = passing;
    return;
  }
  if (m.diffuse_transmission.texture >= 0)
    warnings_.add("transmission textures are written as one value");
  const float share =
      std::clamp(evaluate(scene_.textures, m.diffuse_transmission, Vec2{0, 0}), 0.0f, 1.0f);
  const float back = max_component(clamp01(m.base_color.value));
  const float most = share * max_component(m.diffuse_transmission_color.value);
  if (!(most > 0)) return;
  const float factor = most / std::max(most + back, 1.0f);
  ColorInput color = m.diffuse_transmission_color;
  color.value = clamp01(color.value * (share / factor));
  Json& pbr = out["pbrMetallicRoughness"];
  for (size_t k = 0; k < 3 && factor < 1; ++k)
    pbr["baseColorFactor"][k] =
        std::min(pbr["baseColorFactor"][k].get<float>() / (1 - factor), 1.0f);
  passing["diffuseTransmissionFactor"] = factor;
  add_color(color, "diffuseTransmissionColor", passing);
  out["extensions"]["KHR_materials_diffuse_transmission"] = passing;
}

}  // namespace troffer
