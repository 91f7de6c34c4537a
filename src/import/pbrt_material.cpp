#include "import/pbrt_material.h"

#include <cmath>

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

uint32_t PbrtMaterials::index_with_alpha(PbrtMaterial& material, const FloatInput& alpha) {
  const std::pair key{alpha.texture, alpha.value};
  const auto found = material.with_alpha.find(key);
  if (found != material.with_alpha.end()) return found->second;
  Material masked = scene_.materials[index_of(material)];
  masked.is_alpha_masked = true;
  masked.alpha = alpha;
  masked.alpha_cutoff = 0.5f;
  const auto index = uint32_t(scene_.materials.size());
  scene_.materials.push_back(std::move(masked));
  material.with_alpha[key] = index;
  return index;
}

void PbrtMaterials::read_roughness(const PbrtParams& params, Material& m) {
  const FloatInput both = textures.real(params, "roughness", 0);
  const bool has_both = params.has("roughness");
  const auto along = [&](const char* name) {
    return params.has(name) || !has_both ? textures.real(params, name, 0) : both;
  };
  const FloatInput u = along("uroughness"), v = along("vroughness");
  m.roughness = u;
  if (u.texture != v.texture || u.value != v.value) {
    m.roughness.value = std::sqrt(std::max(u.value, 0.0f) * std::max(v.value, 0.0f));
    if (u.texture < 0) m.roughness.texture = v.texture;
    scene_.warnings.add(params.owner +
                        ": different roughness along u and v is shown as their geometric mean");
  }
  if (m.roughness.value < 0) {
    scene_.warnings.add(params.owner + ": negative roughness is set to 0");
    m.roughness.value = 0;
  }
  m.roughness_meaning = params.get_bool("remaproughness", true) ? RoughnessMeaning::alpha_is_sqrt
                                                                : RoughnessMeaning::alpha;
}

float PbrtMaterials::read_ior(const PbrtParams& params) {
  const PbrtParam* eta = params.find("eta");
  return eta ? ior_value(*eta, textures.spectrum_context()) : 1.5f;
}

void PbrtMaterials::read_conductor(const PbrtParams& params, Material& m) {
  m.kind = MaterialKind::conductor;
  read_roughness(params, m);
  if (params.has("reflectance")) {
    m.is_reflectance = true;
    m.base_color = textures.color(params, "reflectance", Rgb{1});
    return;
  }
  const PbrtParam* eta = params.find("eta");
  const PbrtParam* k = params.find("k");
  m.eta = eta ? conductor_value(*eta, textures.spectrum_context()) : *named_metal("metal-Cu-eta");
  m.k = k ? conductor_value(*k, textures.spectrum_context()) : *named_metal("metal-Cu-k");
}

Material PbrtMaterials::make(const PbrtMaterial& material) {
  const PbrtParams& params = material.params;
  const std::string& type = material.type;
  Material m;
  m.name = material.name;
  params.ignore({"type"});
  if (type == "diffuse") {
    m.kind = MaterialKind::diffuse;
    m.base_color = textures.color(params, "reflectance", Rgb{0.5f});
  } else if (type == "coateddiffuse") {
    m.kind = MaterialKind::coated_diffuse;
    m.base_color = textures.color(params, "reflectance", Rgb{0.5f});
    read_roughness(params, m);
    m.ior = read_ior(params);
    // How pbrt walks within the coat, and a medium in it.
    params.ignore({"thickness", "albedo", "g", "maxdepth", "nsamples"});
  } else if (type == "conductor") {
    read_conductor(params, m);
  } else if (type == "dielectric" || type == "thindielectric") {
    m.kind = MaterialKind::dielectric;
    m.base_color = {Rgb{1}, no_texture};
    m.is_thin = type == "thindielectric";
    if (!m.is_thin) read_roughness(params, m);
    m.ior = read_ior(params);
  } else {
    scene_.warnings.add("material \"" + type + "\" is not supported: shown as diffuse");
    m.base_color = textures.color(params, "reflectance", Rgb{0.5f});
    params.ignore_all();
  }
  if (params.has("displacement"))
    scene_.warnings.add("displacement of materials is not supported: ignored");
  const std::string normal_map = params.get_string("normalmap", "");
  if (!normal_map.empty()) m.normal_texture = textures.image(normal_map, false);
  params.warn_unread(scene_.warnings);
  return m;
}

bool is_textured(const Material& m) {
  return has_textured_input(m) || m.normal_texture >= 0 ||
         (m.is_alpha_masked && m.alpha.texture >= 0);
}

}  // namespace troffer
