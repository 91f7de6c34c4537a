// Radiance's materials -> materials and emission.
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

// What a surface of some modifier is.
struct RadianceLook {
  bool is_there = true;  // void: not for light
  uint32_t material = 0;
  Rgb emission;
  // spotlight: intensity within that angle about that axis only
  bool is_spot = false;
  double spot_angle_deg = 0;
  Vec3d spot_axis;  // as long as its focal distance, in the file's world
  // Patterns that vary the emission, topmost first.
  std::vector<std::shared_ptr<const RadianceModifier>> patterns;
};

class RadianceMaterials {
 public:
  // `folder`: of the scene, where function files lie.
  RadianceMaterials(Scene& scene, std::string folder) : scene_(scene), folder_(std::move(folder)) {}

  // Defines a modifier; a later one of that name replaces it for what follows.
  void define(const std::string& name, RadianceModifier modifier);
  static bool is_modifier(const std::string& type);

  // The look of surfaces whose modifier is `name`; grey, with a warning, where there is none.
  // InputError at `place`: arguments that are missing, modifiers that refer to each other.
  const RadianceLook& look_of(const std::string& name, const SourcePlace& place);
  // The same without patterns: those that are the same everywhere multiply the emission, others are
  // named in a warning.
  RadianceLook even_look_of(const std::string& name, const SourcePlace& place);
  // The product of a look's patterns. InputError: one of them cannot be evaluated.
  RadiancePattern pattern_of(const RadianceLook& look) const;

 private:
  using Modifier = std::shared_ptr<const RadianceModifier>;

  Scene& scene_;
  std::string folder_;
  std::map<std::string, Modifier> modifiers_;
  // The modifier each one modifies, as it was when that one was defined.
  std::map<const RadianceModifier*, Modifier> below_;
  // For what another file defines.
  Modifier grey_ = std::make_shared<const RadianceModifier>(
      RadianceModifier{"void", "plastic", {{}, {0.5, 0.5, 0.5, 0, 0}}, {}, {}});
  std::map<std::string, RadianceLook> looks_;
  int open_looks_ = 0;

  Modifier material_of(std::string name, const SourcePlace& place);
  Modifier modifier_below(const RadianceModifier& m) const;
  std::vector<Modifier> patterns_of(const RadianceModifier& m) const;
  RadianceLook convert(const std::string& name, const RadianceModifier& m);
  bool convert_emission(const RadianceModifier& m, RadianceLook& look);
  Rgb even_part(const std::vector<Modifier>& patterns, bool is_light);
  RadianceLook mix(const std::string& name, const RadianceModifier& m);
  double foreground_share(const RadianceModifier& m);
};

}  // namespace troffer
