#include "app/option_table.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace troffer {

namespace {

// A namespace of its own: other sources may use the same names.
namespace option_rows {

constexpr const char* scenes = "gltf|glb|pbrt|obj|ply|stl|xml|rad|hbjson|json|gz";
constexpr const char* pictures = "exr|hdr|pfm|png";
constexpr const char* pictures_read = "exr|hdr|pfm|png|jpg";
constexpr const char* surroundings = "exr|hdr|pfm|png|jpg";
constexpr const char* photometry = "ies|ldt";

constexpr const char* input = "Input";
constexpr const char* view = "View";
constexpr const char* light = "Light";
constexpr const char* quality = "Quality";
constexpr const char* assessment = "Assessment";
constexpr const char* lightmap = "Lightmap";
constexpr const char* output = "Output";
constexpr const char* limits = "Limits";
constexpr const char* certified = "Method certified";
constexpr const char* kj92 = "Method kj92";
constexpr const char* fixed = "Method fixed";
constexpr const char* path = "Method path";
constexpr const char* other = "Other";

constexpr std::array rows{
    // Input
    OptionRow{"info scene", input, "FILE",
              "gltf|glb|pbrt|obj|ply|stl|xml|rad|hbjson|json|gz|ies|ldt"},
    OptionRow{"glare scene", input, "SCENE",
              "gltf|glb|pbrt|obj|ply|stl|xml|rad|hbjson|json|gz|exr|hdr|pfm"},
    OptionRow{"scene", input, "SCENE", scenes},
    OptionRow{"image", input, "IMAGE", pictures_read},
    OptionRow{"reference", input, "REFERENCE", pictures_read},
    OptionRow{"merge output", output, "OUT", pictures},
    OptionRow{"convert output", output, "OUT", "gltf|glb|pbrt"},
    OptionRow{"parts", input, "PART", "exr"},
    OptionRow{"--points", input, "FILE", "csv"},
    OptionRow{"--grid", input, "NODE[,HEIGHT[,SPACING]]", ""},
    OptionRow{"--border", input, "METRES", ""},
    OptionRow{"--up", input, "DIRECTION", ""},
    OptionRow{"--variant", input, "NAME", ""},
    OptionRow{"--time", input, "SECONDS", ""},
    OptionRow{"--animation", input, "NAME", ""},
    OptionRow{"--state", input, "GROUP=N", ""},
    // Assessment
    OptionRow{"--surface", assessment, "NODE[:PROFILE]", ""},
    OptionRow{"--surfaces", assessment, "FILE", "json|csv"},
    OptionRow{"--profile", assessment, "ID", ""},
    OptionRow{"--power", assessment, "NODE=WATTS", ""},
    OptionRow{"--maintenance", assessment, "FACTOR", ""},
    OptionRow{"--work-plane", assessment, "METRES", ""},
    OptionRow{"--observer", assessment, "X,Y,Z,DX,DY,DZ", ""},
    OptionRow{"--groups", input, "FILE", "json"},
    OptionRow{"--blinds", assessment, "RULE", "csv"},
    OptionRow{"--eyes", assessment, "FILE", "csv"},
    OptionRow{"--sunlight", assessment, "FILE", "csv"},
    OptionRow{"--sunlight-day", assessment, "MM-DD[,DEGREES]", ""},
    OptionRow{"--electric", assessment, "NAME,…", ""},
    OptionRow{"--electric-target", assessment, "LUX", ""},
    OptionRow{"--occupancy", assessment, "HOURS", "csv|txt"},
    OptionRow{"--threshold", assessment, "LUX", ""},
    OptionRow{"--daylight-factor", assessment, "WHEN", ""},
    OptionRow{"--contributions", assessment, "ON", ""},
    OptionRow{"--cylindrical", assessment, "ON", ""},
    OptionRow{"--compare", assessment, "FILE", "json"},
    OptionRow{"--threshold", assessment, "CD/M2", ""},
    OptionRow{"--task", assessment, "X,Y", ""},
    OptionRow{"--task-angle", assessment, "RADIANS", ""},
    OptionRow{"--search-radius", assessment, "RADIANS", ""},
    OptionRow{"--peak", assessment, "CD/M2", ""},
    OptionRow{"--no-low-light", assessment, "", ""},
    // View
    OptionRow{"--pictures", view, "ON", ""},
    OptionRow{"--size", view, "WxH", ""},
    OptionRow{"--width", view, "PIXELS", ""},
    OptionRow{"--camera", view, "NAME", ""},
    OptionRow{"--eye", view, "X,Y,Z", ""},
    OptionRow{"--target", view, "X,Y,Z", ""},
    OptionRow{"--fov", view, "DEGREES", ""},
    OptionRow{"--crop", view, "X0,Y0,X1,Y1", ""},
    OptionRow{"--port", view, "PORT", ""},
    OptionRow{"--annual", view, "FOLDER", "/"},
    // Light
    OptionRow{"--light", light, "NAME,…", ""},
    OptionRow{"--luminaire", light, "NODE=FILE[,LUMENS[,KELVIN]]", photometry},
    OptionRow{"--luminaires", light, "FILE", "csv"},
    OptionRow{"--dim", light, "NAME=FACTOR", ""},
    OptionRow{"--baked", light, "", ""},
    OptionRow{"--emission-scale", light, "FACTOR", ""},
    OptionRow{"--light-radius", light, "METRES", ""},
    OptionRow{"--sky", light, "SKY", ""},
    OptionRow{"--sun", light, "AZIMUTH,ALTITUDE[,LUX]", ""},
    OptionRow{"--at", light, "LATITUDE,LONGITUDE,TIME", ""},
    OptionRow{"annual --weather", light, "FILE", "epw|wea"},
    OptionRow{"--weather", light, "FILE", "epw"},
    OptionRow{"--date", light, "MM-DDTHH:MM", ""},
    OptionRow{"--north", light, "DEGREES", ""},
    OptionRow{"--ground", light, "REFLECTANCE", ""},
    OptionRow{"--turbidity", light, "FACTOR", ""},
    OptionRow{"--environment", light, "FILE[,SCALE]", surroundings},
    OptionRow{"--environment-rotation", light, "DEGREES", ""},
    OptionRow{"--portal", light, "NODE or 12 numbers", ""},
    // Quality
    OptionRow{"--method", quality, "METHOD", ""},
    OptionRow{"--error", quality, "ERROR", ""},
    OptionRow{"--picture-error", quality, "ERROR", ""},
    OptionRow{"--spp", quality, "N", ""},
    OptionRow{"--gather-rays", quality, "N", ""},
    OptionRow{"--subdivision", quality, "N", ""},
    OptionRow{"--max-spp", quality, "N", ""},
    OptionRow{"--indirect", quality, "KIND", ""},
    OptionRow{"--seed", quality, "N", ""},
    OptionRow{"--cells", quality, "", ""},
    OptionRow{"--element-size", quality, "METRES", ""},
    OptionRow{"--patch-size", quality, "METRES", ""},
    OptionRow{"--stored", quality, "N", ""},
    OptionRow{"--unshot", quality, "SHARE", ""},
    // Lightmap
    OptionRow{"--resolution", lightmap, "TEXELS", ""},
    OptionRow{"--texels-per-metre", lightmap, "N", ""},
    OptionRow{"--max-size", lightmap, "TEXELS", ""},
    OptionRow{"--gutter", lightmap, "TEXELS", ""},
    // Output
    OptionRow{"bake --output", output, "FILE", "gltf|glb"},
    OptionRow{"annual --output", output, "FOLDER", "/"},
    OptionRow{"report --output", output, "FOLDER", "/"},
    OptionRow{"measure --output", output, "FILE", "csv"},
    OptionRow{"radiosity --output", output, "FILE", "gltf|glb|trad"},
    OptionRow{"--output", output, "FILE", pictures},
    OptionRow{"--exposure", output, "STOPS", ""},
    OptionRow{"--tone-map", output, "CURVE", ""},
    OptionRow{"--aov", output, "LAYER,…", ""},
    OptionRow{"--ill", output, "", ""},
    OptionRow{"--preview", output, "", ""},
    OptionRow{"--unlit", output, "", ""},
    OptionRow{"--emissive", output, "", ""},
    OptionRow{"--vertex-colours", output, "", ""},
    OptionRow{"--hdr", output, "FORMAT", ""},
    OptionRow{"--title", output, "TEXT", ""},
    OptionRow{"--dated", output, "TEXT", ""},
    OptionRow{"--map", output, "FILE", pictures},
    OptionRow{"--difference", output, "FILE", pictures},
    OptionRow{"--polar", output, "FILE", "svg|png"},
    OptionRow{"--json", output, "", ""},
    OptionRow{"--stats", output, "FILE", "json"},
    OptionRow{"--explain", output, "", ""},
    OptionRow{"--quiet", output, "", ""},
    OptionRow{"--help", output, "", ""},
    OptionRow{"--version", output, "", ""},
    // Limits
    OptionRow{"--threads", limits, "N", ""},
    OptionRow{"--time-limit", limits, "SECONDS", ""},
    OptionRow{"--error-limit", limits, "ERROR", ""},
    OptionRow{"--checkpoint", limits, "FILE", "*"},
    OptionRow{"--checkpoint-interval", limits, "SECONDS", ""},
    OptionRow{"--resume", limits, "", ""},
    OptionRow{"--part", limits, "K/N", ""},
    OptionRow{"--join", limits, "FILE", "*"},
    // Methods
    OptionRow{"--solution", certified, "FILE", "*"},
    OptionRow{"--depth", path, "N", ""},
    OptionRow{"--shadow-rays", fixed, "N", ""},
    OptionRow{"--variance", kj92, "ERROR", ""},
    OptionRow{"--most-rays", kj92, "N", ""},
    OptionRow{"--mean-change", kj92, "SHARE", ""},
    OptionRow{"--level-difference", kj92, "N", ""},
    OptionRow{"--probe-rays", kj92, "N", ""},
    OptionRow{"--coherence", kj92, "ON", ""},
    OptionRow{"--ratio", kj92, "", ""},
    OptionRow{"--selection", kj92, "ON", ""},
    OptionRow{"--select", kj92, "NAME,…", ""},
};

constexpr std::array group_order{input,  assessment, view, light, quality, lightmap, output,
                                 limits, certified,  path, fixed, kj92,    other};

}  // namespace option_rows

std::string plain_name(const CLI::Option& option) {
  if (option.get_positional()) return option.get_name(true);
  return option.get_lnames().empty() ? option.get_name() : "--" + option.get_lnames().front();
}

}  // namespace

const OptionRow* row_of(const std::string& command, const CLI::Option& option) {
  const std::string name = plain_name(option), own = command + " " + name;
  const OptionRow* found = nullptr;
  for (const OptionRow& r : option_rows::rows) {
    if (r.name == own) return &r;
    if (found == nullptr && r.name == name) found = &r;
  }
  return found;
}

std::vector<OptionGroup> grouped_options(const CLI::App& command) {
  struct Placed {
    size_t group, row;
    const CLI::Option* option;
  };
  std::vector<Placed> placed;
  for (const CLI::Option* o : command.get_options()) {
    if (o->get_group().empty()) continue;  // hidden option
    const OptionRow* row = row_of(command.get_name(), *o);
    const std::string_view group = row != nullptr ? row->group : option_rows::other;
    const auto at =
        std::find(option_rows::group_order.begin(), option_rows::group_order.end(), group);
    placed.push_back(
        {size_t(at - option_rows::group_order.begin()),
         row != nullptr ? size_t(row - option_rows::rows.data()) : option_rows::rows.size(), o});
  }
  std::stable_sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
    return a.group != b.group ? a.group < b.group : a.row < b.row;
  });
  std::vector<OptionGroup> groups;
  for (const Placed& p : placed) {
    const std::string name = option_rows::group_order[p.group];
    if (groups.empty() || groups.back().name != name) groups.push_back({name, {}});
    groups.back().options.push_back(p.option);
  }
  return groups;
}

std::string name_shown(const std::string& command, const CLI::Option& option) {
  if (!option.get_positional()) return option.get_name(false, true);
  const OptionRow* row = row_of(command, option);
  if (row != nullptr) return row->value;
  std::string name = option.get_name(true);
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return char(std::toupper(c)); });
  return name;
}

std::string value_shown(const std::string& command, const CLI::Option& option) {
  if (option.get_positional() || option.get_items_expected_max() == 0) return "";
  const OptionRow* row = row_of(command, option);
  return row != nullptr ? row->value : "VALUE";
}

}  // namespace troffer
