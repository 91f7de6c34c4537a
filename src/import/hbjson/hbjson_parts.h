// Surfaces of a Honeybee model: faces with apertures, doors and shades, and their dynamic states.
// Used by the importer of HBJSON, which walks through rooms and orphaned parts.
#pragma once

#include <map>
#include <set>
#include <string>

#include "import/hbjson/hbjson_face.h"
#include "import/hbjson/hbjson_modifiers.h"
#include "import/radiance/radiance_surface.h"

namespace troffer {

// States of dynamic groups by name, as the user asks for them. Other groups show state 0.
struct HbjsonStates {
  const std::map<std::string, size_t>& shown;
  const std::set<std::string>& blocked;  // groups whose parts are black
};

class HbjsonParts {
 public:
  // All arguments must outlive this object. tolerance: that of the model, metres.
  HbjsonParts(double unit_m, double tolerance, const HbjsonStates& states,
              HbjsonModifiers& modifiers, RadianceSurfaces& surfaces, Scene& scene)
      : unit_m_(unit_m),
        tolerance_(tolerance),
        states_(states),
        modifiers_(modifiers),
        surfaces_(surfaces),
        scene_(scene) {}

  // Each adds a part and what belongs to it. room_set: modifier set of the room, or "".
  void add_face(const JsonNode& face, const std::string& room_set);
  void add_orphaned_opening(const JsonNode& opening, bool is_door);
  void add_shade(const JsonNode& shade, const std::string& room_set, bool is_indoor);
  void add_context_shade(const JsonNode& shade);
  void add_shade_mesh(const JsonNode& mesh);
  // Adds the shades of the list members "indoor_shades" and "outdoor_shades".
  void add_shades_of(const JsonNode& owner, const std::string& room_set);
  // Names the meshes of the parts since the last call.
  void finish(const std::string& name);
  // Throws UsageError if a state was chosen for a group that there is not.
  void check_states() const;

 private:
  double unit_m_, tolerance_;
  HbjsonStates states_;
  HbjsonModifiers& modifiers_;
  RadianceSurfaces& surfaces_;
  Scene& scene_;
  std::set<std::string> partners_;  // faces whose partner in another room has been added

  // Appearance of a part: its modifier, and further shades of its state.
  struct Shown {
    std::string modifier;
    std::optional<JsonNode> state;
  };
  Shown shown(const JsonNode& part, const std::string& room_set, const ModifierSlot& slot,
              bool is_window = false);
  // State that a part of a dynamic group shows; a part without states has none.
  struct DynamicState {
    std::optional<JsonNode> state;
    bool is_blocked = false;
  };
  DynamicState state_of(const JsonNode& radiance, bool is_window);
  void add_opening(const JsonNode& opening, bool is_door, const std::string& face_type,
                   const std::string& room_set);
  void add_state_shades(const Shown& shown, const std::string& room_set);
  // Adds a polygon. is_turned: its front is made the side that its corners wind clockwise from,
  // unless it emits.
  void add_polygon(const JsonNode& place, const std::string& modifier, const std::string& name,
                   Corners corners, bool is_turned);
  void add_flat(const JsonNode& part, const std::string& modifier, bool is_turned);
};

}  // namespace troffer
