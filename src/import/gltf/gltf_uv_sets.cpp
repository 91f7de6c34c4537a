#include "import/gltf/gltf_uv_sets.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace troffer {

namespace {

constexpr uint64_t max_uv_set = 1000;

struct Place {
  const char *extension, *key;  // null: the material itself
};
// Textures of a material beside those of pbrMetallicRoughness. The first used texture decides the
// mesh's first set, so base colours come before others.
constexpr std::array<Place, 17> places{
    {{"KHR_materials_pbrSpecularGlossiness", "diffuseTexture"},
     {"KHR_materials_pbrSpecularGlossiness", "specularGlossinessTexture"},
     {nullptr, "emissiveTexture"},
     {nullptr, "normalTexture"},
     {"KHR_materials_specular", "specularTexture"},
     {"KHR_materials_specular", "specularColorTexture"},
     {"KHR_materials_transmission", "transmissionTexture"},
     {"KHR_materials_diffuse_transmission", "diffuseTransmissionTexture"},
     {"KHR_materials_diffuse_transmission", "diffuseTransmissionColorTexture"},
     {"KHR_materials_anisotropy", "anisotropyTexture"},
     {"KHR_materials_sheen", "sheenColorTexture"},
     {"KHR_materials_sheen", "sheenRoughnessTexture"},
     {"KHR_materials_clearcoat", "clearcoatTexture"},
     {"KHR_materials_clearcoat", "clearcoatRoughnessTexture"},
     {"KHR_materials_clearcoat", "clearcoatNormalTexture"},
     {"KHR_materials_iridescence", "iridescenceTexture"},
     {"KHR_materials_iridescence", "iridescenceThicknessTexture"}}};

std::optional<int> set_of(const JsonNode& object, const char* key) {
  const auto info = object.find(key);
  return info ? std::optional(gltf_uv_set(*info)) : std::nullopt;
}

}  // namespace

int gltf_uv_set(const JsonNode& info) {
  const uint64_t set = info.integer_or("texCoord", 0, max_uv_set);
  const auto transform = info.extension("KHR_texture_transform");
  return int(transform ? transform->integer_or("texCoord", set, max_uv_set) : set);
}

GltfUvSets gltf_uv_sets(const JsonNode& material, WarningLog& warnings) {
  std::vector<int> used;
  if (const auto pbr = material.find("pbrMetallicRoughness"))
    for (const char* key : {"baseColorTexture", "metallicRoughnessTexture"})
      if (const auto set = set_of(*pbr, key)) used.push_back(*set);
  for (const Place& p : places) {
    const auto owner = p.extension ? material.extension(p.extension) : std::optional(material);
    if (!owner) continue;
    if (const auto set = set_of(*owner, p.key)) used.push_back(*set);
  }
  GltfUvSets sets;
  if (used.empty()) return sets;
  sets.first = used.front();
  const auto emission = set_of(material, "emissiveTexture");
  const bool emits = emission && material.find("emissiveFactor");
  const bool has_holes = material.string_or("alphaMode", "OPAQUE") != "OPAQUE";
  if (emits && has_holes && *emission != sets.first)
    warnings.add(material.pointer() +
                 ": alpha and emission use different sets of texture coordinates; both use the "
                 "base colour's set");
  else if (emits)
    sets.first = *emission;
  for (const int set : used) {
    if (set == sets.first || set == sets.second) continue;
    if (sets.second < 0) {
      sets.second = set;
      continue;
    }
    warnings.add(
        material.pointer() +
        ": textures use more than two sets of texture coordinates; the others use the first set");
    break;
  }
  return sets;
}

}  // namespace troffer
