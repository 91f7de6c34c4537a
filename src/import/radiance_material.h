// Radiance's materials -> materials and emission.
//
// References: [1] "The RADIANCE 5.1 Synthetic Imaging System", §2.1.2 (materials); [2] CIE Standard
//   General Sky, by Radiance's skybright.cal.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "import/radiance_text.h"
#include "scene/scene.h"

namespace troffer {

// A modifier: material, pattern, texture, mixture or alias.
struct RadianceModifier {
  std::string modifier, type;
  RadianceArguments arguments;
  SourcePlace place;
};

// What a surface of some modifier is.
struct RadianceLook {
  bool is_there = true;  // void: not for light
  uint32_t material = 0;
  Rgb emission;
  // spotlight: intensity within that angle about that axis only
  bool is_spot = false;
  double spot_angle_deg = 0;
  Vec3d spot_axis;
  // Of sources: a sky's pattern over the emission, of skybright.cal.
  const RadianceModifier* sky = nullptr;
};

class RadianceMaterials {
 public:
  explicit RadianceMaterials(Scene& scene) : scene_(scene) {}

  // Defines a modifier; a later one of that name replaces it for what follows.
  void define(const std::string& name, RadianceModifier modifier);
  static bool is_modifier(const std::string& type);

  // The look of surfaces whose modifier is `name`; grey, with a warning, where there is none.
  // InputError at `place`: arguments that are missing, modifiers that refer to each other.
  const RadianceLook& look_of(const std::string& name, const SourcePlace& place);

 private:
  Scene& scene_;
  std::map<std::string, RadianceModifier> modifiers_;
  // For what another file defines.
  RadianceModifier grey_{"void", "plastic", {{}, {0.5, 0.5, 0.5, 0, 0}}, {}};
  std::map<std::string, RadianceLook> looks_;

  const RadianceModifier& material_of(std::string name, const SourcePlace& place);
  RadianceLook convert(const std::string& name, const RadianceModifier& m);
  bool convert_emission(const RadianceModifier& m, RadianceLook& look);
  Material convert_surface(const RadianceModifier& m);
  Material translucent(const std::vector<double>& v);
  void note_patterns(const RadianceModifier& m, RadianceLook& look);
};

}  // namespace troffer
