// Mitsuba's bsdfs with a clear coat (part of MitsubaBsdfs).
#include <algorithm>
#include <cmath>

#include "import/anisotropic_roughness.h"
#include "import/mitsuba/mitsuba_bsdf.h"
#include "import/mitsuba/mitsuba_values.h"

namespace troffer {

namespace {

// True for materials that can carry a coat. A diffuse one becomes coated_diffuse instead.
bool can_be_coated(const Material& m) {
  return m.coat.value <= 0 &&
         (m.kind == MaterialKind::conductor || m.kind == MaterialKind::coated_diffuse ||
          m.kind == MaterialKind::dielectric || m.kind == MaterialKind::metallic_roughness);
}

// Reads the plugin's clearcoat lobe, whose weight is a quarter of `clearcoat`. Its width is between
// 0.1 and 0.001. The lobe is GGX here; the plugin's has longer tails.
void read_principled_coat(const MitsubaNode& node, MitsubaTextures& textures, Material& m) {
  m.coat = textures.real(node, {"clearcoat"}, 0);
  m.coat.value = 0.25f * std::clamp(m.coat.value, 0.0f, 1.0f);
  const double gloss = std::clamp(get_number(node, "clearcoat_gloss", 0), 0.0, 1.0);
  m.coat_roughness.value = float(std::sqrt(lerp(0.1, 0.001, gloss)));
}

// True for a number or colour of zeros.
bool is_nothing(const MitsubaNode& parameter) {
  if (!is_color(parameter) || !parameter.has("value")) return false;
  const std::string& text = parameter.attribute("value");
  return text.find_first_not_of("0.,; ") == std::string::npos;
}

// Share of uniform diffuse light that is not absorbed on its way into the coat and out again.
float diffuse_transmittance(float exponent, float index) {
  constexpr int steps = 64;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    // sin² of the refracted direction, uniform in sin² by Lambert's law
    const double sine2 = (i + 0.5) / steps / sqr(double(index));
    sum += std::exp(-double(exponent) / std::sqrt(1 - sine2));
  }
  return float(sqr(sum / steps));
}

// Darkens the base by the coat's absorption.
void absorb(Material& m, Rgb exponent, float index) {
  if (m.kind == MaterialKind::dielectric) {  // light passes straight, once per side of a sheet
    for (size_t c = 0; c < 3; ++c)
      m.base_color.value[c] *= std::exp(-exponent[c] * (m.is_thin ? 2.0f : 1.0f));
    return;
  }
  if (m.kind == MaterialKind::conductor) {  // normal incidence
    ColorInput& factor = m.is_reflectance ? m.base_color : m.specular_color;
    for (size_t c = 0; c < 3; ++c) factor.value[c] *= std::exp(-2 * exponent[c]);
    return;
  }
  for (size_t c = 0; c < 3; ++c) m.base_color.value[c] *= diffuse_transmittance(exponent[c], index);
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
  if (m.is_thin) {  // diff_trans ranges to 2, which transmits all diffuse light
    m.diffuse_transmission = textures_.real(node, {"diff_trans"}, 0);
    m.diffuse_transmission.value *= 0.5f;
    m.diffuse_transmission_color = m.base_color;
  }
  read_principled_coat(node, textures_, m);
  std::string left_out;
  const auto leave_out = [&](const char* name) {
    const MitsubaNode* p = find_parameter(node, name);
    if (!p || is_nothing(*p)) return false;
    left_out += std::string(left_out.empty() ? "" : ", ") + name;
    return true;
  };
  if (leave_out("sheen")) leave_out("sheen_tint");
  for (const char* name : {"spec_tint", "flatness"}) leave_out(name);
  find_parameter(node, "sheen_tint");
  const FloatInput grain = textures_.real(node, {"anisotropic"}, 0);
  if (grain.texture < 0 && m.roughness.texture < 0 && is_opaque && !m.is_thin && grain.value > 0) {
    // The model's aspect is for widths; roughness is the square root of a width.
    const float aspect = std::pow(1 - 0.9f * std::min(grain.value, 1.0f), 0.25f);
    set_anisotropic_roughness(m, m.roughness.value / aspect, m.roughness.value * aspect);
  } else if (grain.texture >= 0 || grain.value > 0) {
    leave_out("anisotropic");
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
  const ColorInput absorbed = textures_.real_color(node, "sigma_a");
  const Rgb exponent = absorbed.value * float(std::max(get_number(node, "thickness", 1), 0.0));
  const ColorInput specular = textures_.color(node, {"specular_reflectance"}, Rgb{1});
  const bool is_diffuse = m && m->kind == MaterialKind::diffuse && !m->is_alpha_masked &&
                          m->diffuse_transmission.value <= 0;
  if (!m || (!is_diffuse && !can_be_coated(*m))) {
    for (const char* name : {"alpha", "int_ior", "ext_ior", "distribution"})
      find_parameter(node, name);
    if (m) approximate(node, "without the coat");
    return m;
  }
  const auto index = float(index_of_refraction(node, "int_ior", "bk7") /
                           index_of_refraction(node, "ext_ior", "air"));
  if (!exponent.is_black()) {
    absorb(*m, exponent, index);
    approximate(node, "the coat's absorption as a colour of the base");
  }
  if (is_diffuse) {
    m->kind = MaterialKind::coated_diffuse;
    if (node.type == "roughcoating") read_alpha(node, *m);
    m->ior = index;
    m->specular_color = specular;
    return m;
  }
  if (specular.texture >= 0 || specular.value != Rgb{1})
    approximate(node, "without its specular_reflectance");
  m->coat.value = 1;
  if (m->kind == MaterialKind::dielectric)
    approximate(node, "over glass as a coat without refraction");
  if (node.type == "roughcoating") {
    Material coat;
    read_alpha(node, coat);
    m->coat_roughness = coat.roughness;
  }
  // The coat's roughness has the meaning of the base's.
  if (m->roughness_meaning == RoughnessMeaning::alpha_is_square)
    m->coat_roughness.value = std::sqrt(m->coat_roughness.value);
  m->coat_ior = index;
  return m;
}

}  // namespace troffer
