// Mitsuba's bsdfs with a clear coat.
#include <algorithm>
#include <cmath>

#include "import/mitsuba_bsdf.h"
#include "import/mitsuba_values.h"

namespace troffer {

namespace {

// Of another kind than diffuse, which is a coated diffuse one then.
bool can_be_coated(const Material& m) {
  return m.coat.value <= 0 &&
         (m.kind == MaterialKind::conductor || m.kind == MaterialKind::coated_diffuse ||
          (m.kind == MaterialKind::metallic_roughness && m.transmission.texture < 0 &&
           m.transmission.value <= 0));
}

// The second lobe of the plugin: a quarter of `clearcoat`, of an index of 1.5, between .1 and .001
// wide; of ggx, where the plugin's has longer tails.
void read_principled_coat(const MitsubaNode& node, MitsubaTextures& textures, Material& m) {
  m.coat = textures.real(node, {"clearcoat"}, 0);
  m.coat.value = 0.25f * std::clamp(m.coat.value, 0.0f, 1.0f);
  const double gloss = std::clamp(get_number(node, "clearcoat_gloss", 0), 0.0, 1.0);
  m.coat_roughness.value = float(std::sqrt(lerp(0.1, 0.001, gloss)));
}

}  // namespace

Material MitsubaBsdfs::principled(const MitsubaNode& node) {
  Material m;
  m.kind = MaterialKind::metallic_roughness;
  m.base_color = textures_.color(node, {"base_color"}, Rgb{0.5f});
  m.roughness = textures_.real(node, {"roughness"}, 0.5f);
  m.roughness_meaning = RoughnessMeaning::alpha_is_square;
  m.metallic = textures_.real(node, {"metallic"}, 0);
  m.transmission = textures_.real(node, {"spec_trans"}, 0);
  m.is_thin = node.type == "principledthin";
  const bool is_opaque = m.transmission.texture < 0 && m.transmission.value <= 0;
  if (is_opaque && !m.is_thin) m.back_faces = BackFaces::black;
  if (find_parameter(node, "eta")) {
    m.ior = float(index_of_refraction(node, "eta", "bk7"));
  } else {
    const double specular = std::clamp(get_number(node, "specular", 0.5), 0.0, 1.0);
    m.ior = float(2 / (1 - std::sqrt(0.08 * specular)) - 1);
  }
  if (m.is_thin) {  // 2: all of what is diffuse
    m.diffuse_transmission = textures_.real(node, {"diff_trans"}, 0);
    m.diffuse_transmission.value *= 0.5f;
    m.diffuse_transmission_color = m.base_color;
  }
  read_principled_coat(node, textures_, m);
  std::string left_out = !is_opaque && m.coat.value > 0 ? "clearcoat" : "";
  for (const char* name : {"anisotropic", "spec_tint", "sheen", "sheen_tint", "flatness"}) {
    const MitsubaNode* p = find_parameter(node, name);
    if (p && p->attribute("value") != "0" && p->attribute("value") != "0.0")
      left_out += std::string(left_out.empty() ? "" : ", ") + name;
  }
  for (const char* name : {"main_specular_sampling_rate", "clearcoat_sampling_rate",
                           "diffuse_reflectance_sampling_rate"})
    find_parameter(node, name);
  approximate(node, "as metal and coat mixed by its weights" +
                        (left_out.empty() ? "" : ", without " + left_out));
  return m;
}

std::optional<Material> MitsubaBsdfs::coated(const MitsubaNode& node) {
  std::optional<Material> m = nested(node);
  for (const char* name : {"thickness", "sigma_a", "specular_reflectance"})
    find_parameter(node, name);
  if (m && m->kind == MaterialKind::diffuse && !m->is_alpha_masked) {
    m->kind = MaterialKind::coated_diffuse;
    if (node.type == "roughcoating") read_alpha(node, *m);
    m->ior = float(index_of_refraction(node, "int_ior", "bk7") /
                   index_of_refraction(node, "ext_ior", "air"));
    approximate(node, "without absorption in the coat");
  } else if (m && can_be_coated(*m)) {
    m->coat.value = 1;
    if (node.type == "roughcoating") {
      Material coat;
      read_alpha(node, coat);
      m->coat_roughness = coat.roughness;
    }
    // Both are told as the base tells its own.
    if (m->roughness_meaning == RoughnessMeaning::alpha_is_square)
      m->coat_roughness.value = std::sqrt(m->coat_roughness.value);
    m->coat_ior = float(index_of_refraction(node, "int_ior", "bk7") /
                        index_of_refraction(node, "ext_ior", "air"));
    approximate(node, "without absorption in the coat");
  } else {
    approximate(node, "without the coat");
  }
  return m;
}

}  // namespace troffer
