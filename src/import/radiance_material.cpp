#include "import/radiance_material.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace troffer {

namespace {

constexpr int max_chain = 64;  // of modifiers of modifiers
constexpr double pane_index = 1.52;

// Of materials: how many real arguments they need at least.
const std::map<std::string, size_t>& materials() {
  static const std::map<std::string, size_t> table{
      {"plastic", 5},    {"metal", 5},     {"trans", 7},     {"plastic2", 6},   {"metal2", 6},
      {"trans2", 8},     {"ashik2", 8},    {"glass", 3},     {"dielectric", 5}, {"interface", 8},
      {"mirror", 3},     {"light", 3},     {"glow", 3},      {"spotlight", 7},  {"illum", 3},
      {"plasfunc", 5},   {"metfunc", 5},   {"transfunc", 7}, {"BRTDfunc", 9},   {"plasdata", 5},
      {"metdata", 5},    {"transdata", 7}, {"BSDF", 0},      {"aBSDF", 0},      {"WGMDfunc", 9},
      {"antimatter", 0}, {"mist", 0},      {"prism1", 0},    {"prism2", 0}};
  return table;
}

bool is_mixture(const std::string& type) {
  return type.starts_with("mix");
}
bool is_pattern(const std::string& type) {
  static const std::set<std::string> patterns{
      "colorfunc", "brightfunc", "colordata", "brightdata", "colorpict", "colortext", "brighttext",
      "texfunc",   "texdata",    "spectrum",  "specfile",   "specfunc",  "specdata",  "specpict"};
  return patterns.contains(type);
}

Rgb rgb_at(const std::vector<double>& v, size_t i = 0) {
  return {float(std::max(v[i], 0.0)), float(std::max(v[i + 1], 0.0)),
          float(std::max(v[i + 2], 0.0))};
}

// The index of a surface that reflects that share of light at normal incidence.
float index_of(double reflectance) {
  const double f = std::sqrt(std::clamp(reflectance, 0.0, 0.25));
  return float((1 + f) / (1 - f));
}

// plastic: a share `specular` of all light is reflected white, the rest by the base. metal: that
// share coloured.
Material glossy(const std::vector<double>& v, double roughness, bool is_metal) {
  Material m;
  m.base_color.value = clamp01(rgb_at(v));
  const double specular = std::clamp(v[3], 0.0, 1.0);
  if (specular == 0) return m;
  m.kind = MaterialKind::metallic_roughness;
  m.roughness.value = float(std::clamp(roughness, 0.0, 1.0));
  m.roughness_meaning = RoughnessMeaning::alpha;
  m.metallic.value = is_metal ? float(specular) : 0;
  m.specular.value = is_metal ? 0 : 1;
  m.ior = is_metal ? 1.5f : index_of(specular);
  return m;
}

// Transmissivity t of one pass through a pane of index n -> the tint of a sheet without absorption
// that lets as much through at normal incidence: (1-r)² t / (1 - r² t²) = tint (1-r) / (1+r).
Material pane(const std::vector<double>& v) {
  Material m;
  m.kind = MaterialKind::dielectric;
  m.is_thin = true;
  const double n = v.size() > 3 && v[3] > 0 ? v[3] : pane_index;
  m.ior = float(n);
  const double r = sqr((n - 1) / (n + 1));
  Rgb t = clamp01(rgb_at(v));
  for (size_t c = 0; c < 3; ++c)
    t[c] = float(double(t[c]) * (1 - r * r) / (1 - sqr(r * double(t[c]))));
  m.base_color.value = clamp01(t);
  return m;
}

}  // namespace

bool RadianceMaterials::is_modifier(const std::string& type) {
  return materials().contains(type) || is_pattern(type) || is_mixture(type);
}

void RadianceMaterials::define(const std::string& name, RadianceModifier modifier) {
  const bool is_new = modifiers_.insert_or_assign(name, std::move(modifier)).second;
  if (!is_new) looks_.clear();  // what others are made of may have changed
  looks_.erase(name);           // grey until now
}

// The material behind aliases and mixtures.
const RadianceModifier& RadianceMaterials::material_of(std::string name, const SourcePlace& place) {
  for (int i = 0; i < max_chain; ++i) {
    const auto found = modifiers_.find(name);
    if (found == modifiers_.end()) {
      scene_.warnings.add("no modifier '" + shortened(name) + "' is defined: shown diffuse grey");
      return grey_;
    }
    const RadianceModifier& m = found->second;
    if (m.type == "alias") {
      name = m.arguments.strings.at(0);
    } else if (is_mixture(m.type)) {
      if (m.arguments.strings.empty()) m.place.fail("a mixture needs two modifiers");
      scene_.warnings.add("mixture \"" + m.type + "\" is not supported: its first part is shown");
      name = m.arguments.strings[0];
      if (name == "void" && m.arguments.strings.size() > 1) name = m.arguments.strings[1];
    } else if (is_pattern(m.type)) {
      name = m.modifier;
    } else {
      return m;
    }
    if (name == "void") return m;
  }
  place.fail("modifiers refer to each other without end");
}

const RadianceLook& RadianceMaterials::look_of(const std::string& name, const SourcePlace& place) {
  const auto found = looks_.find(name);
  if (found != looks_.end()) return found->second;
  RadianceLook look;
  if (name == "void") {
    look.is_there = false;
  } else {
    const RadianceModifier& m = material_of(name, place);
    const auto needed = materials().find(m.type);
    if (needed == materials().end()) {
      look.is_there = false;
    } else {
      if (m.arguments.reals.size() < needed->second)
        m.place.fail(m.type + " needs " + std::to_string(needed->second) + " real arguments");
      look = convert(name, m);
    }
  }
  return looks_[name] = look;
}

// Patterns and textures below a material, which are not shown.
void RadianceMaterials::note_patterns(const RadianceModifier& m, RadianceLook& look) {
  std::string name = m.modifier;
  for (int i = 0; i < max_chain && name != "void"; ++i) {
    const auto found = modifiers_.find(name);
    if (found == modifiers_.end()) return;
    const auto& strings = found->second.arguments.strings;
    const bool is_sky = found->second.type == "brightfunc" && strings.size() >= 2 &&
                        strings[0] == "skybright" && found->second.arguments.reals.size() >= 7;
    if (is_sky && m.type == "glow")
      look.sky = &found->second;
    else
      scene_.warnings.add("\"" + shortened(found->second.type) + "\" is not supported: its " +
                          (m.type == "light"
                               ? "lights shine evenly (--luminaire NAME=FILE.ies gives them a "
                                 "distribution)"
                               : "materials are shown without"));
    name = found->second.modifier;
  }
}

bool RadianceMaterials::convert_emission(const RadianceModifier& m, RadianceLook& look) {
  const std::vector<double>& v = m.arguments.reals;
  if (m.type != "light" && m.type != "glow" && m.type != "spotlight" && m.type != "illum")
    return false;
  look.emission = rgb_at(v);
  if (m.type == "illum")
    scene_.warnings.add("\"illum\" is shown as a light: what is behind it is not seen");
  if (m.type == "spotlight") {
    look.is_spot = true;
    look.spot_angle_deg = v[3];
    look.spot_axis = {v[4], v[5], v[6]};
    if (!(length(look.spot_axis) > 0) || !(v[3] > 0 && v[3] <= 360))
      m.place.fail("spotlight needs an angle up to 360 and a direction");
  }
  return true;
}

// What is neither absorbed nor reflected as gloss: 1 - trans of it goes back evenly, trans goes
// through, of which tspec straight on.
Material RadianceMaterials::translucent(const std::vector<double>& v) {
  const double trans = std::clamp(v[5], 0.0, 1.0);
  const double straight = trans * std::clamp(v[6], 0.0, 1.0);
  Material m = glossy(v, v[4], false);
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

Material RadianceMaterials::convert_surface(const RadianceModifier& m) {
  const std::vector<double>& v = m.arguments.reals;
  const std::string& type = m.type;
  Material out;
  if (type == "plastic" || type == "metal") return glossy(v, v[4], type == "metal");
  if (type == "trans") return translucent(v);
  if (type == "glass") return pane(v);
  if (type == "plastic2" || type == "metal2") {
    scene_.warnings.add("\"" + type + "\": roughness along its two axes as their geometric mean");
    return glossy(v, std::sqrt(std::max(v[4], 0.0) * std::max(v[5], 0.0)), type == "metal2");
  }
  if (type == "mirror") {
    out.kind = MaterialKind::conductor;
    out.is_reflectance = true;
    out.base_color.value = clamp01(rgb_at(v));
    return out;
  }
  if (type == "dielectric" || type == "interface") {
    const bool is_interface = type == "interface";
    out.kind = MaterialKind::dielectric;
    out.base_color.value = Rgb{1};
    const double inside = v[3], outside = is_interface ? v[7] : 1;
    if (!(inside > 0) || !(outside > 0)) m.place.fail("an index of refraction must be positive");
    out.ior = float(inside / outside);
    // The numbers are what is left after a metre.
    const Rgb left = rgb_at(v);
    for (size_t c = 0; c < 3; ++c) out.absorption[c] = -std::log(std::clamp(left[c], 1e-6f, 1.0f));
    if (is_interface && rgb_at(v, 4) != Rgb{1})
      scene_.warnings.add("\"interface\": absorption on its outer side is left out");
    return out;
  }
  const bool has_color = v.size() >= 3;
  scene_.warnings.add("material \"" + type + "\" is not supported: shown " +
                      (has_color ? "diffuse in its colour" : "diffuse grey"));
  if (has_color) out.base_color.value = clamp01(rgb_at(v));
  return out;
}

RadianceLook RadianceMaterials::convert(const std::string& name, const RadianceModifier& m) {
  RadianceLook look;
  if (m.type == "antimatter" || m.type == "mist" || m.type.starts_with("prism")) {
    scene_.warnings.add("material \"" + m.type + "\" is not supported: its surfaces are left out");
    look.is_there = false;
    return look;
  }
  note_patterns(m, look);
  Material material;
  if (convert_emission(m, look))
    material.base_color.value = Rgb{0};
  else
    material = convert_surface(m);
  material.name = name;
  look.material = uint32_t(scene_.materials.size());
  scene_.materials.push_back(std::move(material));
  return look;
}

}  // namespace troffer
