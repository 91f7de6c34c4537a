#include "import/radiance/radiance_gloss.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/units.h"
#include "import/blend_materials.h"

namespace troffer {

namespace {

constexpr double pane_index = 1.52;
constexpr double least_roughness = 1e-3;  // below this, Radiance reflects as a mirror
// Mirror reflectance below which Radiance applies no Fresnel term.
constexpr double least_fresnel = 0.017999;
constexpr float least_left = 1e-15f;  // Radiance's smallest transmissivity of glass

Rgb rgb_at(const std::vector<double>& v, size_t i = 0) {
  return {float(std::max(v[i], 0.0)), float(std::max(v[i + 1], 0.0)),
          float(std::max(v[i + 2], 0.0))};
}

// Index of refraction of a surface with that reflectance at normal incidence.
float index_of(double reflectance) {
  const double f = std::sqrt(std::clamp(reflectance, 0.0, 0.9));
  return float((1 + f) / (1 - f));
}

// plastic reflects the share `specular` in white and the rest diffusely; metal reflects it
// coloured. Rough plastic reflects the same share at all angles [2]; a mirror's share grows towards
// grazing angles. So does that of rough metal, unlike in Radiance.
Material glossy(const std::vector<double>& v, double roughness, bool is_metal) {
  Material m;
  m.base_color.value = clamp01(rgb_at(v));
  const double specular = std::clamp(v[3], 0.0, 1.0);
  if (specular == 0) return m;
  m.kind = MaterialKind::metallic_roughness;
  m.roughness.value = roughness < least_roughness ? 0 : float(std::clamp(roughness, 0.0, 1.0));
  m.roughness_meaning = RoughnessMeaning::alpha;
  if (is_metal) {
    m.metallic.value = float(specular);
    m.specular.value = 0;
    return m;
  }
  // An index of 0 reflects everything at all angles; the share `specular` of it is taken.
  const bool is_even = roughness >= least_roughness || specular < least_fresnel;
  m.metallic.value = 0;
  m.specular.value = is_even ? float(specular) : 1;
  m.ior = is_even ? 0 : index_of(specular);
  return m;
}

// Sheet of index n that transmits t at normal incidence. Along the refracted ray of cosine c it
// transmits t^(1/c) [3].
Material pane(const std::vector<double>& v) {
  Material m;
  m.kind = MaterialKind::dielectric;
  m.is_thin = true;
  m.ior = float(v.size() > 3 && v[3] > 0 ? v[3] : pane_index);
  m.base_color.value = Rgb{1};
  const Rgb left = rgb_at(v);
  for (size_t c = 0; c < 3; ++c)
    m.absorption[c] = std::max(0.0f, -std::log(std::clamp(left[c], least_left, 1.0f)));
  return m;
}

// Splits the light that is neither absorbed nor reflected specularly: 1 - trans is reflected
// diffusely, trans is transmitted, and tspec of that passes straight.
Material translucent(const std::vector<double>& v, double roughness, double transmitted,
                     double transmitted_straight) {
  const double trans = std::clamp(transmitted, 0.0, 1.0);
  const double straight = trans * std::clamp(transmitted_straight, 0.0, 1.0);
  Material m = glossy(v, roughness, false);
  if (trans <= 0) return m;
  if (m.kind == MaterialKind::diffuse) {
    m.kind = MaterialKind::metallic_roughness;
    m.specular.value = 0;
  }
  m.is_thin = true;
  m.transmission.value = float(straight);
  m.diffuse_transmission.value = straight < 1 ? float((trans - straight) / (1 - straight)) : 0.0f;
  m.diffuse_transmission_color = m.base_color;
  return m;
}

// Diffuse reflection and diffuse transmission.
Material even_sheet(Rgb reflected, Rgb through) {
  Material m;
  set_diffuse(m, {clamp01(reflected), no_texture}, {clamp01(through), no_texture});
  return m;
}

Material solid_glass(const RadianceModifier& m, WarningLog& warnings) {
  const std::vector<double>& v = m.arguments.reals;
  const bool is_interface = m.type == "interface";
  Material out;
  out.kind = MaterialKind::dielectric;
  out.base_color.value = Rgb{1};
  const double inside = v[3], outside = is_interface ? v[7] : 1;
  if (!(inside > 0) || !(outside > 0)) m.place.fail("an index of refraction must be positive");
  out.ior = float(inside / outside);
  // The numbers are transmittances per metre.
  const Rgb left = rgb_at(v);
  for (size_t c = 0; c < 3; ++c) out.absorption[c] = -std::log(std::clamp(left[c], 1e-6f, 1.0f));
  if (is_interface && rgb_at(v, 4) != Rgb{1})
    warnings.add("\"interface\": absorption on its outer side is left out");
  return out;
}

// transfunc and transdata have r g b rspec trans tspec. Their functions shape the specular
// reflection and transmission, which is shown diffuse.
Material translucent_by_function(const RadianceModifier& m, WarningLog& warnings) {
  const std::vector<double>& v = m.arguments.reals;
  warnings.add("\"" + m.type +
               "\": reflection and transmission shaped by its function are shown diffuse");
  const auto rest = float(1 - std::clamp(v[3], 0.0, 1.0)),
             trans = float(std::clamp(v[4], 0.0, 1.0));
  return even_sheet(rgb_at(v) * (1 - rest * trans), rgb_at(v) * (rest * trans));
}

// BRTDfunc and WGMDfunc have diffuse front reflectance, back reflectance and transmittance.
Material by_functions(const RadianceModifier& m, WarningLog& warnings) {
  const std::vector<double>& v = m.arguments.reals;
  const std::vector<std::string>& strings = m.arguments.strings;
  bool is_diffuse = m.type == "BRTDfunc";
  for (size_t i = 0; i < std::min<size_t>(9, strings.size()); ++i)
    is_diffuse = is_diffuse && strings[i].find_first_not_of("0.") == std::string::npos;
  if (!is_diffuse)
    warnings.add("\"" + m.type + "\": only its diffuse parts are shown; its functions are ignored");
  if (rgb_at(v) != rgb_at(v, 3))
    warnings.add("\"" + m.type + "\": its back is shown with the diffuse reflectance of its front");
  return even_sheet(rgb_at(v), rgb_at(v, 6));
}

}  // namespace

int least_radiance_reals(const std::string& type) {
  static const std::map<std::string, int> table{
      {"plastic", 5},    {"metal", 5},     {"trans", 7},     {"plastic2", 6},   {"metal2", 6},
      {"trans2", 8},     {"ashik2", 8},    {"glass", 3},     {"dielectric", 5}, {"interface", 8},
      {"mirror", 3},     {"light", 3},     {"glow", 3},      {"spotlight", 7},  {"illum", 3},
      {"plasfunc", 4},   {"metfunc", 4},   {"transfunc", 6}, {"BRTDfunc", 9},   {"plasdata", 4},
      {"metdata", 4},    {"transdata", 6}, {"BSDF", 0},      {"aBSDF", 0},      {"WGMDfunc", 9},
      {"antimatter", 0}, {"mist", 0},      {"prism1", 0},    {"prism2", 0}};
  const auto found = table.find(type);
  return found == table.end() ? -1 : found->second;
}

Material radiance_material(const RadianceModifier& m, WarningLog& warnings) {
  const std::vector<double>& v = m.arguments.reals;
  const std::string& type = m.type;
  const auto mean_roughness = [&] {
    warnings.add("\"" + type +
                 "\": roughness along its two axes is replaced by the geometric mean");
    return std::sqrt(std::max(v[4], 0.0) * std::max(v[5], 0.0));
  };
  if (type == "plastic" || type == "metal") return glossy(v, v[4], type == "metal");
  if (type == "plastic2" || type == "metal2") return glossy(v, mean_roughness(), type == "metal2");
  if (type == "trans") return translucent(v, v[4], v[5], v[6]);
  if (type == "trans2") return translucent(v, mean_roughness(), v[6], v[7]);
  if (type == "glass") return pane(v);
  if (type == "dielectric" || type == "interface") return solid_glass(m, warnings);
  if (type == "transfunc" || type == "transdata") return translucent_by_function(m, warnings);
  if (type == "BRTDfunc" || type == "WGMDfunc") return by_functions(m, warnings);
  Material out;
  if (type == "mirror") {
    out.kind = MaterialKind::conductor;
    out.is_reflectance = true;
    out.base_color.value = clamp01(rgb_at(v));
    return out;
  }
  const bool has_color = v.size() >= 3;
  warnings.add("material \"" + type + "\" is not supported: shown " +
               (has_color ? "diffuse in its colour" : "diffuse grey"));
  if (has_color) out.base_color.value = clamp01(rgb_at(v));
  return out;
}

}  // namespace troffer
