// Radiance modifiers of a Honeybee model, and the rules by which its surfaces get them: their own
// modifier, that of the room's modifier set, of the model's global set, or Honeybee's generic one.
// Used by the importer of HBJSON.
//
// References: [1] honeybee-schema, radiance/modifier.py and radiance/modifierset.py; [2]
//   honeybee-radiance, modifierset.py (which part of a set a surface takes).
#pragma once

#include <map>
#include <set>
#include <string>

#include "import/gltf/gltf_json.h"
#include "import/radiance/radiance_material.h"

namespace troffer {

// Part of a modifier set, such as "wall_set" and "exterior_modifier".
struct ModifierSlot {
  std::string set, member;  // set "": the member is in the modifier set itself
  std::string generic;      // Honeybee's own modifier, if no set has one
};

class HbjsonModifiers {
 public:
  static constexpr const char* black = "troffer black window";  // reflects and transmits nothing

  // All arguments must outlive this object. Defines all modifiers of the model in `materials`.
  // unit_m: length of a unit of the model, metres.
  HbjsonModifiers(const JsonNode& model, double unit_m, RadianceMaterials& materials,
                  WarningLog& warnings);

  // Returns the name of the modifier of a surface. `owner` has the member "properties", `state` the
  // member "modifier" of a dynamic state, or is the same as `properties`. room_set: name of the
  // room's modifier set; "": none.
  std::string name_of(const std::optional<JsonNode>& own, const std::string& room_set,
                      const ModifierSlot& slot);
  // True for modifiers that let all light pass, such as those of air boundaries.
  bool is_open(const std::string& name) const { return open_.contains(name); }
  bool emits(const std::string& name) const { return emitting_.contains(name); }

 private:
  double unit_m_;
  RadianceMaterials& materials_;
  WarningLog& warnings_;
  std::map<std::string, JsonNode> sets_;
  std::optional<JsonNode> global_;
  std::set<std::string> defined_, open_, emitting_;
  size_t inline_modifiers_ = 0;

  void define_all(const JsonNode& list);
  std::string define(const JsonNode& modifier);
  void define_generic();
  void fill(const JsonNode& modifier, const std::string& type, RadianceModifier& out);
  void fill_bsdf(const JsonNode& modifier, RadianceModifier& out);
  // Name of a modifier given by its name or as an object.
  std::string name_or_object(const JsonNode& value);
  std::string in_set(const JsonNode& set, const ModifierSlot& slot);
};

}  // namespace troffer
