#include "import/gltf/gltf_ies.h"

#include <algorithm>
#include <cmath>

#include "import/file.h"
#include "import/gltf/gltf_uri.h"
#include "import/luminaire/attach_luminaire.h"
#include "import/luminaire/luminaire.h"
#include "import/uri.h"

namespace troffer {

namespace {

Luminaire read_profile(const JsonNode& profile, const GltfBuffers& buffers, WarningLog& warnings) {
  const std::string name = profile.file() + "#" + profile.pointer();
  const auto parse = [&](const auto& bytes) {
    if (bytes.size() > max_luminaire_bytes) profile.fail("is larger than 64 MiB");
    const std::string text(bytes.begin(), bytes.end());
    return read_luminaire_text(name, text, warnings);
  };
  if (const auto view = profile.find("bufferView")) return parse(buffers.buffer_view(*view));
  const auto uri = profile.find("uri");
  if (!uri) profile.fail("has neither a uri nor a buffer view");
  if (!is_data_uri(uri->as_string()))
    return read_luminaire(path_of_uri(*uri, folder_of(profile.file())), warnings);
  const auto data = parse_data_uri(uri->as_string());
  if (!data) uri->fail("is a malformed data URI");
  return parse(data->bytes);
}

Rgb factor_of(const JsonNode& instance) {
  const double multiplier = instance.number_or("multiplier", 1);
  const std::vector<double> color = instance.numbers_or("color", {1, 1, 1});
  if (!(multiplier >= 0 && multiplier <= 1e12))
    instance.fail("its multiplier must lie between 0 and 1e12");
  const auto share = [](double c) { return std::clamp(c, 0.0, 1.0); };
  return Rgb{float(share(color[0])), float(share(color[1])), float(share(color[2]))} *
         float(multiplier);
}

}  // namespace

void add_gltf_ies_light(const JsonNode& root, const JsonNode& instance,
                        const Affine& world_from_node, const std::string& node_name,
                        const GltfBuffers& buffers, Scene& scene) {
  const JsonNode profiles = root.extension("EXT_lights_ies")->member("lights");
  const uint32_t index = instance.member("light").as_index(profiles.size(), "lights");
  const JsonNode profile = profiles.element(index);
  std::string name = node_name.empty() ? profile.string_or("name", "") : node_name;
  if (name.empty()) name = "ies" + std::to_string(index);
  const auto& c = world_from_node.columns;
  const Vec3d axis = normalize(c[2] * -1.0), x = normalize(c[0] - axis * dot(c[0], axis));
  const Vec3 position(world_from_node.translation);
  if (!is_finite(axis) || !is_finite(x) || !is_finite(position)) {
    scene.warnings.add("light '" + printable(name) +
                       "': its node's transform cannot be used; left out");
    return;
  }
  Luminaire luminaire = read_profile(profile, buffers, scene.warnings);
  luminaire.tilt = {};
  luminaire.opening = {};  // the extension defines point lights
  const int32_t web = add_web(scene, luminaire);
  add_luminaire(scene, name, luminaire, web, factor_of(instance),
                {world_from_node.translation, axis, x, axis});
}

}  // namespace troffer
