#include "import/hbjson/hbjson.h"

#include <fmt/format.h>

#include <set>

#include "base/error.h"
#include "import/file.h"
#include "import/hbjson/hbjson_assets.h"
#include "import/hbjson/hbjson_parts.h"
#include "import/recentre.h"

namespace troffer {

namespace {

constexpr uint64_t max_model_bytes = uint64_t(1) << 30;

// Length of a unit of the model, metres.
double unit_of(const JsonNode& model) {
  const auto units = model.find_value("units");
  if (!units) return 1;
  static const std::map<std::string, double> known{{"Meters", 1},
                                                   {"Millimeters", 1e-3},
                                                   {"Centimeters", 1e-2},
                                                   {"Feet", 0.3048},
                                                   {"Inches", 0.0254}};
  const auto found = known.find(units->as_string());
  if (found == known.end()) units->fail("is not Meters, Millimeters, Centimeters, Feet or Inches");
  return found->second;
}

void warn_of_others(const JsonNode& node, const std::set<std::string>& known, const char* of,
                    WarningLog& warnings) {
  for (const std::string& key : node.keys())
    if (!known.contains(key) && node.find_value(key))
      warnings.add(fmt::format("{}: '{}' is not read", of, printable(key)));
}

std::string shown_name(const JsonNode& part) {
  const auto name = part.find_value("display_name");
  return name ? name->as_string() : part.member("identifier").as_string();
}

// Calls add(part) for the elements of a list that may be missing.
template <class Add>
void for_each_part(const JsonNode& owner, const char* list, const Add& add) {
  const auto parts = owner.find_value(list);
  for (size_t i = 0; parts && i < parts->size(); ++i) add(parts->element(i));
}

void add_room(const JsonNode& room, HbjsonParts& parts) {
  const std::string name = shown_name(room);
  const auto properties = room.find_value("properties");
  const auto radiance = properties ? properties->find_value("radiance") : std::nullopt;
  const auto given = radiance ? radiance->find_value("modifier_set") : std::nullopt;
  const std::string set = given ? given->as_string() : "";
  for_each_part(room, "faces", [&](const JsonNode& face) { parts.add_face(face, set); });
  parts.finish(name);
  for_each_part(room, "faces", [&](const JsonNode& face) { parts.add_shades_of(face, set); });
  parts.add_shades_of(room, set);
  parts.finish(name + " shades");
}

void add_orphans(const JsonNode& model, HbjsonParts& parts) {
  for_each_part(model, "orphaned_faces", [&](const JsonNode& face) {
    parts.add_face(face, "");
    parts.finish(shown_name(face));
    parts.add_shades_of(face, "");
  });
  for_each_part(model, "orphaned_apertures",
                [&](const JsonNode& part) { parts.add_orphaned_opening(part, false); });
  for_each_part(model, "orphaned_doors",
                [&](const JsonNode& part) { parts.add_orphaned_opening(part, true); });
  parts.finish("orphaned openings");
  for_each_part(model, "orphaned_shades",
                [&](const JsonNode& shade) { parts.add_context_shade(shade); });
  for_each_part(model, "shade_meshes", [&](const JsonNode& mesh) { parts.add_shade_mesh(mesh); });
  parts.finish("shades");
}

void read_model(const JsonNode& model, const HbjsonStates& states, Scene& scene,
                PlacedBounds& bounds) {
  const double unit_m = unit_of(model);
  warn_of_others(model,
                 {"type", "identifier", "display_name", "user_data", "version", "units",
                  "tolerance", "angle_tolerance", "rooms", "orphaned_faces", "orphaned_shades",
                  "orphaned_apertures", "orphaned_doors", "shade_meshes", "properties"},
                 "model", scene.warnings);
  RadianceMaterials materials(scene, folder_of(scene.file));
  HbjsonModifiers modifiers(model, unit_m, materials, scene.warnings);
  RadianceSurfaces surfaces(scene, bounds, materials);
  const auto tolerance = model.find_value("tolerance");
  HbjsonParts parts(unit_m, tolerance ? tolerance->as_number() * unit_m : 0.01, states, modifiers,
                    surfaces, scene);
  for_each_part(model, "rooms", [&](const JsonNode& room) { add_room(room, parts); });
  add_orphans(model, parts);
  parts.check_states();
  const auto properties = model.find_value("properties");
  const auto radiance = properties ? properties->find_value("radiance") : std::nullopt;
  if (!radiance) return;
  warn_of_others(
      *radiance,
      {"type", "global_modifier_set", "modifiers", "modifier_sets", "sensor_grids", "views"},
      "Radiance properties", scene.warnings);
  add_hbjson_grids(*radiance, unit_m, scene);
  add_hbjson_views(*radiance, unit_m, scene);
}

}  // namespace

Scene import_hbjson(const std::string& path, const std::map<std::string, size_t>& states,
                    const std::set<std::string>& blocked) {
  std::string text = read_text_file(path, max_model_bytes);
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
  const JsonDocument document(path, std::move(text));
  const JsonNode model = document.root();
  if (!model.is_object() || !model.find("type") || !model.member("type").is_string() ||
      model.member("type").as_string() != "Model")
    throw InputError(path, 1, 1, "is not a Honeybee model: it has no \"type\": \"Model\"");
  return import_recentred([&](Scene& scene, PlacedBounds& bounds) {
    scene.file = path;
    read_model(model, {states, blocked}, scene, bounds);
  });
}

}  // namespace troffer
