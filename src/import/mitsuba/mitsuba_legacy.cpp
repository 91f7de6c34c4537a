#include "import/mitsuba/mitsuba_legacy.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace troffer {

namespace {

struct Renamed {
  std::string_view of;  // type of the plugin; "" for any
  std::string_view from, to;
};
constexpr std::array types_before_0_3{
    Renamed{"", "lambertian", "diffuse"},        Renamed{"", "microfacet", "roughplastic"},
    Renamed{"", "roughmetal", "roughconductor"}, Renamed{"", "roughglass", "roughdielectric"},
    Renamed{"", "composite", "mixturebsdf"},     Renamed{"", "exrtexture", "bitmap"},
    Renamed{"", "ldrtexture", "bitmap"},
};
constexpr std::array names_before_0_3{
    Renamed{"sphere", "inverted", "flip_normals"},
    Renamed{"cylinder", "p1", "p0"},
    Renamed{"cylinder", "p2", "p1"},
    Renamed{"checkerboard", "bright_color", "color0"},
    Renamed{"checkerboard", "dark_color", "color1"},
    Renamed{"gridtexture", "bright_color", "color0"},
    Renamed{"gridtexture", "dark_color", "color1"},
    Renamed{"ward", "alpha_x", "alpha_u"},
    Renamed{"ward", "alpha_y", "alpha_v"},
    Renamed{"roughplastic", "alpha_b", "alpha"},
    Renamed{"roughconductor", "alpha_b", "alpha"},
    Renamed{"roughconductor", "ior", "eta"},
    Renamed{"roughdielectric", "alpha_b", "alpha"},
    Renamed{"", "size_multiplier", "scale"},
};
constexpr std::array names_before_0_4{
    Renamed{"area", "intensity", "radiance"},          Renamed{"constant", "intensity", "radiance"},
    Renamed{"directional", "intensity", "irradiance"}, Renamed{"", "focus_depth", "focus_distance"},
    Renamed{"", "intensity_scale", "scale"},           Renamed{"", "density_multiplier", "scale"},
};

template <size_t N>
void rename(std::string& name, std::string_view of, const std::array<Renamed, N>& rows) {
  for (const Renamed& row : rows) {
    if (row.from != name || (!row.of.empty() && row.of != of)) continue;
    name = std::string(row.to);
    return;
  }
}

bool is_gloss(const MitsubaNode& node) {
  return node.tag == "bsdf" &&
         (node.type == "roughplastic" || node.type == "phong" || node.type == "ward");
}

}  // namespace

MitsubaVersion mitsuba_version(std::string_view text) {
  std::array<int, 2> number{};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (int& n : number) {
    const auto result = std::from_chars(at, end, n);
    if (result.ec != std::errc() || n < 0) return {};
    at = result.ptr < end && *result.ptr == '.' ? result.ptr + 1 : end;
  }
  return {number[0], number[1]};
}

void MitsubaUpgrade::add(MitsubaNode& to, const char* tag, const char* key,
                         const std::string& value) {
  MitsubaNode& node = nodes_.emplace_back();
  node.tag = tag;
  node.place = to.place;
  node.attributes[key] = value;
  to.children.push_back(&node);
}

void MitsubaUpgrade::begin(MitsubaNode& node, MitsubaNode& parent) {
  if (version_.is_below(0, 3)) begin_before_0_3(node, parent);
  if (version_.is_below(0, 4)) begin_before_0_4(node, parent);
}

void MitsubaUpgrade::begin_before_0_3(MitsubaNode& node, MitsubaNode& parent) {
  if (node.tag == "bsdf" && node.type == "mirror") {  // approximated by chromium
    node.type = "conductor";
    add(node, "string", "value", "Cr");
    nodes_.back().name = "material";
  } else if (node.tag == "bsdf" || node.tag == "texture") {
    rename(node.type, "", types_before_0_3);
  }
  rename(node.name, parent.type, names_before_0_3);
  if (node.tag != "lookAt" || !node.has("ox")) return;
  const auto join = [&](const std::string& which) {
    return node.attribute(which + "x") + " " + node.attribute(which + "y") + " " +
           node.attribute(which + "z");
  };
  node.attributes["origin"] = join("o");
  node.attributes["target"] = join("t");
  if (node.has("ux")) node.attributes["up"] = join("u");
  add(parent, "scale", "x", "-1");  // the camera's x pointed right before 0.3
}

void MitsubaUpgrade::begin_before_0_4(MitsubaNode& node, MitsubaNode& parent) {
  if (node.tag == "luminaire") node.tag = "emitter";
  if (node.tag == "camera") node.tag = "sensor";
  rename(node.name, parent.type, names_before_0_4);
  if (node.tag == "blackbody" && node.has("multiplier"))
    node.attributes["scale"] = node.attribute("multiplier");
  if (parent.tag != "sensor") return;
  if (node.tag == "transform") add(node, "scale", "x", "-1");
  if (node.name != "map_smaller_side") return;
  node.tag = "string";
  node.name = "fov_axis";
  node.attributes["value"] = node.attribute("value") == "false" ? "larger" : "smaller";
}

// Multiplies `kind`_reflectance by `kind`_amount, as versions before 0.3 did. `fallback` is the
// reflectance if none is given.
void MitsubaUpgrade::scale_reflectance(MitsubaNode& node, const char* kind, double fallback) {
  const std::string name = std::string(kind) + "_reflectance",
                    amount = std::string(kind) + "_amount";
  const auto find = [&](const std::string& wanted) {
    return std::find_if(node.children.begin(), node.children.end(),
                        [&](const MitsubaNode* child) { return child->name == wanted; });
  };
  std::string factor = "1";
  if (const auto given = find(amount); given != node.children.end()) {
    factor = (*given)->attribute("value");
    node.children.erase(given);
  }
  const auto color = find(name);
  if (color == node.children.end()) {
    double share = 1;
    std::from_chars(factor.data(), factor.data() + factor.size(), share);
    add(node, "spectrum", "value", std::to_string(share * fallback));
    nodes_.back().name = name;
  } else if (factor != "1") {
    MitsubaNode& inner = nodes_.emplace_back(**color);
    inner.name = "value";
    MitsubaNode& scaled = nodes_.emplace_back();
    scaled.tag = "texture";
    scaled.type = "scale";
    scaled.name = name;
    scaled.place = node.place;
    add(scaled, "float", "value", factor);
    nodes_.back().name = "scale";
    scaled.children.push_back(&inner);
    *color = &scaled;
  }
}

void MitsubaUpgrade::end(MitsubaNode& node) {
  if (version_.is_below(0, 3) && is_gloss(node)) {
    const bool was_microfacet = node.type == "roughplastic";
    scale_reflectance(node, "diffuse", was_microfacet ? 0 : 0.5);
    scale_reflectance(node, "specular", was_microfacet ? 1 : 0.2);
  }
  const bool is_old_camera =
      version_.is_below(0, 4) && node.tag == "sensor" && node.type == "perspective";
  const auto is_axis = [](const MitsubaNode* child) { return child->name == "fov_axis"; };
  if (!is_old_camera || std::any_of(node.children.begin(), node.children.end(), is_axis)) return;
  add(node, "string", "value", "smaller");
  nodes_.back().name = "fov_axis";
}

}  // namespace troffer
