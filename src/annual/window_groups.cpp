#include "annual/window_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/error.h"
#include "base/wildcard.h"
#include "import/file.h"
#include "import/gltf/gltf_json.h"
#include "scene/names.h"

namespace troffer {

namespace {

constexpr uint64_t most_group_bytes = uint64_t(16) << 20;

std::vector<std::string> names_in(const JsonNode& owner, const char* member) {
  std::vector<std::string> names;
  const auto list = owner.find_value(member);
  for (size_t i = 0; list && i < list->size(); ++i) names.push_back(list->element(i).as_string());
  return names;
}

void check_members(const JsonNode& node, const std::set<std::string>& known) {
  for (const std::string& key : node.keys())
    if (!known.contains(key)) {
      std::string list;
      for (const std::string& k : known) list += (list.empty() ? "" : ", ") + k;
      node.fail("has no member \"" + key + "\", but " + list);
    }
}

WindowState read_state(const JsonNode& node, size_t number, const std::vector<Fabric>& fabrics) {
  check_members(node, {"name", "shown", "transmittance", "material", "fabric"});
  WindowState s;
  s.name = node.string_or("name", fmt::format("state {}", number));
  s.shown = names_in(node, "shown");
  s.transmittance = node.number_or("transmittance", 1);
  if (!(s.transmittance >= 0 && s.transmittance <= 1))
    node.member("transmittance").fail("is not a factor from 0 to 1");
  s.material = node.string_or("material", "");
  s.fabric = node.string_or("fabric", "");
  if (s.fabric.empty()) return s;
  if (s.shown.empty()) node.fail("has a \"fabric\" but names no \"shown\" nodes made of it");
  if (std::none_of(fabrics.begin(), fabrics.end(),
                   [&](const Fabric& f) { return f.name == s.fabric; }))
    node.member("fabric").fail("is none of the \"fabrics\"");
  return s;
}

Fabric read_fabric(const JsonNode& node) {
  check_members(node, {"name", "openness", "transmittance", "reflectance"});
  const Fabric f{node.member("name").as_string(), node.number_or("openness", 0),
                 node.number_or("transmittance", 0), node.number_or("reflectance", 0)};
  if (f.name.empty()) node.fail("has an empty name");
  if (const std::string fault = fault_of(f); !fault.empty()) node.fail(fault);
  return f;
}

bool fits_any(const std::string& name, const std::vector<std::string>& patterns) {
  return std::any_of(patterns.begin(), patterns.end(),
                     [&](const std::string& p) { return fits_wildcard(name, p); });
}

void check_names(const Scene& scene, const std::vector<std::string>& patterns) {
  for (const std::string& p : patterns) {
    const auto fits = [&](const auto& node) { return fits_wildcard(node.name, p); };
    if (std::none_of(scene.meshes.begin(), scene.meshes.end(), fits) &&
        std::none_of(scene.instances.begin(), scene.instances.end(), fits))
      throw UsageError("--groups: " + no_node_named(scene, p));
  }
}

// Calls visit(name, material index) for all meshes and instances.
template <class Visit>
void for_each_node(const Scene& scene, const Visit& visit) {
  for (const Mesh& m : scene.meshes) visit(m.name, m.material);
  for (const Instance& i : scene.instances) visit(i.name, scene.instanced_meshes[i.mesh].material);
}

bool can_be_scaled(const Material& m) {
  switch (m.kind) {
    case MaterialKind::dielectric:
      return m.is_thin;
    case MaterialKind::metallic_roughness:
      return m.transmission.value > 0;
    case MaterialKind::diffuse:
      return m.diffuse_transmission.value > 0;
    case MaterialKind::coated_diffuse:
    case MaterialKind::conductor:
    case MaterialKind::angular:
      return false;
  }
  return false;
}

Material scaled(Material m, double factor) {
  const auto f = float(factor);
  m.diffuse_transmission_color.value *= Rgb{f};
  if (m.kind == MaterialKind::dielectric)
    m.absorption += Rgb{-std::log(std::max(f, 1e-30f))};
  else if (m.kind == MaterialKind::metallic_roughness)
    m.base_color.value *= Rgb{f};
  return m;
}

Material black_material() {
  Material m;
  m.name = "black window";
  m.base_color.value = Rgb{0};
  return m;
}

// Changes the scene group by group.
class StateMaker {
 public:
  explicit StateMaker(Scene& scene) : scene_(scene) {}

  void remove_lights() {
    for (Mesh& m : scene_.meshes) m.lights.clear();
    for (Sphere& s : scene_.spheres) s.light = no_light;
    for (Disk& d : scene_.disks) d.light = no_light;
    scene_.lights.clear();
  }
  void hide(const WindowGroup& group, std::optional<size_t> shown) {
    std::vector<std::string> hidden;
    for (const WindowState& s : group.states)
      hidden.insert(hidden.end(), s.shown.begin(), s.shown.end());
    const auto is_hidden = [&](const auto& node) {
      return fits_any(node.name, hidden) &&
             !(shown && fits_any(node.name, group.states[*shown].shown));
    };
    std::erase_if(scene_.meshes, is_hidden);
    std::erase_if(scene_.instances, is_hidden);
  }
  void set_windows(const WindowGroup& group, std::optional<size_t> shown) {
    const WindowState* state = shown ? &group.states[*shown] : nullptr;
    if (state != nullptr && state->transmittance == 1 && state->material.empty()) return;
    changed_.clear();
    const auto material_for = [&](uint32_t own) {
      const auto [at, is_new] = changed_.try_emplace(own, uint32_t(scene_.materials.size()));
      if (!is_new) return at->second;
      if (state == nullptr) {
        scene_.materials.push_back(black_material());
      } else {
        const auto named =
            std::find_if(scene_.materials.begin(), scene_.materials.end(),
                         [&](const Material& m) { return m.name == state->material; });
        Material changed = named != scene_.materials.end() && !state->material.empty()
                               ? *named
                               : scene_.materials[own];
        scene_.materials.push_back(
            state->transmittance == 1 ? changed : scaled(changed, state->transmittance));
      }
      return at->second;
    };
    repaint(group.windows, material_for);
  }
  void weave(const WindowState& state, const std::vector<Fabric>& fabrics) {
    const auto at = std::find_if(fabrics.begin(), fabrics.end(),
                                 [&](const Fabric& f) { return f.name == state.fabric; });
    if (at == fabrics.end()) return;
    const auto material = uint32_t(scene_.materials.size());
    scene_.materials.push_back(material_of(*at));
    repaint(state.shown, [&](uint32_t) { return material; });
  }

 private:
  // Gives the nodes of these names the material material_for(own material).
  template <class MaterialFor>
  void repaint(const std::vector<std::string>& names, const MaterialFor& material_for) {
    for (Mesh& m : scene_.meshes)
      if (fits_any(m.name, names)) m.material = material_for(m.material);
    for (Instance& i : scene_.instances) {
      if (!fits_any(i.name, names)) continue;
      Mesh copy = scene_.instanced_meshes[i.mesh];
      copy.material = material_for(copy.material);
      i.mesh = uint32_t(scene_.instanced_meshes.size());
      scene_.instanced_meshes.push_back(std::move(copy));
    }
  }

  Scene& scene_;
  std::map<uint32_t, uint32_t> changed_;  // new material by old one, for one group
};

}  // namespace

WindowGroups read_window_groups(const std::string& path) {
  const JsonDocument document(path, read_text_file(path, most_group_bytes));
  const JsonNode root = document.root();
  if (!root.is_object()) root.fail("is not an object with \"groups\"");
  check_members(root, {"groups", "fabrics"});
  WindowGroups all;
  const auto fabrics = root.find_value("fabrics");
  for (size_t i = 0; fabrics && i < fabrics->size(); ++i)
    all.fabrics.push_back(read_fabric(fabrics->element(i)));
  const JsonNode list = root.member("groups");
  std::vector<WindowGroup>& groups = all.groups;
  for (size_t i = 0; i < list.size(); ++i) {
    const JsonNode node = list.element(i);
    check_members(node, {"name", "windows", "states"});
    WindowGroup& g = groups.emplace_back();
    g.name = node.member("name").as_string();
    g.windows = names_in(node, "windows");
    if (g.windows.empty()) node.fail("names no \"windows\"");
    for (size_t k = 0; k + 1 < groups.size(); ++k)
      if (groups[k].name == g.name) node.fail("has the name of another group");
    const auto states = node.find_value("states");
    for (size_t k = 0; states && k < states->size(); ++k)
      g.states.push_back(read_state(states->element(k), k, all.fabrics));
    if (g.states.empty()) g.states.push_back(WindowState{"state 0", {}, 1, "", ""});
  }
  if (groups.empty()) list.fail("is empty");
  return all;
}

void check_window_groups(const Scene& scene, const std::vector<WindowGroup>& groups) {
  std::map<std::string, std::string> group_of;
  for (const WindowGroup& g : groups) {
    check_names(scene, g.windows);
    for (const WindowState& s : g.states) {
      check_names(scene, s.shown);
      const auto is_it = [&](const Material& m) { return m.name == s.material; };
      if (!s.material.empty() &&
          std::none_of(scene.materials.begin(), scene.materials.end(), is_it))
        throw UsageError("--groups: no material is named '" + s.material + "'");
    }
    for_each_node(scene, [&](const std::string& name, uint32_t material) {
      if (!fits_any(name, g.windows)) return;
      const auto [at, is_new] = group_of.try_emplace(name, g.name);
      if (!is_new && at->second != g.name)
        throw UsageError(fmt::format("--groups: '{}' is a window of '{}' and of '{}'", name,
                                     at->second, g.name));
      for (const WindowState& s : g.states)
        if (s.transmittance < 1 && s.material.empty() && !can_be_scaled(scene.materials[material]))
          throw UsageError(fmt::format(
              "--groups: '{}' transmits no light that \"transmittance\" could scale", name));
    });
  }
}

Scene with_window_states(Scene scene, const WindowGroups& all,
                         std::span<const std::optional<size_t>> states) {
  StateMaker maker(scene);
  maker.remove_lights();
  for (size_t g = 0; g < all.groups.size(); ++g) {
    const WindowGroup& group = all.groups[g];
    maker.hide(group, states[g]);
    maker.set_windows(group, states[g]);
    if (states[g]) maker.weave(group.states[*states[g]], all.fabrics);
  }
  return scene;
}

}  // namespace troffer
