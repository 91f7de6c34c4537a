#include "import/hbjson/hbjson_parts.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"

namespace troffer {

namespace {

const char* const window = "generic_exterior_window_vis_0.64";
const char* const inner_window = "generic_interior_window_vis_0.88";
const char* const door = "generic_opaque_door_0.50";
const ModifierSlot indoor_shade{"shade_set", "interior_modifier", "generic_interior_shade_0.50"};
const ModifierSlot outdoor_shade{"shade_set", "exterior_modifier", "generic_exterior_shade_0.35"};
const ModifierSlot context_shade{"", "context_modifier", "generic_context_0.20"};

// Type of the boundary condition, such as "Outdoors".
std::string boundary_of(const JsonNode& part) {
  const auto boundary = part.find_value("boundary_condition");
  return boundary ? boundary->string_or("type", "Outdoors") : "Outdoors";
}

ModifierSlot slot_of_face(const std::string& type, bool is_outdoors) {
  const char* member = is_outdoors ? "exterior_modifier" : "interior_modifier";
  if (type == "Floor") return {"floor_set", member, "generic_floor_0.20"};
  if (type == "RoofCeiling") return {"roof_ceiling_set", member, "generic_ceiling_0.80"};
  if (type == "AirBoundary") return {"", "air_boundary_modifier", "air_boundary"};
  return {"wall_set", member, "generic_wall_0.50"};
}

ModifierSlot slot_of_aperture(const JsonNode& aperture, const std::string& face_type,
                              bool is_outdoors) {
  const std::string set = "aperture_set";
  if (!is_outdoors) return {set, "interior_modifier", inner_window};
  if (aperture.bool_or("is_operable", false)) return {set, "operable_modifier", window};
  const bool is_skylight = face_type == "RoofCeiling" || face_type == "Floor";
  return {set, is_skylight ? "skylight_modifier" : "window_modifier", window};
}

ModifierSlot slot_of_door(const JsonNode& part, const std::string& face_type, bool is_outdoors) {
  const std::string set = "door_set";
  const bool is_glass = part.bool_or("is_glass", false);
  if (!is_outdoors)
    return is_glass ? ModifierSlot{set, "interior_glass_modifier", inner_window}
                    : ModifierSlot{set, "interior_modifier", door};
  if (is_glass) return {set, "exterior_glass_modifier", window};
  const bool is_overhead = face_type == "RoofCeiling" || face_type == "Floor";
  return {set, is_overhead ? "overhead_modifier" : "exterior_modifier", door};
}

std::string name_of_part(const JsonNode& part) {
  const auto id = part.find_value("identifier");
  return id ? id->as_string() : std::string("part");
}

std::optional<JsonNode> radiance_of(const JsonNode& part) {
  const auto properties = part.find_value("properties");
  return properties ? properties->find_value("radiance") : std::nullopt;
}

[[noreturn]] void fail_of_state(const std::string& group, size_t states) {
  throw UsageError(
      fmt::format("--state: group '{}' has the states 0 to {}", printable(group), states - 1));
}

}  // namespace

// Notes the group of a dynamic part, and returns its state that is shown.
HbjsonParts::DynamicState HbjsonParts::state_of(const JsonNode& radiance, bool is_window) {
  const auto list = radiance.find_value("states");
  const size_t count = list ? list->size() : 0;
  const auto group = radiance.find_value("dynamic_group_identifier");
  if (!group) {
    if (count > 0) scene_.warnings.add("states of a part without a dynamic group are left out");
    return {};
  }
  const std::string& name = group->as_string();
  auto known = std::find_if(scene_.dynamic_groups.begin(), scene_.dynamic_groups.end(),
                            [&](const DynamicGroup& g) { return g.name == name; });
  if (known == scene_.dynamic_groups.end())
    known = scene_.dynamic_groups.insert(known, DynamicGroup{name, {"state 0"}, 0, false});
  known->has_windows = known->has_windows || is_window;
  for (size_t i = 0; i < count; ++i) {
    if (i >= known->states.size()) known->states.push_back(fmt::format("state {}", i));
    const auto modifier = list->element(i).find_value("modifier");
    if (modifier && modifier->is_string()) known->states[i] = modifier->as_string();
  }
  if (states_.blocked.contains(name)) return {std::nullopt, true};
  const auto chosen = states_.shown.find(name);
  const size_t shown = chosen == states_.shown.end() ? 0 : chosen->second;
  known->shown = shown;
  if (count == 0) return {};
  if (shown >= count) fail_of_state(name, count);
  return {list->element(shown), false};
}

void HbjsonParts::check_states() const {
  for (const auto& [name, state] : states_.shown) {
    const auto is_it = [&group = name](const DynamicGroup& g) { return g.name == group; };
    const auto known_group =
        std::find_if(scene_.dynamic_groups.begin(), scene_.dynamic_groups.end(), is_it);
    if (known_group != scene_.dynamic_groups.end()) {
      if (state >= known_group->states.size()) fail_of_state(name, known_group->states.size());
      continue;
    }
    std::string known;
    for (const DynamicGroup& g : scene_.dynamic_groups)
      known += (known.empty() ? "" : ", ") + printable(g.name);
    throw UsageError(fmt::format("--state: the model has no group '{}'{}", printable(name),
                                 known.empty() ? std::string() : "; it has " + known));
  }
}

HbjsonParts::Shown HbjsonParts::shown(const JsonNode& part, const std::string& room_set,
                                      const ModifierSlot& slot, bool is_window) {
  const auto radiance = radiance_of(part);
  Shown out;
  if (radiance) {
    const DynamicState dynamic = state_of(*radiance, is_window);
    if (dynamic.is_blocked) return {HbjsonModifiers::black, std::nullopt};
    out.state = dynamic.state;
  }
  auto own = radiance ? radiance->find_value("modifier") : std::nullopt;
  if (out.state)
    if (const auto of_state = out.state->find_value("modifier")) own = of_state;
  out.modifier = modifiers_.name_of(own, room_set, slot);
  return out;
}

void HbjsonParts::add_polygon(const JsonNode& place, const std::string& modifier,
                              const std::string& name, Corners corners, bool is_turned) {
  if (modifiers_.is_open(modifier)) return;
  RadianceModifier p;
  p.modifier = modifier;
  p.type = "polygon";
  try {
    surfaces_.add_polygon(p, name, std::move(corners), is_turned && !modifiers_.emits(modifier));
  } catch (const InputError& e) {
    place.fail(e.reason());
  }
}

void HbjsonParts::add_flat(const JsonNode& part, const std::string& modifier, bool is_turned) {
  const JsonNode geometry = part.member("geometry");
  const HbjsonFace face = read_hbjson_face(geometry, unit_m_);
  const auto pieces = face.holes.empty() ? std::vector<Corners>{face.boundary}
                                         : without_openings(face.boundary, face.holes);
  for (const Corners& piece : pieces)
    add_polygon(geometry, modifier, name_of_part(part), piece, is_turned);
}

void HbjsonParts::add_state_shades(const Shown& shown, const std::string& room_set) {
  const auto shades = shown.state ? shown.state->find_value("shades") : std::nullopt;
  for (size_t i = 0; shades && i < shades->size(); ++i) {
    const JsonNode shade = shades->element(i);
    add_flat(shade, modifiers_.name_of(shade.find_value("modifier"), room_set, outdoor_shade),
             false);
  }
}

void HbjsonParts::add_opening(const JsonNode& opening, bool is_door, const std::string& face_type,
                              const std::string& room_set) {
  const bool is_outdoors = boundary_of(opening) == "Outdoors";
  const Shown s = shown(opening, room_set,
                        is_door ? slot_of_door(opening, face_type, is_outdoors)
                                : slot_of_aperture(opening, face_type, is_outdoors),
                        true);
  add_flat(opening, s.modifier, true);
  add_state_shades(s, room_set);
}

void HbjsonParts::add_orphaned_opening(const JsonNode& opening, bool is_door) {
  add_opening(opening, is_door, "Wall", "");
  add_shades_of(opening, "");
}

void HbjsonParts::add_face(const JsonNode& face, const std::string& room_set) {
  const auto given_type = face.find_value("face_type");
  const std::string type = given_type ? given_type->as_string() : "Wall";
  const std::string boundary = boundary_of(face);
  bool is_second = false;
  if (boundary == "Surface") {
    is_second = partners_.contains(name_of_part(face));
    const auto partner = face.member("boundary_condition").find_value("boundary_condition_objects");
    if (partner && partner->size() > 0) partners_.insert(partner->element(0).as_string());
  }
  const JsonNode geometry = face.member("geometry");
  HbjsonFace shape = read_hbjson_face(geometry, unit_m_);
  std::vector<Corners> openings = std::move(shape.holes);
  for (const bool is_door : {false, true}) {
    const auto list = face.find_value(is_door ? "doors" : "apertures");
    for (size_t i = 0; list && i < list->size(); ++i) {
      const JsonNode opening = list->element(i);
      openings.push_back(read_hbjson_face(opening.member("geometry"), unit_m_).boundary);
      if (!is_second) add_opening(opening, is_door, type, room_set);
    }
  }
  if (is_second) {
    // A distance of 0 would leave the two faces in one place.
    const Vec3d shift = normal_of(shape.boundary) * (-2 * std::max(tolerance_, 1e-4));
    for (Vec3d& c : shape.boundary) c += shift;
  }
  const Shown s = shown(face, room_set, slot_of_face(type, boundary == "Outdoors"));
  for (const Corners& piece : without_openings(shape.boundary, openings))
    add_polygon(geometry, s.modifier, name_of_part(face), piece, true);
}

void HbjsonParts::add_shade(const JsonNode& shade, const std::string& room_set, bool is_indoor) {
  const Shown s = shown(shade, room_set, is_indoor ? indoor_shade : outdoor_shade);
  add_flat(shade, s.modifier, false);
  add_state_shades(s, room_set);
}

void HbjsonParts::add_context_shade(const JsonNode& shade) {
  const bool is_detached = shade.bool_or("is_detached", false);
  const Shown s = shown(shade, "", is_detached ? context_shade : outdoor_shade);
  add_flat(shade, s.modifier, false);
  add_state_shades(s, "");
}

void HbjsonParts::add_shade_mesh(const JsonNode& mesh) {
  const bool is_detached = mesh.bool_or("is_detached", true);
  const Shown s = shown(mesh, "", is_detached ? context_shade : outdoor_shade);
  const JsonNode geometry = mesh.member("geometry");
  const Corners vertices = read_hbjson_points(geometry.member("vertices"), unit_m_, 3);
  const JsonNode faces = geometry.member("faces");
  for (size_t i = 0; i < faces.size(); ++i) {
    const JsonNode face = faces.element(i);
    if (face.size() < 3 || face.size() > 4) face.fail("should have 3 or 4 vertices");
    Corners corners;
    for (size_t k = 0; k < face.size(); ++k)
      corners.push_back(vertices[face.element(k).as_index(vertices.size(), "vertices")]);
    add_polygon(face, s.modifier, name_of_part(mesh), std::move(corners), false);
  }
}

void HbjsonParts::add_shades_of(const JsonNode& owner, const std::string& room_set) {
  for (const bool is_indoor : {true, false}) {
    const auto list = owner.find_value(is_indoor ? "indoor_shades" : "outdoor_shades");
    for (size_t i = 0; list && i < list->size(); ++i)
      add_shade(list->element(i), room_set, is_indoor);
  }
  for (const char* parts : {"apertures", "doors"}) {
    const auto list = owner.find_value(parts);
    for (size_t i = 0; list && i < list->size(); ++i) add_shades_of(list->element(i), room_set);
  }
}

void HbjsonParts::finish(const std::string& name) {
  const size_t first = scene_.meshes.size();
  surfaces_.finish();
  for (size_t i = first; i < scene_.meshes.size(); ++i) scene_.meshes[i].name = name;
}

}  // namespace troffer
