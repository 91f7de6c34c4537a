#include "import/gltf_material.h"

#include <algorithm>
#include <cmath>

#include "import/gltf_texture.h"

namespace troffer {

// Converts one material.
class GltfMaterials::Reader {
 public:
  Reader(GltfMaterials& all, const JsonNode& material) : all_(all), node_(material) {}

  GltfMaterial read() {
    material_.kind = MaterialKind::metallic_roughness;
    material_.roughness_meaning = RoughnessMeaning::alpha_is_square;
    material_.name = node_.string_or("name", "");
    read_base();
    read_normal();
    read_alpha();
    read_specular();
    read_transmission();
    read_emission();
    result_.is_two_sided = node_.bool_or("doubleSided", false);
    result_.is_textured = uv_set_ >= 0;
    result_.uv_set = std::max(uv_set_, 0);
    reduce_to_diffuse();
    result_.material = uint32_t(all_.scene_.materials.size());
    all_.scene_.materials.push_back(std::move(material_));
    return result_;
  }

 private:
  void warn(const std::string& what) { all_.scene_.warnings.add(node_.pointer() + ": " + what); }

  // A factor that [1] wants in [0,1].
  float unit_number(const JsonNode& node) {
    const double value = node.as_number();
    if (value < 0 || value > 1) {
      warn(printable(node.pointer().substr(node.pointer().rfind('/') + 1)) +
           " is outside [0,1]; clamped");
    }
    return float(std::clamp(value, 0.0, 1.0));
  }
  float unit_number(const JsonNode& object, const char* key, float fallback) {
    const auto node = object.find(key);
    return node ? unit_number(*node) : fallback;
  }
  Rgb unit_color(const JsonNode& list) {
    return {unit_number(list.element(0)), unit_number(list.element(1)),
            unit_number(list.element(2))};
  }

  // The texture at object/key, or none.
  int32_t texture(const JsonNode& object, const char* key, bool is_srgb) {
    const auto info = object.find(key);
    stand_in_ = Rgb{1};
    if (!info) return no_texture;
    const GltfTextureUse use =
        gltf_texture(all_.root_, *info, is_srgb, all_.buffers_, all_.loader_, all_.scene_);
    stand_in_ = use.stand_in;
    if (use.texture == no_texture) return no_texture;
    if (uv_set_ < 0) uv_set_ = use.uv_set;  // the base colour's, which is read first
    if (uv_set_ != use.uv_set)
      warn(
          "textures of one material use different sets of coordinates; the first one's "
          "serves all");
    return use.texture;
  }

  void read_base() {
    material_.base_color = {Rgb{1}, no_texture};
    material_.roughness = {1, no_texture, 1};
    material_.metallic = {1, no_texture, 2};
    const auto pbr = node_.find("pbrMetallicRoughness");
    if (!pbr) return;
    if (const auto color = pbr->find("baseColorFactor")) {
      material_.base_color.value = unit_color(*color);
      material_.alpha.value = unit_number(color->element(3));
    }
    material_.base_color.texture = texture(*pbr, "baseColorTexture", true);
    material_.base_color.value *= stand_in_;
    material_.roughness.value = unit_number(*pbr, "roughnessFactor", 1);
    material_.metallic.value = unit_number(*pbr, "metallicFactor", 1);
    const int32_t both = texture(*pbr, "metallicRoughnessTexture", false);
    material_.roughness.texture = material_.metallic.texture = both;
  }

  void read_normal() {
    material_.normal_texture = texture(node_, "normalTexture", false);
    if (material_.normal_texture != no_texture)
      material_.normal_scale = float(node_.member("normalTexture").number_or("scale", 1));
  }

  bool base_has_alpha() const {
    if (material_.alpha.value < 1) return true;
    if (material_.base_color.texture == no_texture) return false;
    const int n = all_.scene_.textures[size_t(material_.base_color.texture)].channels;
    return n == 2 || n == 4;
  }

  void read_alpha() {
    const std::string mode = node_.string_or("alphaMode", "OPAQUE");
    if (mode == "MASK") {
      material_.is_alpha_masked = true;
      material_.alpha_cutoff = float(node_.number_or("alphaCutoff", 0.5));
    } else if (mode == "BLEND" && base_has_alpha()) {
      warn("alphaMode BLEND is shown as MASK with a cutoff of 0.5");
      material_.is_alpha_masked = true;
      material_.alpha_cutoff = 0.5f;
    } else if (mode != "OPAQUE" && mode != "BLEND") {
      node_.member("alphaMode").fail("'" + printable(mode) + "' is no alpha mode");
    }
    if (material_.is_alpha_masked) material_.alpha.texture = material_.base_color.texture;
  }

  void read_specular() {
    if (const auto ior = node_.extension("KHR_materials_ior")) {
      const double value = ior->number_or("ior", 1.5);
      if (value == 0 || (value >= 1 && value < 100))  // 0: reflects everything, see make_bsdf
        material_.ior = float(value);
      else
        warn("an ior that is neither 0 nor in [1,100) is read as 1.5");
    }
    const auto specular = node_.extension("KHR_materials_specular");
    if (!specular) return;
    material_.specular.value = unit_number(*specular, "specularFactor", 1);
    material_.specular.texture = texture(*specular, "specularTexture", false);
    const auto color = specular->numbers_or("specularColorFactor", {1, 1, 1});
    if (std::any_of(color.begin(), color.end(), [](double c) { return c < 0; }))
      specular->member("specularColorFactor").fail("must not be negative");
    material_.specular_color.value = {float(color[0]), float(color[1]), float(color[2])};
    material_.specular_color.texture = texture(*specular, "specularColorTexture", true);
  }

  void read_transmission() {
    const auto transmission = node_.extension("KHR_materials_transmission");
    if (!transmission) return;
    material_.transmission.value = unit_number(*transmission, "transmissionFactor", 0);
    material_.transmission.texture = texture(*transmission, "transmissionTexture", false);
    const auto volume = node_.extension("KHR_materials_volume");
    // Without a thickness the surface is an infinitely thin sheet (KHR_materials_volume).
    material_.is_thin = !volume || volume->number_or("thicknessFactor", 0) <= 0;
    if (!volume || !volume->find("attenuationDistance")) return;
    const auto color = volume->numbers_or("attenuationColor", {1, 1, 1});
    if (std::any_of(color.begin(), color.end(), [](double c) { return c != 1; }))
      warn("attenuation inside a volume is ignored");
  }

  void read_emission() {
    const auto factor = node_.find("emissiveFactor");
    if (!factor) return;
    double strength = 1;
    if (const auto extension = node_.extension("KHR_materials_emissive_strength"))
      strength = extension->number_or("emissiveStrength", 1);
    const auto color = factor->as_numbers(3);
    if (strength < 0 || std::any_of(color.begin(), color.end(), [](double c) { return c < 0; }))
      factor->fail("emission must not be negative");
    const Rgb emission{float(color[0] * strength), float(color[1] * strength),
                       float(color[2] * strength)};
    if (!is_finite(emission)) factor->fail("the emission is too large");
    if (emission.is_black()) return;
    result_.emission = emission;
    result_.emission_texture = texture(node_, "emissiveTexture", true);
  }

  // Without metal, specular reflection and transmission the model is Lambert's, exactly.
  void reduce_to_diffuse() {
    if (material_.metallic.value == 0 && material_.specular.value == 0 &&
        material_.transmission.value == 0)
      material_.kind = MaterialKind::diffuse;
  }

  GltfMaterials& all_;
  const JsonNode& node_;
  Material material_;
  GltfMaterial result_;
  int uv_set_ = -1;  // not yet known
  Rgb stand_in_{1};  // for the image that was asked for last, where it is missing
};

const GltfMaterial& GltfMaterials::get(std::optional<uint32_t> index) {
  const int64_t key = index ? int64_t(*index) : -1;
  const auto it = done_.find(key);
  if (it != done_.end()) return it->second;
  GltfMaterial made;
  if (index) {
    made = Reader(*this, root_.member("materials").element(*index)).read();
  } else {
    Material material;
    material.kind = MaterialKind::metallic_roughness;
    material.roughness_meaning = RoughnessMeaning::alpha_is_square;
    material.base_color.value = Rgb{1};
    material.roughness.value = material.metallic.value = 1;
    made.material = uint32_t(scene_.materials.size());
    scene_.materials.push_back(std::move(material));
  }
  return done_.emplace(key, made).first->second;
}

}  // namespace troffer
