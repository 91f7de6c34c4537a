#include "import/gltf/gltf_material.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "import/gltf/gltf_texture.h"
#include "import/uri.h"

namespace troffer {

class GltfMaterials::Reader {
 public:
  Reader(GltfMaterials& all, const JsonNode& material) : all_(all), node_(material) {}

  GltfMaterial read() {
    material_.kind = MaterialKind::metallic_roughness;
    material_.roughness_meaning = RoughnessMeaning::alpha_is_square;
    material_.name = node_.string_or("name", "");
    result_.uv_sets = gltf_uv_sets(node_, all_.scene_.warnings);
    if (const auto old = node_.extension("KHR_materials_pbrSpecularGlossiness"))
      read_specular_glossiness(*old);
    else
      read_base();
    read_normal();
    read_alpha();
    read_specular();
    read_transmission();
    read_clearcoat();
    read_sheen();
    read_diffuse_transmission();
    read_anisotropy();
    read_iridescence();
    tell_what_is_left_out();
    read_emission();
    result_.is_two_sided = node_.bool_or("doubleSided", false);
    // Emitters keep their backs visible: their light is one-sided, the surface is not.
    if (!result_.is_two_sided && result_.emission.is_black())
      material_.back_faces = BackFaces::unseen;
    reduce_to_diffuse();
    result_.material = uint32_t(all_.scene_.materials.size());
    all_.scene_.materials.push_back(std::move(material_));
    return result_;
  }

 private:
  void warn(const std::string& what) { all_.scene_.warnings.add(node_.pointer() + ": " + what); }

  // Returns a factor clamped to [0,1]; warns if it lies outside [1].
  float unit_number(const JsonNode& node) {
    const double value = node.as_number();
    const std::string name = printable(node.pointer().substr(node.pointer().rfind('/') + 1));
    if (value < 0 || value > 1) warn(name + " is outside [0,1]; clamped");
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

  // Returns the texture at object/key, or no_texture. Sets stand_in_ to the colour to use instead.
  int32_t texture(const JsonNode& object, const char* key, bool is_srgb) {
    const auto info = object.find(key);
    stand_in_ = Rgb{1};
    if (!info) return no_texture;
    const GltfTextureUse use = gltf_texture(all_.root_, *info, is_srgb, result_.uv_sets,
                                            all_.buffers_, all_.loader_, all_.scene_);
    stand_in_ = use.stand_in;
    result_.is_textured |= use.texture != no_texture;
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

  // Reads the material as a dielectric with that normal reflectance: KHR_materials_specular at IOR
  // 1.5.
  void read_specular_glossiness(const JsonNode& old) {
    material_.base_color = {Rgb{1}, no_texture};
    material_.metallic = {0, no_texture, 2};
    if (const auto color = old.find("diffuseFactor")) {
      color->as_numbers(4);
      material_.base_color.value = unit_color(*color);
      material_.alpha.value = unit_number(color->element(3));
    }
    material_.base_color.texture = texture(old, "diffuseTexture", true);
    material_.base_color.value *= stand_in_;
    Rgb f0{1};
    if (const auto specular = old.find("specularFactor")) {
      specular->as_numbers(3);
      f0 = unit_color(*specular);
    }
    material_.specular_color.value = f0 * 25.0f;  // 1 / 0.04, the normal reflectance at IOR 1.5
    material_.specular_color.texture = texture(old, "specularGlossinessTexture", true);
    const float glossiness = unit_number(old, "glossinessFactor", 1);
    const int32_t image = rough_from_glossy(material_.specular_color.texture, glossiness);
    material_.roughness = {image == no_texture ? 1 - glossiness : 1.0f, image, 0};
  }

  // Adds a texture of 1 - factor × alpha and returns it; no_texture if the image has no alpha.
  int32_t rough_from_glossy(int32_t glossy, float factor) {
    if (glossy == no_texture) return no_texture;
    const Texture& from = all_.scene_.textures[size_t(glossy)];
    const auto n = size_t(from.channels);
    if (n != 2 && n != 4) return no_texture;
    Texture to = from;
    to.channels = 1;
    to.is_srgb = false;
    to.texels8.clear();
    to.texels_float.clear();
    for (size_t i = n - 1; i < from.texels8.size(); i += n)
      to.texels8.push_back(uint8_t(255 - std::lround(factor * float(from.texels8[i]))));
    for (size_t i = n - 1; i < from.texels_float.size(); i += n)
      to.texels_float.push_back(1 - factor * std::clamp(from.texels_float[i], 0.0f, 1.0f));
    all_.scene_.textures.push_back(std::move(to));
    return int32_t(all_.scene_.textures.size() - 1);
  }

  // Reads NAMEFactor and NAMETexture into `input`, whose texture channel stays as it is.
  void read_unit(const JsonNode& object, const std::string& name, FloatInput& input) {
    input.value = unit_number(object, (name + "Factor").c_str(), input.value);
    input.texture = texture(object, (name + "Texture").c_str(), false);
    if (input.texture == no_texture) input.value *= stand_in_[size_t(input.channel)];
  }

  // Without a normal map of its own the coat follows the geometric surface, not the base's normal
  // map.
  void read_clearcoat() {
    const auto coat = node_.extension("KHR_materials_clearcoat");
    if (!coat) return;
    read_unit(*coat, "clearcoat", material_.coat);
    if (material_.coat.value == 0) return;
    read_unit(*coat, "clearcoatRoughness", material_.coat_roughness);
    material_.has_coat_normal = true;
    material_.coat_normal_texture = texture(*coat, "clearcoatNormalTexture", false);
    if (material_.coat_normal_texture != no_texture)
      material_.coat_normal_scale =
          float(coat->member("clearcoatNormalTexture").number_or("scale", 1));
  }

  void read_sheen() {
    const auto sheen = node_.extension("KHR_materials_sheen");
    if (!sheen) return;
    const auto color = sheen->numbers_or("sheenColorFactor", {0, 0, 0});
    if (color.size() != 3) {
      warn("sheenColorFactor should be three numbers; left out");
      return;
    }
    for (size_t c = 0; c < 3; ++c)
      material_.sheen_color.value[c] = float(std::clamp(color[c], 0.0, 1.0));
    if (material_.sheen_color.value.is_black()) return;
    material_.sheen_roughness.value = unit_number(*sheen, "sheenRoughnessFactor", 0);
    material_.sheen_color.texture = texture(*sheen, "sheenColorTexture", true);
    material_.sheen_color.value *= stand_in_;
    material_.sheen_roughness.texture = texture(*sheen, "sheenRoughnessTexture", false);
  }

  void read_diffuse_transmission() {
    const auto passing = node_.extension("KHR_materials_diffuse_transmission");
    if (!passing) return;
    FloatInput& share = material_.diffuse_transmission;
    share.value = unit_number(*passing, "diffuseTransmissionFactor", 0);
    if (share.value == 0) return;
    share.texture = texture(*passing, "diffuseTransmissionTexture", false);
    ColorInput& color = material_.diffuse_transmission_color;
    if (const auto factor = passing->find("diffuseTransmissionColorFactor")) {
      factor->as_numbers(3);
      color.value = unit_color(*factor);
    }
    color.texture = texture(*passing, "diffuseTransmissionColorTexture", true);
    color.value *= stand_in_;
  }

  void read_anisotropy() {
    const auto anisotropy = node_.extension("KHR_materials_anisotropy");
    if (!anisotropy) return;
    const float strength = unit_number(*anisotropy, "anisotropyStrength", 0);
    if (strength == 0) return;
    if (material_.transmission.value > 0) {
      const float alpha = sqr(material_.roughness.value);
      const float along = alpha + (1 - alpha) * sqr(strength);
      material_.roughness.value = std::min(std::sqrt(std::sqrt(alpha * along)), 1.0f);
      warn("anisotropic transmission is approximated: gloss is isotropic, with the mean width");
      return;
    }
    material_.anisotropy.value = strength;
    material_.anisotropy_rotation_rad = float(anisotropy->number_or("anisotropyRotation", 0));
    material_.anisotropy.texture = texture(*anisotropy, "anisotropyTexture", false);
  }

  void read_iridescence() {
    const auto film = node_.extension("KHR_materials_iridescence");
    if (!film) return;
    read_unit(*film, "iridescence", material_.iridescence);
    if (material_.iridescence.value == 0) return;
    constexpr double most_nm = 1e6;
    material_.film_ior = float(std::clamp(film->number_or("iridescenceIor", 1.3), 1.0, 10.0));
    material_.film_thinnest_nm =
        float(std::clamp(film->number_or("iridescenceThicknessMinimum", 100), 0.0, most_nm));
    material_.film_thickest_nm =
        float(std::clamp(film->number_or("iridescenceThicknessMaximum", 400), 0.0, most_nm));
    material_.film_thickness.texture = texture(*film, "iridescenceThicknessTexture", false);
    const bool is_rough_glass = material_.transmission.value > 0 && !material_.is_thin &&
                                material_.roughness.value > 0.032f;
    const bool is_even = material_.iridescence.texture < 0 &&
                         material_.film_thickness.texture < 0 && material_.roughness.texture < 0;
    if (is_rough_glass && !is_even)
      warn("a varying film over rough glass: light lost between microfacets is not restored");
  }

  void tell_what_is_left_out() {
    struct Sent {
      const char *extension, *what;
    };
    constexpr std::array<Sent, 3> list{
        {{"KHR_materials_unlit", "unlit: shown diffuse, lit like other surfaces"},
         {"KHR_materials_dispersion", "dispersion is left out"},
         {"KHR_materials_volume_scatter", "scattering inside a volume is left out"}}};
    for (const Sent& told : list)
      if (node_.extension(told.extension)) warn(told.what);
    if (!node_.extension("KHR_materials_unlit")) return;
    material_.metallic = {0, no_texture, 2};
    material_.specular.value = material_.coat.value = material_.iridescence.value = 0;
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
    } else if (mode == "BLEND") {
      result_.is_blended = true;
      material_.is_alpha_masked = material_.is_alpha_blended = base_has_alpha();
    } else if (mode != "OPAQUE") {
      node_.member("alphaMode").fail("'" + printable(mode) + "' is not an alpha mode");
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
    if (!specular || node_.extension("KHR_materials_pbrSpecularGlossiness")) return;
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
    if (volume && volume->find("attenuationDistance")) read_attenuation(*volume);
  }

  // Sets the absorption at which white light becomes attenuationColor after attenuationDistance.
  void read_attenuation(const JsonNode& volume) {
    constexpr double darkest = 1e-6;
    const auto color = volume.numbers_or("attenuationColor", {1, 1, 1});
    const double distance = volume.number_or("attenuationDistance", 0);
    if (color.size() != 3 || !(distance > 0)) {
      warn("the attenuation of a volume needs three numbers and a distance above 0; left out");
      return;
    }
    const double thickness = volume.number_or("thicknessFactor", 0);
    if (thickness <= 0) return;  // a sheet has no interior
    for (size_t c = 0; c < 3; ++c)
      material_.absorption[c] =
          float(std::min(-std::log(std::clamp(color[c], darkest, 1.0)) / distance, 1e6));
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

  // Uses the Lambert model where it is exactly equal: without metal, specular reflection,
  // transmission, sheen and coat.
  void reduce_to_diffuse() {
    if (material_.metallic.value == 0 && material_.specular.value == 0 &&
        material_.transmission.value == 0 && material_.diffuse_transmission.value == 0 &&
        material_.sheen_color.value.is_black() && material_.coat.value == 0)
      material_.kind = MaterialKind::diffuse;
  }

  GltfMaterials& all_;
  const JsonNode& node_;
  Material material_;
  GltfMaterial result_;
  Rgb stand_in_{1};  // colour instead of the last requested image; 1 if it exists
};

const GltfMaterial& GltfMaterials::get(std::optional<uint32_t> index) {
  const int64_t key = index ? int64_t(*index) : -1;
  const auto it = done_.find(key);
  if (it != done_.end()) return it->second;
  GltfMaterial made;
  if (index) {
    made = Reader(*this, root_.member("materials").element(*index)).read();
    if (on_read) on_read(root_.member("materials").element(*index), made, loader_);
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

void GltfMaterials::expect_images() {
  if (!loader_.decodes_ahead()) return;
  const auto materials = root_.find("materials");
  try {
    for (size_t i = 0; materials && i < materials->size(); ++i)
      expect_gltf_images(root_, materials->element(i), buffers_, loader_);
  } catch (const InputError&) {
    return;  // The remaining images are read on use.
  }
}

void GltfMaterials::check_unused_images() {
  const auto images = root_.find("images");
  for (size_t i = 0; images && i < images->size(); ++i) {
    const JsonNode image = images->element(i);
    const auto uri = image.find("uri");
    if (!uri || !is_data_uri(uri->as_string()) || loader_.was_asked_for(gltf_image_key(image)))
      continue;
    if (!parse_data_uri(uri->as_string()))
      scene_.warnings.add(printable(uri->pointer()) + ": is a malformed data URI");
  }
}

}  // namespace troffer
