// Converts Radiance's modifiers to materials and emission. Used by RadianceReader and
// RadianceSurfaces.
//
// References: [1] "The RADIANCE 5.1 Synthetic Imaging System", §2.1.2 (materials).
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "import/radiance/radiance_pattern.h"
#include "import/radiance/radiance_text.h"
#include "scene/scene.h"

namespace troffer {

// Look of the surfaces with one modifier.
struct RadianceLook {
  bool is_there = true;  // false for void: light passes unchanged
  uint32_t material = 0;
  Rgb emission;
  // `mirror` with an alternate material: reflectance for light from sources. The rest is the
  // alternate's look.
  Rgb relayed;
  // The next three belong to spotlight, which emits only within an angle about an axis.
  bool is_spot = false;
  double spot_angle_deg = 0;
  Vec3d spot_axis;  // its length is the focal distance; in the file's world
  // Patterns on the emission, outermost first.
  std::vector<std::shared_ptr<const RadianceModifier>> patterns;
};

class RadianceMaterials {
 public:
  // `folder` is the scene's, where function files lie.
  RadianceMaterials(Scene& scene, std::string folder) : scene_(scene), folder_(std::move(folder)) {}

  // Defines a modifier. A later one of the same name replaces it for what follows.
  void define(const std::string& name, RadianceModifier modifier);
  static bool is_modifier(const std::string& type);

  // Returns the look of surfaces with the modifier `name`; grey, with a warning, if there is none.
  // Throws InputError, at `place`, for missing arguments and circular modifiers.
  const RadianceLook& look_of(const std::string& name, const SourcePlace& place);
  // Returns the look without patterns: constant ones multiply the emission, others add a warning.
  RadianceLook look_without_patterns(const std::string& name, const SourcePlace& place);
  // Returns the product of a look's patterns. Throws InputError if one of them cannot be evaluated.
  RadiancePattern pattern_of(const RadianceLook& look) const;

 private:
  using Modifier = std::shared_ptr<const RadianceModifier>;

  Scene& scene_;
  std::string folder_;
  std::map<std::string, Modifier> modifiers_;
  // The modifier below each one, as defined when that one was defined.
  std::map<const RadianceModifier*, Modifier> below_;
  // Stands in for undefined modifiers.
  Modifier grey_ = std::make_shared<const RadianceModifier>(
      RadianceModifier{"void", "plastic", {{}, {0.5, 0.5, 0.5, 0, 0}}, {}, {}, {}});
  std::map<std::string, RadianceLook> looks_;
  int open_looks_ = 0;

  Modifier material_of(std::string name, const SourcePlace& place);
  Modifier modifier_below(const RadianceModifier& m) const;
  std::vector<Modifier> patterns_of(const RadianceModifier& m) const;
  RadianceLook convert(const std::string& name, const RadianceModifier& m);
  bool convert_emission(const RadianceModifier& m, RadianceLook& look);
  Rgb constant_part(const std::vector<Modifier>& patterns, bool is_light);
  RadianceLook mix(const std::string& name, const RadianceModifier& m);
  double foreground_share(const RadianceModifier& m);
};

}  // namespace troffer
