#include "import/radiance/radiance_material.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/units.h"
#include "import/radiance/radiance_bsdf.h"
#include "import/radiance/radiance_gloss.h"

namespace troffer {

namespace {

constexpr int max_chain = 64;  // nesting of modifiers

bool is_mixture(const std::string& type) {
  return type.starts_with("mix");
}
bool is_pattern(const std::string& type) {
  static const std::set<std::string> patterns{
      "colorfunc", "brightfunc", "colordata", "brightdata", "colorpict", "colortext", "brighttext",
      "texfunc",   "texdata",    "spectrum",  "specfile",   "specfunc",  "specdata",  "specpict"};
  return patterns.contains(type);
}

Rgb emission_of(const std::vector<double>& v) {
  return {float(std::max(v[0], 0.0)), float(std::max(v[1], 0.0)), float(std::max(v[2], 0.0))};
}

}  // namespace

bool RadianceMaterials::is_modifier(const std::string& type) {
  return least_radiance_reals(type) >= 0 || is_pattern(type) || is_mixture(type);
}

void RadianceMaterials::define(const std::string& name, RadianceModifier modifier) {
  const auto defined = std::make_shared<const RadianceModifier>(std::move(modifier));
  const auto below = modifiers_.find(defined->modifier);
  if (below != modifiers_.end()) below_[defined.get()] = below->second;
  const bool is_new = modifiers_.insert_or_assign(name, defined).second;
  if (!is_new) looks_.clear();  // materials made from the old definition may differ
  looks_.erase(name);           // a reference before the definition has a grey look
}

RadianceMaterials::Modifier RadianceMaterials::modifier_below(const RadianceModifier& m) const {
  const auto known = below_.find(&m);
  if (known != below_.end()) return known->second;
  const auto later = modifiers_.find(m.modifier);
  return later == modifiers_.end() ? nullptr : later->second;
}

// Returns the material or mixture behind aliases and patterns.
RadianceMaterials::Modifier RadianceMaterials::material_of(std::string name,
                                                           const SourcePlace& place) {
  Modifier m;
  for (int i = 0; i < max_chain; ++i) {
    if (!m) {
      const auto found = modifiers_.find(name);
      if (found == modifiers_.end()) {
        scene_.warnings.add("no modifier '" + shortened(name) + "' is defined: shown diffuse grey");
        return grey_;
      }
      m = found->second;
    }
    if (m->type == "alias") {
      name = m->arguments.strings.at(0);
      if (name == "void") return m;
      m = nullptr;
    } else if (is_pattern(m->type)) {
      if (m->modifier == "void") return m;
      name = m->modifier;
      m = modifier_below(*m);
    } else {
      return m;
    }
  }
  place.fail("modifiers refer to each other endlessly");
}

const RadianceLook& RadianceMaterials::look_of(const std::string& name, const SourcePlace& place) {
  const auto found = looks_.find(name);
  if (found != looks_.end()) return found->second;
  RadianceLook look;
  if (name == "void") {
    look.is_there = false;
  } else {
    if (++open_looks_ > max_chain) place.fail("modifiers refer to each other endlessly");
    const Modifier m = material_of(name, place);
    const int needed = least_radiance_reals(m->type);
    if (is_mixture(m->type)) {
      look = mix(name, *m);
    } else if (needed < 0) {
      look.is_there = false;
    } else {
      if (m->arguments.reals.size() < size_t(needed))
        m->place.fail(m->type + " needs " + std::to_string(needed) + " real arguments");
      look = convert(name, *m);
    }
    --open_looks_;
  }
  return looks_[name] = look;
}

RadianceLook RadianceMaterials::look_without_patterns(const std::string& name,
                                                      const SourcePlace& place) {
  RadianceLook look = look_of(name, place);
  if (!look.patterns.empty()) look.emission *= constant_part(look.patterns, true);
  look.patterns.clear();
  return look;
}

RadiancePattern RadianceMaterials::pattern_of(const RadianceLook& look) const {
  RadiancePattern pattern;
  for (const Modifier& p : look.patterns) {
    if (p->type.starts_with("tex")) continue;  // bends normals; no effect on emission
    if (!RadiancePattern::is_evaluated(p->type))
      p->place.fail("a sky's light by \"" + p->type +
                    "\" is not read: give the sky by --sky or --environment");
    pattern.add(*p, folder_);
  }
  return pattern;
}

// Patterns and textures of a material, outermost first.
std::vector<RadianceMaterials::Modifier> RadianceMaterials::patterns_of(
    const RadianceModifier& m) const {
  std::vector<Modifier> out;
  Modifier at = m.modifier == "void" ? nullptr : modifier_below(m);
  for (int i = 0; i < max_chain && at; ++i) {
    if (at->type == "alias") {
      const auto found = modifiers_.find(at->arguments.strings.at(0));
      at = found == modifiers_.end() ? nullptr : found->second;
      continue;
    }
    if (!is_pattern(at->type)) break;
    out.push_back(at);
    at = at->modifier == "void" ? nullptr : modifier_below(*at);
  }
  return out;
}

// Product of the patterns that are constant. Others are left out with a warning.
Rgb RadianceMaterials::constant_part(const std::vector<Modifier>& patterns, bool is_light) {
  Rgb product{1};
  for (const Modifier& p : patterns) {
    std::string why = "is not supported";
    if (RadiancePattern::is_evaluated(p->type)) {
      try {
        RadiancePattern one;
        one.add(*p, folder_);
        if (const auto same = one.constant()) {
          product *= *same;
          continue;
        }
        why = "varies over the surface";
      } catch (const InputError& e) {
        why = "cannot be evaluated (" + e.reason() + ")";
      }
    }
    scene_.warnings.add(
        "\"" + shortened(p->type) + "\" " + why + ": its " +
        (is_light ? "lights shine uniformly (--luminaire NAME=FILE.ies gives them a distribution)"
                  : "materials are shown without it"));
  }
  return product;
}

bool RadianceMaterials::convert_emission(const RadianceModifier& m, RadianceLook& look) {
  const std::vector<double>& v = m.arguments.reals;
  if (m.type != "light" && m.type != "glow" && m.type != "spotlight" && m.type != "illum")
    return false;
  look.emission = emission_of(v);
  if (m.type == "illum")
    scene_.warnings.add("\"illum\" is shown as a light: what is behind it is not seen");
  if (m.type == "glow" && v.size() > 3 && v[3] < 0) {
    scene_.warnings.add(
        "a \"glow\" with a negative radius gives no light: its surfaces are shown black");
    look.emission = Rgb{0};
  }
  if (m.type == "spotlight") {
    look.is_spot = true;
    look.spot_angle_deg = v[3];
    look.spot_axis = m.world.vector({v[4], v[5], v[6]});
    if (!(length(look.spot_axis) > 0) || !(v[3] > 0 && v[3] <= 360))
      m.place.fail("spotlight needs an angle up to 360 and a direction");
  }
  look.patterns = patterns_of(m);
  return true;
}

RadianceLook RadianceMaterials::convert(const std::string& name, const RadianceModifier& m) {
  RadianceLook look;
  if (m.type == "antimatter" || m.type == "mist" || m.type.starts_with("prism")) {
    scene_.warnings.add("material \"" + m.type + "\" is not supported: its surfaces are left out");
    look.is_there = false;
    return look;
  }
  if (m.type == "mirror" && !m.arguments.strings.empty()) {
    look = look_of(m.arguments.strings[0], m.place);
    look.relayed = clamp01(radiance_material(m, scene_.warnings).base_color.value *
                           constant_part(patterns_of(m), false));
    return look;
  }
  Material material;
  if (convert_emission(m, look)) {
    material.base_color.value = Rgb{0};
  } else {
    const bool is_angular = m.type == "BSDF" || m.type == "aBSDF";
    material = is_angular ? radiance_bsdf(m, folder_, scene_.warnings)
                          : radiance_material(m, scene_.warnings);
    material.base_color.value =
        clamp01(material.base_color.value * constant_part(patterns_of(m), false));
  }
  material.name = name;
  look.material = uint32_t(scene_.materials.size());
  scene_.materials.push_back(std::move(material));
  return look;
}

}  // namespace troffer
