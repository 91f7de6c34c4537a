#include "import/gltf/gltf_schema.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>

namespace troffer {

namespace {

enum class Is { object, array, string, boolean, number, integer, index, numbers };

// Requirement on a member of the document. In `path`, '*' stands for every element or member.
// `argument` is the largest allowed integer, or the count of numbers. `things` names the top-level
// array that an index refers to.
struct Rule {
  std::string_view path;
  Is is;
  bool is_required = false;
  uint64_t argument = ~uint64_t(0);
  const char* things = nullptr;
};

constexpr bool required = true, optional = false;
constexpr uint64_t any = ~uint64_t(0);

constexpr Rule index_rule(std::string_view path, const char* things, bool is_required = optional) {
  return {path, Is::index, is_required, any, things};
}

// Parents come before their members, so that a parent's type is checked first.
constexpr auto rules = std::to_array<Rule>({
    {"asset", Is::object, required},
    {"asset/version", Is::string, required},
    {"asset/minVersion", Is::string},
    {"extensions", Is::object},
    {"extensionsUsed", Is::array},
    {"extensionsUsed/*", Is::string},
    {"extensionsRequired", Is::array},
    {"extensionsRequired/*", Is::string},

    {"buffers", Is::array},
    {"buffers/*", Is::object},
    {"buffers/*/byteLength", Is::integer, required},
    {"buffers/*/uri", Is::string},
    {"bufferViews", Is::array},
    {"bufferViews/*", Is::object},
    index_rule("bufferViews/*/buffer", "buffers", required),
    {"bufferViews/*/byteLength", Is::integer, required},
    {"bufferViews/*/byteOffset", Is::integer},
    {"bufferViews/*/byteStride", Is::integer, optional, 252},
    {"accessors", Is::array},
    {"accessors/*", Is::object},
    index_rule("accessors/*/bufferView", "bufferViews"),
    {"accessors/*/byteOffset", Is::integer},
    {"accessors/*/componentType", Is::integer, required},
    {"accessors/*/count", Is::integer, required},
    {"accessors/*/type", Is::string, required},
    {"accessors/*/normalized", Is::boolean},
    {"accessors/*/sparse", Is::object},
    {"accessors/*/sparse/count", Is::integer, required},
    {"accessors/*/sparse/indices", Is::object, required},
    index_rule("accessors/*/sparse/indices/bufferView", "bufferViews", required),
    {"accessors/*/sparse/indices/byteOffset", Is::integer},
    {"accessors/*/sparse/indices/componentType", Is::integer, required},
    {"accessors/*/sparse/values", Is::object, required},
    index_rule("accessors/*/sparse/values/bufferView", "bufferViews", required),
    {"accessors/*/sparse/values/byteOffset", Is::integer},

    {"images", Is::array},
    {"images/*", Is::object},
    {"images/*/uri", Is::string},
    {"images/*/mimeType", Is::string},
    {"images/*/name", Is::string},
    index_rule("images/*/bufferView", "bufferViews"),
    {"samplers", Is::array},
    {"samplers/*", Is::object},
    {"samplers/*/magFilter", Is::integer},
    {"samplers/*/minFilter", Is::integer},
    {"samplers/*/wrapS", Is::integer},
    {"samplers/*/wrapT", Is::integer},
    {"textures", Is::array},
    {"textures/*", Is::object},
    index_rule("textures/*/source", "images"),
    index_rule("textures/*/sampler", "samplers"),

    {"materials", Is::array},
    {"materials/*", Is::object},
    {"materials/*/name", Is::string},
    {"materials/*/extensions", Is::object},
    {"materials/*/pbrMetallicRoughness", Is::object},
    {"materials/*/pbrMetallicRoughness/baseColorFactor", Is::numbers, optional, 4},
    {"materials/*/pbrMetallicRoughness/metallicFactor", Is::number},
    {"materials/*/pbrMetallicRoughness/roughnessFactor", Is::number},
    {"materials/*/pbrMetallicRoughness/baseColorTexture", Is::object},
    index_rule("materials/*/pbrMetallicRoughness/baseColorTexture/index", "textures", required),
    {"materials/*/pbrMetallicRoughness/metallicRoughnessTexture", Is::object},
    index_rule("materials/*/pbrMetallicRoughness/metallicRoughnessTexture/index", "textures",
               required),
    {"materials/*/normalTexture", Is::object},
    index_rule("materials/*/normalTexture/index", "textures", required),
    {"materials/*/normalTexture/scale", Is::number},
    {"materials/*/occlusionTexture", Is::object},
    index_rule("materials/*/occlusionTexture/index", "textures", required),
    {"materials/*/emissiveTexture", Is::object},
    index_rule("materials/*/emissiveTexture/index", "textures", required),
    {"materials/*/emissiveFactor", Is::numbers, optional, 3},
    {"materials/*/alphaMode", Is::string},
    {"materials/*/alphaCutoff", Is::number},
    {"materials/*/doubleSided", Is::boolean},

    {"meshes", Is::array},
    {"meshes/*", Is::object},
    {"meshes/*/name", Is::string},
    {"meshes/*/weights", Is::array},
    {"meshes/*/weights/*", Is::number},
    {"meshes/*/primitives", Is::array, required},
    {"meshes/*/primitives/*", Is::object},
    {"meshes/*/primitives/*/attributes", Is::object},
    index_rule("meshes/*/primitives/*/attributes/*", "accessors"),
    index_rule("meshes/*/primitives/*/indices", "accessors"),
    index_rule("meshes/*/primitives/*/material", "materials"),
    {"meshes/*/primitives/*/mode", Is::integer, optional, 6},
    {"meshes/*/primitives/*/targets", Is::array},
    {"meshes/*/primitives/*/targets/*", Is::object},
    index_rule("meshes/*/primitives/*/targets/*/*", "accessors"),

    {"cameras", Is::array},
    {"cameras/*", Is::object},
    {"cameras/*/name", Is::string},
    {"cameras/*/type", Is::string, required},
    {"cameras/*/perspective", Is::object},
    {"cameras/*/perspective/yfov", Is::number, required},
    {"cameras/*/perspective/znear", Is::number, required},
    {"cameras/*/perspective/zfar", Is::number},
    {"cameras/*/perspective/aspectRatio", Is::number},
    {"cameras/*/orthographic", Is::object},
    {"cameras/*/orthographic/xmag", Is::number, required},
    {"cameras/*/orthographic/ymag", Is::number, required},

    {"nodes", Is::array},
    {"nodes/*", Is::object},
    {"nodes/*/name", Is::string},
    {"nodes/*/extensions", Is::object},
    {"nodes/*/children", Is::array},
    index_rule("nodes/*/children/*", "nodes"),
    index_rule("nodes/*/mesh", "meshes"),
    index_rule("nodes/*/camera", "cameras"),
    index_rule("nodes/*/skin", "skins"),
    {"nodes/*/weights", Is::array},
    {"nodes/*/weights/*", Is::number},
    {"nodes/*/matrix", Is::numbers, optional, 16},
    {"nodes/*/translation", Is::numbers, optional, 3},
    {"nodes/*/rotation", Is::numbers, optional, 4},
    {"nodes/*/scale", Is::numbers, optional, 3},
    {"skins", Is::array},
    {"skins/*", Is::object},
    {"skins/*/joints", Is::array, required},
    index_rule("skins/*/joints/*", "nodes"),
    index_rule("skins/*/skeleton", "nodes"),
    index_rule("skins/*/inverseBindMatrices", "accessors"),
    {"animations", Is::array},
    {"animations/*", Is::object},
    {"scenes", Is::array},
    {"scenes/*", Is::object},
    {"scenes/*/name", Is::string},
    {"scenes/*/nodes", Is::array},
    index_rule("scenes/*/nodes/*", "nodes"),
    index_rule("scene", "scenes"),
});

void check_value(const Rule& rule, const JsonNode& root, const JsonNode& value) {
  switch (rule.is) {
    case Is::object:
      value.keys();
      break;
    case Is::array:
      value.size();
      break;
    case Is::string:
      value.as_string();
      break;
    case Is::boolean:
      value.as_bool();
      break;
    case Is::number:
      value.as_number();
      break;
    case Is::integer:
      value.as_integer(rule.argument);
      break;
    case Is::numbers:
      value.as_numbers(size_t(rule.argument));
      break;
    case Is::index: {
      const auto things = root.find(rule.things);
      value.as_index(things ? things->size() : 0, rule.things);
      break;
    }
  }
}

// Applies the rule to everything that `path`, the rest of the rule's path, leads to from `node`.
void apply(const Rule& rule, const JsonNode& root, const JsonNode& node, std::string_view path) {
  const size_t slash = path.find('/');
  const bool is_last = slash == std::string_view::npos;
  const std::string_view token = path.substr(0, slash);
  const auto descend = [&](const JsonNode& child) {
    if (is_last)
      check_value(rule, root, child);
    else
      apply(rule, root, child, path.substr(slash + 1));
  };
  if (token != "*") {
    if (const auto child = node.find(token))
      descend(*child);
    else if (is_last && rule.is_required)
      node.member(token);  // fails with the member's name
  } else if (node.is_array()) {
    for (size_t i = 0; i < node.size(); ++i) descend(node.element(i));
  } else {
    for (const std::string& key : node.keys()) descend(node.member(key));
  }
}

// Splits "2.0" into (2, 0); fails on anything else.
std::pair<int, int> parsed_version(const JsonNode& node) {
  const std::string& text = node.as_string();
  const size_t dot = text.find('.');
  const auto is_number = [](std::string_view s) {
    return !s.empty() && s.size() <= 4 &&
           std::all_of(s.begin(), s.end(), [](char c) { return c >= '0' && c <= '9'; });
  };
  if (dot == std::string::npos || !is_number(text.substr(0, dot)) ||
      !is_number(text.substr(dot + 1)))
    node.fail("'" + printable(text) + "' is not a version");
  return {std::stoi(text.substr(0, dot)), std::stoi(text.substr(dot + 1))};
}

// Fails unless the major version is 2. A minVersion above 2.0 gives a warning and is read as 2.0,
// which it extends [1] §3.2.
void check_version(const JsonNode& asset, WarningLog& warnings) {
  const JsonNode version = asset.member("version");
  if (parsed_version(version).first != 2)
    version.fail("'" + printable(version.as_string()) + "' is not supported, only glTF 2.0 is");
  if (const auto minimum = asset.find("minVersion"))
    if (parsed_version(*minimum) > std::pair{2, 0}) {
      if (parsed_version(*minimum).first > 2) minimum->fail("asks for more than glTF 2");
      warnings.add("the file asks for glTF " + printable(minimum->as_string()) +
                   " and is read as 2.0");
    }
}

void check_cameras(const JsonNode& root) {
  const auto cameras = root.find("cameras");
  for (size_t i = 0; cameras && i < cameras->size(); ++i) {
    const JsonNode camera = cameras->element(i), type = camera.member("type");
    if (type.as_string() != "perspective" && type.as_string() != "orthographic")
      type.fail("'" + printable(type.as_string()) + "' is not a camera type");
    camera.member(type.as_string());
  }
}

// Checks the light index of every node, including nodes that are not shown.
void check_light_references(const JsonNode& root) {
  for (const char* name : {"KHR_lights_punctual", "EXT_lights_ies"}) {
    const auto extension = root.extension(name);
    const auto lights = extension ? extension->find("lights") : std::nullopt;
    const auto nodes = root.find("nodes");
    for (size_t i = 0; nodes && i < nodes->size(); ++i)
      if (const auto of_node = nodes->element(i).extension(name))
        of_node->member("light").as_index(lights ? lights->size() : 0, "lights");
  }
}

// Extensions that are read, or that give a warning of their own where they are used.
constexpr auto supported_extensions =
    std::to_array<std::string_view>({"EXT_lights_ies",
                                     "EXT_lights_image_based",
                                     "EXT_mesh_gpu_instancing",
                                     "EXT_meshopt_compression",
                                     "EXT_texture_webp",
                                     "KHR_draco_mesh_compression",
                                     "KHR_lights_punctual",
                                     "KHR_materials_anisotropy",
                                     "KHR_materials_clearcoat",
                                     "KHR_materials_diffuse_transmission",
                                     "KHR_materials_dispersion",
                                     "KHR_materials_emissive_strength",
                                     "KHR_materials_ior",
                                     "KHR_materials_iridescence",
                                     "KHR_materials_pbrSpecularGlossiness",
                                     "KHR_materials_sheen",
                                     "KHR_materials_specular",
                                     "KHR_materials_transmission",
                                     "KHR_materials_unlit",
                                     "KHR_materials_variants",
                                     "KHR_materials_volume",
                                     "KHR_materials_volume_scatter",
                                     "KHR_mesh_quantization",
                                     "KHR_node_visibility",
                                     "KHR_texture_transform",
                                     "MOZ_lightmap"});

bool is_supported(const std::string& name) {
  return std::find(supported_extensions.begin(), supported_extensions.end(), name) !=
         supported_extensions.end();
}

}  // namespace

void check_gltf_document(const JsonNode& root, WarningLog& warnings) {
  for (const Rule& rule : rules) {
    apply(rule, root, root, rule.path);
    if (rule.path == "asset/minVersion") check_version(root.member("asset"), warnings);
  }
  check_cameras(root);
  check_light_references(root);
}

void check_gltf_extensions(const JsonNode& root, WarningLog& warnings) {
  std::set<std::string> told;
  const auto tell = [&](const char* list, const char* what) {
    const auto names = root.find(list);
    for (size_t i = 0; names && i < names->size(); ++i) {
      const std::string& name = names->element(i).as_string();
      if (!is_supported(name) && told.insert(name).second)
        warnings.add("the extension '" + printable(name) + "' " + what);
    }
  };
  tell("extensionsRequired",
       "is not supported, although the file requires it: its effects are missing in the picture");
  tell("extensionsUsed", "is not supported and ignored");
}

}  // namespace troffer
