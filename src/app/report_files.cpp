#include "app/report_files.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>

#include "app/surface_list.h"
#include "import/file.h"
#include "import/gltf/gltf_json.h"

namespace troffer {

namespace {

constexpr size_t most_items = 1000, longest_text = 200;
constexpr double farthest = 1e9;   // m
constexpr double shortest = 1e-9;  // least length of a direction: squares of products of shorter
                                   // ones lose digits

void check_keys(const JsonNode& node, std::initializer_list<std::string_view> known) {
  for (const std::string& key : node.keys())
    if (std::find(known.begin(), known.end(), key) == known.end())
      node.member(key).fail("is not a known key");
}

std::string text_of(const JsonNode& node, const char* key) {
  const auto value = node.find(key);
  if (!value) return {};
  if (value->as_string().size() > longest_text) value->fail("is longer than 200 bytes");
  return value->as_string();
}

double number_of(const JsonNode& node, const char* key, double fallback, double least,
                 double most) {
  const auto value = node.find(key);
  if (!value) return fallback;
  const double v = value->as_number();
  if (!(v >= least && v <= most))
    value->fail("must lie between " + std::to_string(least) + " and " + std::to_string(most));
  return v;
}

Vec3d vector_of(const JsonNode& node) {
  const std::vector<double> v = node.as_numbers(3);
  if (!std::all_of(v.begin(), v.end(), [](double x) { return std::abs(x) <= farthest; }))
    node.fail("is more than 1e9 from the origin");
  return {v[0], v[1], v[2]};
}

Vec3d direction_of(const JsonNode& node) {
  const Vec3d v = vector_of(node);
  if (!(length(v) >= shortest)) node.fail("has no length");
  return v;
}

SurfaceRequest surface_of(const JsonNode& node) {
  check_keys(node, {"node", "name", "profile", "lift", "border", "corner", "sides"});
  SurfaceRequest r;
  r.node = text_of(node, "node");
  r.name = text_of(node, "name");
  r.profile = text_of(node, "profile");
  r.lift = number_of(node, "lift", 0, -1e3, 1e3);
  r.border = number_of(node, "border", 0, 0, 1e3);
  if (!r.node.empty()) {
    if (node.find("corner") || node.find("sides")) node.fail("has a node and a rectangle");
    return r;
  }
  r.corner = vector_of(node.member("corner"));
  const JsonNode sides = node.member("sides");
  if (sides.size() != 2) sides.fail("must be two vectors");
  r.side_a = direction_of(sides.element(0));
  r.side_b = direction_of(sides.element(1));
  const double a = length(r.side_a), b = length(r.side_b);
  if (std::abs(dot(r.side_a, r.side_b)) > 1e-3 * a * b) sides.fail("must be at right angles");
  if (std::max(a, b) > 1e5) sides.fail("are longer than 100 km");
  return r;
}

Observer observer_of(const JsonNode& node) {
  check_keys(node, {"eye", "direction"});
  return {vector_of(node.member("eye")), normalize(direction_of(node.member("direction")))};
}

Profile profile_of(const JsonNode& node) {
  check_keys(node, {"id", "name", "illuminance_lx", "ugr", "uniformity", "ra", "cylindrical_lx",
                    "eye_height_m"});
  Profile p;
  p.id = text_of(node, "id");
  if (p.id.empty()) node.fail("has no id");
  p.name = text_of(node, "name");
  if (p.name.empty()) p.name = p.id;
  p.illuminance_lx = number_of(node, "illuminance_lx", 0, 0, 1e6);
  p.ugr_limit = number_of(node, "ugr", 0, 0, 100);
  p.uniformity = number_of(node, "uniformity", 0, 0, 1);
  p.colour_rendering = int(number_of(node, "ra", 0, 0, 100));
  p.cylindrical_lx = number_of(node, "cylindrical_lx", 0, 0, 1e6);
  p.eye_height = number_of(node, "eye_height_m", 1.2, 0.1, 10);
  return p;
}

void for_each_of(const JsonNode& root, const char* key,
                 const std::function<void(const JsonNode&)>& visit) {
  const auto list = root.find(key);
  if (!list) return;
  if (list->size() > most_items) list->fail("has more than 1000 items");
  for (size_t i = 0; i < list->size(); ++i) visit(list->element(i));
}

}  // namespace

void read_report_file(const std::string& path, AssessmentOptions& options) {
  if (lower_case_ending(path) == "csv") return read_surface_list(path, options);
  const JsonDocument document(path, read_text_file(path, uint64_t(16) << 20),
                              JsonLimits{32, 100'000});
  const JsonNode root = document.root();
  check_keys(root, {"surfaces", "observers", "profiles"});
  for_each_of(root, "profiles", [&](const JsonNode& n) {
    const Profile p = profile_of(n);
    std::erase_if(options.profiles, [&](const Profile& o) { return o.id == p.id; });
    options.profiles.push_back(p);
  });
  for_each_of(root, "surfaces",
              [&](const JsonNode& n) { options.surfaces.push_back(surface_of(n)); });
  for_each_of(root, "observers",
              [&](const JsonNode& n) { options.observers.push_back(observer_of(n)); });
}

}  // namespace troffer
