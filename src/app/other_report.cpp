#include "app/other_report.h"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "base/error.h"
#include "image/read_image.h"
#include "import/file.h"
#include "import/gltf/gltf_json.h"

namespace troffer {

namespace {

namespace fs = std::filesystem;

constexpr size_t largest_file = size_t(64) << 20, most_entries = 1000;

// Returns a number; empty if the key is missing or null.
std::optional<double> other_number(const JsonNode& node, const char* key) {
  const auto value = node.find(key);
  if (!value) return std::nullopt;
  try {
    return value->as_number();
  } catch (const InputError&) {
    return std::nullopt;
  }
}

// Returns a member that is an object; empty if it is missing or null.
std::optional<JsonNode> object_of(const JsonNode& node, const char* key) {
  const auto value = node.find(key);
  return value && value->is_object() ? value : std::nullopt;
}

std::optional<Figure> other_figure(const JsonNode& node, const char* key) {
  const auto value = object_of(node, key);
  if (!value) return std::nullopt;
  return Figure{value->member("value").as_number(), value->member("standard_error").as_number()};
}

size_t size_of(const JsonNode& list) {
  if (list.size() > most_entries) list.fail("has more than 1000 items");
  return list.size();
}

OtherSurface other_surface(const JsonNode& node) {
  OtherSurface s;
  s.name = node.member("name").as_string();
  for (const char* kind : {"electric_lx", "daylight_lx"}) {
    const auto sums = object_of(node, kind);
    if (!sums || s.mean) continue;
    s.mean = other_figure(*sums, "mean");
    s.uniformity = other_figure(*sums, "uniformity");
  }
  return s;
}

// Returns the name of the observer's surface; empty if it belongs to none.
std::string surface_name(const JsonNode& observer) {
  try {
    return observer.member("surface").as_string();
  } catch (const InputError&) {
    return {};
  }
}

// Sets the worst UGR among each surface's observers.
void add_glare(const JsonNode& list, OtherReport& r) {
  for (size_t i = 0; i < size_of(list); ++i) {
    const JsonNode g = list.element(i);
    const std::optional<Figure> ugr = other_figure(g, "ugr");
    if (!ugr) continue;
    const std::string name = surface_name(g);
    for (OtherSurface& s : r.surfaces)
      if (s.name == name && (!s.ugr || s.ugr->value < ugr->value)) s.ugr = ugr;
  }
}

std::vector<uint8_t> beside(const std::string& report, const char* name, std::string_view begin) {
  const fs::path file = fs::path(report).parent_path() / name;
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return {};
  std::vector<uint8_t> bytes = read_file_bytes(file.string(), largest_file);
  const bool is_fine =
      bytes.size() >= begin.size() && std::equal(begin.begin(), begin.end(), bytes.begin(),
                                                 [](char a, uint8_t b) { return uint8_t(a) == b; });
  return is_fine ? bytes : std::vector<uint8_t>{};
}

}  // namespace

OtherReport read_other_report(const std::string& path) {
  const JsonDocument document(path, read_text_file(path, largest_file), JsonLimits{32, 2'000'000});
  const JsonNode root = document.root();
  const auto format = root.find("format");
  if (!format || format->as_string() != "troffer report 1")
    root.fail("is not a report.json of troffer report");
  OtherReport r;
  r.title = root.member("info").member("title").as_string();
  const JsonNode surfaces = root.member("surfaces");
  for (size_t i = 0; i < size_of(surfaces); ++i)
    r.surfaces.push_back(other_surface(surfaces.element(i)));
  const JsonNode checks = root.member("checks");
  for (size_t i = 0; i < size_of(checks); ++i) {
    const JsonNode c = checks.element(i);
    r.checks.push_back({c.member("subject").as_string(), c.member("quantity").as_string(),
                        c.member("verdict").as_string(), c.member("required").as_number()});
  }
  add_glare(root.member("glare"), r);
  const JsonNode power = root.member("power");
  r.lumens = other_number(power, "lumens");
  r.watts = other_number(power, "watts");
  r.floor_area = other_number(power, "floor_area_m2");
  r.watts_per_m2 = other_number(power, "watts_per_m2");
  r.task_mean = other_figure(power, "task_mean_lx");
  r.watts_per_100_lx = other_figure(power, "watts_per_m2_per_100_lx");
  r.plan = beside(path, "plan.svg", "<svg");
  r.picture = beside(path, "picture1.png", "\x89PNG");
  r.luminance = beside(path, "luminance1.png", "\x89PNG");
  return r;
}

}  // namespace troffer
