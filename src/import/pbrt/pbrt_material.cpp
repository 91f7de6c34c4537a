#include "import/pbrt/pbrt_material.h"

#include <algorithm>
#include <cmath>

#include "import/absorption.h"
#include "import/anisotropic_roughness.h"
#include "import/blend_materials.h"
#include "import/measured_bsdf.h"
#include "import/spectra.h"

namespace troffer {

uint32_t PbrtMaterials::index_of(PbrtMaterial& material) {
  if (material.index < 0) {
    Material made = make(material);
    material.index = int32_t(scene_.materials.size());
    scene_.materials.push_back(std::move(made));
  }
  return uint32_t(material.index);
}

uint32_t PbrtMaterials::index_of_copy(PbrtMaterial& material,
                                      const std::optional<FloatInput>& alpha, Rgb absorption) {
  uint32_t plain = index_of(material);
  const bool is_glass = scene_.materials[plain].kind == MaterialKind::dielectric;
  if (!absorption.is_black() && (!is_glass || scene_.materials[plain].is_thin)) {
    scene_.warnings.add("MediumInterface: media inside anything but \"dielectric\" are left out");
    absorption = Rgb{0};
  }
  if (!alpha && absorption.is_black()) return plain;
  const FloatInput share = alpha.value_or(FloatInput{1, no_texture, 0});
  const std::array key{float(share.texture), share.value, absorption.r, absorption.g, absorption.b};
  const auto found = material.copies.find(key);
  if (found != material.copies.end()) return found->second;
  Material copy = scene_.materials[plain];
  copy.absorption = absorption;
  if (alpha) {
    copy.is_alpha_masked = copy.is_alpha_blended = true;
    copy.alpha = *alpha;
  }
  const auto index = uint32_t(scene_.materials.size());
  scene_.materials.push_back(std::move(copy));
  return material.copies[key] = index;
}

Rgb PbrtMaterials::read_medium(const std::string& type, const PbrtParams& params) {
  if (type != "homogeneous") {
    params.ignore_all();
    scene_.warnings.add("MakeNamedMedium: \"" + type + "\" is not supported: left out");
    return Rgb{0};
  }
  const auto color = [&](const char* name, Rgb fallback) {
    const PbrtParam* p = params.find(name);
    return p ? factor_value(*p, textures.spectrum_context()) : fallback;
  };
  // pbrt's default coefficients of a medium.
  const Rgb absorbed = color("sigma_a", Rgb{0.0011f, 0.0024f, 0.014f}),
            scattered = color("sigma_s", Rgb{2.55f, 3.21f, 3.77f});
  const auto scale = float(params.get_float("scale", 1));
  params.ignore({"type"});
  if (!scattered.is_black())
    scene_.warnings.add(
        "MakeNamedMedium: \"homogeneous\": its absorption is shown, its scattering is not");
  params.warn_unread(scene_.warnings);
  return usable_absorption(absorbed * scale);
}

void PbrtMaterials::read_roughness(const PbrtParams& params, Material& m,
                                   const std::string& prefix) {
  const FloatInput both = textures.real(params, prefix + "roughness", 0);
  const bool has_both = params.has(prefix + "roughness");
  const auto along = [&](const std::string& name) {
    return params.has(name) || !has_both ? textures.real(params, name, 0) : both;
  };
  const FloatInput u = along(prefix + "uroughness"), v = along(prefix + "vroughness");
  m.roughness = u;
  m.roughness_meaning = params.get_bool("remaproughness", true) ? RoughnessMeaning::alpha_is_sqrt
                                                                : RoughnessMeaning::alpha;
  const bool is_grained = m.kind == MaterialKind::conductor && u.texture < 0 && v.texture < 0;
  if (is_grained && u.value != v.value) {
    set_anisotropic_roughness(m, u.value, v.value);
  } else if (u.texture != v.texture || u.value != v.value) {
    m.roughness.value = std::sqrt(std::max(u.value, 0.0f) * std::max(v.value, 0.0f));
    if (u.texture < 0) m.roughness.texture = v.texture;
    scene_.warnings.add(params.owner +
                        ": different roughness along u and v is shown as their geometric mean");
  }
  if (m.roughness.value < 0) {
    scene_.warnings.add(params.owner + ": negative roughness is set to 0");
    m.roughness.value = 0;
  }
}

float PbrtMaterials::read_ior(const PbrtParams& params, const char* name) {
  const PbrtParam* eta = params.find(name);
  return eta ? ior_value(*eta, textures.spectrum_context()) : 1.5f;
}

void PbrtMaterials::read_conductor(const PbrtParams& params, Material& m,
                                   const std::string& prefix) {
  m.kind = MaterialKind::conductor;
  read_roughness(params, m, prefix);
  if (params.has("reflectance")) {
    m.is_reflectance = true;
    m.base_color = textures.color(params, "reflectance", Rgb{1});
    return;
  }
  const PbrtParam* eta = params.find(prefix + "eta");
  const PbrtParam* k = params.find(prefix + "k");
  m.eta = eta ? conductor_value(*eta, textures.spectrum_context()) : *named_metal("metal-Cu-eta");
  m.k = k ? conductor_value(*k, textures.spectrum_context()) : *named_metal("metal-Cu-k");
}

// Parameters of pbrt's random walk in the coat do not change its expected value and are ignored. A
// scattering medium in the coat does, and adds a warning.
void PbrtMaterials::warn_of_coat_medium(const PbrtParams& params) {
  params.ignore({"thickness", "g", "maxdepth", "nsamples"});
  const PbrtParam* albedo = params.find("albedo");
  const bool is_clear = !albedo || (albedo->type != PbrtType::texture &&
                                    factor_value(*albedo, textures.spectrum_context()).is_black());
  if (!is_clear) scene_.warnings.add(params.owner + ": the medium in the coat is left out");
}

Material PbrtMaterials::make_coated_conductor(const PbrtParams& params) {
  Material m;
  read_conductor(params, m, "conductor.");
  Material interface;
  read_roughness(params, interface, "interface.");
  m.coat.value = 1;
  m.coat_roughness = interface.roughness;
  m.coat_ior = read_ior(params, "interface.eta");
  warn_of_coat_medium(params);
  return m;
}

// Blends two diffuse materials exactly; otherwise returns the one with more weight, with a warning.
Material PbrtMaterials::make_mix(const PbrtMaterial& material) {
  FloatInput amount = textures.real(material.params, "amount", 0.5f);
  material.params.ignore({"materials"});
  Material first = make(*material.mixed[0]);
  const Material second = make(*material.mixed[1]);
  if (amount.texture < 0) amount.value = std::clamp(amount.value, 0.0f, 1.0f);
  if (blend_diffuse(scene_, first, second, amount)) return first;
  const float share = mean_of(scene_.textures, amount);
  if (amount.texture >= 0 || (share > 0 && share < 1))
    scene_.warnings.add("material \"mix\": only the one with the larger weight is shown");
  return share < 0.5f ? first : second;
}

// Approximates subsurface scattering by a diffuse albedo under a smooth or rough boundary.
Material PbrtMaterials::make_subsurface(const PbrtParams& params) {
  Material m;
  m.kind = MaterialKind::coated_diffuse;
  m.base_color = textures.color(params, "reflectance", Rgb{0.5f});
  read_roughness(params, m);
  const PbrtParam* eta = params.find("eta");
  m.ior = eta ? ior_value(*eta, textures.spectrum_context()) : 1.33f;
  params.ignore({"mfp", "sigma_a", "sigma_s", "scale", "g", "name"});
  scene_.warnings.add(
      "material \"subsurface\": light leaves where it enters: shown as \"coateddiffuse\"" +
      std::string(params.has("reflectance") ? "" : ", grey"));
  return m;
}

// Reads displacement (metres) as a bump map, as pbrt does. Constant heights have no effect.
void PbrtMaterials::read_bump(const PbrtParams& params, Material& m) {
  const FloatInput height = textures.real(params, "displacement", 0);
  if (height.texture >= 0) m.bump = height;
}

Material PbrtMaterials::make(const PbrtMaterial& material) {
  const PbrtParams& params = material.params;
  const std::string& type = material.type;
  Material m;
  params.ignore({"type"});
  if (type == "diffuse") {
    m.kind = MaterialKind::diffuse;
    m.base_color = textures.color(params, "reflectance", Rgb{0.5f});
  } else if (type == "coateddiffuse") {
    m.kind = MaterialKind::coated_diffuse;
    m.base_color = textures.color(params, "reflectance", Rgb{0.5f});
    read_roughness(params, m);
    m.ior = read_ior(params, "eta");
    warn_of_coat_medium(params);
  } else if (type == "conductor") {
    read_conductor(params, m);
  } else if (type == "dielectric" || type == "thindielectric") {
    m.kind = MaterialKind::dielectric;
    m.base_color = {Rgb{1}, no_texture};
    m.is_thin = type == "thindielectric";
    if (!m.is_thin) read_roughness(params, m);
    m.ior = read_ior(params, "eta");
  } else if (type == "coatedconductor") {
    m = make_coated_conductor(params);
  } else if (type == "mix") {
    m = make_mix(material);
  } else if (type == "subsurface") {
    m = make_subsurface(params);
  } else if (type == "measured") {
    m = measured_material(textures.folder(), params.get_string("filename", ""), scene_.warnings);
  } else if (type == "diffusetransmission") {
    const auto scale = float(params.get_float("scale", 1));
    m.base_color = textures.color(params, "reflectance", Rgb{0.25f});
    m.diffuse_transmission_color = textures.color(params, "transmittance", Rgb{0.25f});
    m.base_color.value *= scale;
    m.diffuse_transmission_color.value *= scale;
    m.diffuse_transmission.value = m.diffuse_transmission_color.value.is_black() ? 0.0f : 1.0f;
  } else {
    scene_.warnings.add("material \"" + type + "\" is not supported: shown as diffuse");
    m.base_color = textures.color(params, "reflectance", Rgb{0.5f});
    params.ignore_all();
  }
  m.name = material.name;
  read_bump(params, m);
  const std::string normal_map = params.get_string("normalmap", "");
  if (!normal_map.empty()) m.normal_texture = textures.image(normal_map, false);
  params.warn_unread(scene_.warnings);
  return m;
}

uint32_t PbrtMaterials::with_flipped_normal_map(uint32_t material) {
  const auto found = turned_.find(material);
  if (found != turned_.end()) return found->second;
  Material copy = scene_.materials[material];
  Texture map = scene_.textures[size_t(copy.normal_texture)];
  const auto n = size_t(map.channels);
  for (size_t i = 1; n >= 3 && i < map.texels8.size(); i += n)
    map.texels8[i] = uint8_t(255 - map.texels8[i]);
  for (size_t i = 1; n >= 3 && i < map.texels_float.size(); i += n)
    map.texels_float[i] = 1 - map.texels_float[i];
  copy.normal_texture = int32_t(scene_.textures.size());
  scene_.textures.push_back(std::move(map));
  scene_.materials.push_back(std::move(copy));
  return turned_[material] = uint32_t(scene_.materials.size() - 1);
}

bool is_textured(const Material& m) {
  return has_textured_input(m) || m.normal_texture >= 0 || m.bump.texture >= 0 ||
         m.anisotropy.value > 0 || (m.is_alpha_masked && m.alpha.texture >= 0);
}

}  // namespace troffer
