#include "import/hbjson/hbjson_modifiers.h"

#include <fmt/format.h>

#include <array>

#include "import/window_xml.h"

namespace troffer {

namespace {

struct Generic {
  const char* name;
  const char* type;
  std::array<double, 3> reals;
};

// Honeybee's generic modifiers; visible transmittances .64 and .88 of windows as transmissivities.
constexpr Generic generics[] = {
    {"generic_floor_0.20", "plastic", {0.2, 0.2, 0.2}},
    {"generic_wall_0.50", "plastic", {0.5, 0.5, 0.5}},
    {"generic_ceiling_0.80", "plastic", {0.8, 0.8, 0.8}},
    {"generic_opaque_door_0.50", "plastic", {0.5, 0.5, 0.5}},
    {"generic_interior_shade_0.50", "plastic", {0.5, 0.5, 0.5}},
    {"generic_exterior_shade_0.35", "plastic", {0.35, 0.35, 0.35}},
    {"generic_context_0.20", "plastic", {0.2, 0.2, 0.2}},
    {HbjsonModifiers::black, "plastic", {0, 0, 0}},
    {"generic_exterior_window_vis_0.64", "glass", {0.6975761815, 0.6975761815, 0.6975761815}},
    {"generic_interior_window_vis_0.88", "glass", {0.9584154329, 0.9584154329, 0.9584154329}},
};
constexpr const char* generic_air = "air_boundary";

// Names of the numbers of each type of modifier, in Radiance's order, with their defaults.
struct Field {
  const char* name;
  double fallback;
};
const std::map<std::string, std::pair<const char*, std::vector<Field>>>& types() {
  static const std::vector<Field> opaque{{"r_reflectance", 0},
                                         {"g_reflectance", 0},
                                         {"b_reflectance", 0},
                                         {"specularity", 0},
                                         {"roughness", 0}};
  static std::vector<Field> metal = opaque, trans = opaque;
  static const std::vector<Field> light{{"r_emittance", 0}, {"g_emittance", 0}, {"b_emittance", 0}};
  static const std::vector<Field> glow{
      {"r_emittance", 0}, {"g_emittance", 0}, {"b_emittance", 0}, {"max_radius", 0}};
  static const std::map<std::string, std::pair<const char*, std::vector<Field>>> table = [] {
    metal[3].fallback = 0.9;
    trans.push_back({"transmitted_diff", 0});
    trans.push_back({"transmitted_spec", 0});
    return std::map<std::string, std::pair<const char*, std::vector<Field>>>{
        {"Plastic", {"plastic", opaque}},
        {"Metal", {"metal", metal}},
        {"Trans", {"trans", trans}},
        {"Glass",
         {"glass",
          {{"r_transmissivity", 0},
           {"g_transmissivity", 0},
           {"b_transmissivity", 0},
           {"refraction_index", 1.52}}}},
        {"Mirror", {"mirror", {{"r_reflectance", 1}, {"g_reflectance", 1}, {"b_reflectance", 1}}}},
        {"Light", {"light", light}},
        {"Glow", {"glow", glow}}};
  }();
  return table;
}

double number_of(const JsonNode& modifier, const Field& field) {
  const auto value = modifier.find_value(field.name);
  return value ? value->as_number() : field.fallback;
}

bool is_white(const std::vector<double>& v) {
  return v[0] >= 1 && v[1] >= 1 && v[2] >= 1;
}

// True if light passes as if there was nothing.
bool lets_all_pass(const RadianceModifier& m) {
  const std::vector<double>& v = m.arguments.reals;
  if (m.type == "trans") return is_white(v) && v[3] <= 0 && v[5] >= 1 && v[6] >= 1;
  return m.type == "glass" && is_white(v);
}

}  // namespace

HbjsonModifiers::HbjsonModifiers(const JsonNode& model, double unit_m, RadianceMaterials& materials,
                                 WarningLog& warnings)
    : unit_m_(unit_m), materials_(materials), warnings_(warnings) {
  define_generic();
  const auto properties = model.find_value("properties");
  const auto radiance = properties ? properties->find_value("radiance") : std::nullopt;
  if (!radiance) {
    warnings_.add("the model has no Radiance properties: Honeybee's generic modifiers are used");
    return;
  }
  global_ = radiance->find_value("global_modifier_set");
  if (global_)
    if (const auto list = global_->find_value("modifiers")) define_all(*list);
  if (const auto list = radiance->find_value("modifiers")) define_all(*list);
  const auto sets = radiance->find_value("modifier_sets");
  for (size_t i = 0; sets && i < sets->size(); ++i) {
    const JsonNode set = sets->element(i);
    sets_.insert_or_assign(set.member("identifier").as_string(), set);
  }
}

void HbjsonModifiers::define_generic() {
  for (const Generic& g : generics) {
    RadianceModifier m;
    m.modifier = "void";
    m.type = g.type;
    m.arguments.reals.assign(g.reals.begin(), g.reals.end());
    if (m.type == "plastic") m.arguments.reals.resize(5, 0.0);
    materials_.define(g.name, std::move(m));
    defined_.insert(g.name);
  }
  open_.insert(generic_air);
  defined_.insert(generic_air);
}

void HbjsonModifiers::define_all(const JsonNode& list) {
  for (size_t i = 0; i < list.size(); ++i) define(list.element(i));
}

// Returns the modifier's name: "void" for void.
std::string HbjsonModifiers::define(const JsonNode& modifier) {
  const std::string type = modifier.member("type").as_string();
  if (type == "Void") return "void";
  const auto id = modifier.find_value("identifier");
  const std::string name = id ? id->as_string() : fmt::format("modifier {}", inline_modifiers_++);
  RadianceModifier out;
  out.modifier = "void";
  out.place.file = std::make_shared<const std::string>(modifier.file());
  fill(modifier, type, out);
  if (const auto below = modifier.find_value("modifier"))
    if (!below->is_object() || below->string_or("type", "") != "Void")
      warnings_.add("modifiers of materials are left out");
  open_.erase(name);
  emitting_.erase(name);
  if (lets_all_pass(out)) open_.insert(name);
  if (out.type == "light" || out.type == "glow") emitting_.insert(name);
  defined_.insert(name);
  materials_.define(name, std::move(out));
  return name;
}

void HbjsonModifiers::fill(const JsonNode& modifier, const std::string& type,
                           RadianceModifier& out) {
  if (type == "BSDF" || type == "aBSDF") {
    fill_bsdf(modifier, out);
    return;
  }
  const auto known = types().find(type);
  if (known == types().end()) {
    warnings_.add("modifier type \"" + printable(type) + "\" is not known: shown diffuse grey");
    out.type = "plastic";
    out.arguments.reals = {0.5, 0.5, 0.5, 0, 0};
    return;
  }
  out.type = known->second.first;
  for (const Field& field : known->second.second)
    out.arguments.reals.push_back(number_of(modifier, field));
  if (type == "Glow") out.arguments.reals[3] *= unit_m_;
  if (type != "Mirror") return;
  if (const auto other = modifier.find_value("alternate_material"))
    out.arguments.strings = {name_or_object(*other)};
}

// Reads the matrices and the up vector. A proxy of other geometry (thickness) is shown in place of
// that geometry.
void HbjsonModifiers::fill_bsdf(const JsonNode& modifier, RadianceModifier& out) {
  const auto thickness = modifier.find_value("thickness");
  if (thickness && thickness->as_number() != 0)
    warnings_.add(
        "\"BSDF\" with a thickness: it scatters light, and does not pass views to the "
        "geometry that it stands for");
  const auto up = modifier.find_value("up_orientation");
  const std::vector<double> way = up ? up->as_numbers(3) : std::vector<double>{0.01, 0.01, 1};
  if (const auto transform = modifier.find_value("transform"))
    warnings_.add("\"BSDF\": its transform is left out");
  out.type = "aBSDF";
  out.arguments.strings = {""};
  for (const double v : way) out.arguments.strings.push_back(fmt::format("{}", v));
  out.arguments.strings.emplace_back(".");
  const JsonNode data = modifier.member("bsdf_data");
  try {
    out.bsdf = std::make_shared<const AngularBsdf>(
        read_window_xml(modifier.string_or("identifier", "BSDF"), data.as_string(), warnings_));
  } catch (const InputError& e) {
    data.fail(e.reason());
  }
  for (const char* part :
       {"front_diffuse_reflectance", "back_diffuse_reflectance", "diffuse_transmittance"}) {
    const auto extra = modifier.find_value(part);
    for (const double v : extra ? extra->as_numbers(3) : std::vector<double>(3))
      out.arguments.reals.push_back(v);
  }
}

std::string HbjsonModifiers::name_or_object(const JsonNode& value) {
  if (!value.is_string()) {
    const auto id = value.find_value("identifier");
    return id && defined_.contains(id->as_string()) ? id->as_string() : define(value);
  }
  const std::string& name = value.as_string();
  if (name != "void" && !defined_.contains(name))
    warnings_.add("no modifier '" + printable(name) + "' is defined: shown diffuse grey");
  return name;
}

std::string HbjsonModifiers::in_set(const JsonNode& set, const ModifierSlot& slot) {
  const auto part = slot.set.empty() ? std::optional<JsonNode>(set) : set.find_value(slot.set);
  const auto value = part ? part->find_value(slot.member) : std::nullopt;
  return value ? name_or_object(*value) : std::string();
}

std::string HbjsonModifiers::name_of(const std::optional<JsonNode>& own,
                                     const std::string& room_set, const ModifierSlot& slot) {
  if (own) return name_or_object(*own);
  if (!room_set.empty()) {
    const auto set = sets_.find(room_set);
    if (set == sets_.end())
      warnings_.add("no modifier set '" + printable(room_set) + "' is defined");
    else if (std::string name = in_set(set->second, slot); !name.empty())
      return name;
  }
  if (global_)
    if (std::string name = in_set(*global_, slot); !name.empty()) return name;
  return slot.generic;
}

}  // namespace troffer
