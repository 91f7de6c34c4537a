#include "import/gltf/gltf_nodes.h"

#include <algorithm>
#include <string>

#include "import/gltf/gltf_pose.h"

namespace troffer {

namespace {

constexpr uint32_t none = 0xffffffffu;

// Returns the node's transform relative to its parent. [1] §3.11 forbids a matrix on an animated
// node; if there is one, the animation wins.
Affine local_transform(const JsonNode& node, const GltfNodePose& pose) {
  const auto matrix = node.find("matrix");
  if (matrix && !pose.moves()) {
    const std::vector<double> m = matrix->as_numbers(16);
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
      matrix->fail("is not affine: its last row should be 0 0 0 1");
    Affine a;
    a.columns = {Vec3d{m[0], m[1], m[2]}, Vec3d{m[4], m[5], m[6]}, Vec3d{m[8], m[9], m[10]}};
    a.translation = {m[12], m[13], m[14]};
    return a;
  }
  const auto vector = [&](const char* key, const auto& posed, double rest) {
    if (posed) return Vec3d{(*posed)[0], (*posed)[1], (*posed)[2]};
    const std::vector<double> v = node.numbers_or(key, {rest, rest, rest});
    return Vec3d{v[0], v[1], v[2]};
  };
  Affine a = Affine::translate(vector("translation", pose.translation, 0));
  if (const auto& q = pose.rotation) {
    a = a * gltf_rotation(node, (*q)[0], (*q)[1], (*q)[2], (*q)[3]);
  } else if (const auto rotation = node.find("rotation")) {
    const std::vector<double> r = rotation->as_numbers(4);
    a = a * gltf_rotation(*rotation, r[0], r[1], r[2], r[3]);
  }
  return a * Affine::scale(vector("scale", pose.scale, 1));
}

struct Hierarchy {
  std::vector<std::vector<uint32_t>> children;
  std::vector<uint32_t> parent;    // `none` for roots
  std::vector<uint32_t> in_order;  // parents before children
};

// Reads the hierarchy and fails unless it is a strict tree [1] §3.5.2. Each node has one parent at
// most, so a node that no root reaches lies on or below a cycle.
Hierarchy read_hierarchy(const JsonNode& nodes) {
  const size_t n = nodes.size();
  Hierarchy h{std::vector<std::vector<uint32_t>>(n), std::vector<uint32_t>(n, none), {}};
  for (uint32_t i = 0; i < n; ++i) {
    const auto list = nodes.element(i).find("children");
    for (size_t k = 0; list && k < list->size(); ++k) {
      const JsonNode reference = list->element(k);
      const uint32_t child = reference.as_index(n, "nodes");
      if (child == i) reference.fail("node " + std::to_string(i) + " is its own child");
      if (h.parent[child] != none)
        reference.fail("node " + std::to_string(child) + " already is a child of node " +
                       std::to_string(h.parent[child]));
      h.parent[child] = i;
      h.children[i].push_back(child);
    }
  }
  std::vector<uint32_t> reached;
  for (uint32_t i = 0; i < n; ++i)
    if (h.parent[i] == none) reached.push_back(i);
  for (size_t at = 0; at < reached.size(); ++at) {
    const auto& below = h.children[reached[at]];
    reached.insert(reached.end(), below.begin(), below.end());
  }
  if (reached.size() == n) {
    h.in_order = std::move(reached);
    return h;
  }
  std::vector<bool> is_reached(n, false);
  for (const uint32_t i : reached) is_reached[i] = true;
  const auto lost =
      size_t(std::find(is_reached.begin(), is_reached.end(), false) - is_reached.begin());
  nodes.element(lost).fail("the node is its own ancestor, or a descendant of one that is");
}

std::vector<uint32_t> roots_of_scene(const JsonNode& root, const Hierarchy& hierarchy,
                                     WarningLog& warnings) {
  std::vector<uint32_t> roots;
  const auto scenes = root.find("scenes");
  if (!scenes || scenes->size() == 0) {
    for (uint32_t i = 0; i < hierarchy.parent.size(); ++i)
      if (hierarchy.parent[i] == none) roots.push_back(i);
    return roots;
  }
  const uint64_t shown = root.integer_or("scene", 0, scenes->size() - 1);
  if (scenes->size() > 1)
    warnings.add("the file has " + std::to_string(scenes->size()) + " scenes; only scene " +
                 std::to_string(shown) + " is shown");
  const auto list = scenes->element(size_t(shown)).find("nodes");
  std::vector<bool> is_listed(hierarchy.parent.size(), false);
  for (size_t k = 0; list && k < list->size(); ++k) {
    const uint32_t i = list->element(k).as_index(hierarchy.parent.size(), "nodes");
    if (is_listed[i]) warnings.add("a node is listed twice in the scene; it is shown once");
    if (!is_listed[i]) roots.push_back(i);
    is_listed[i] = true;
  }
  // A listed node below another listed node is shown together with that one.
  std::vector<bool> is_below(hierarchy.parent.size(), false);
  for (const uint32_t i : hierarchy.in_order) {
    const uint32_t parent = hierarchy.parent[i];
    is_below[i] = parent != none && (is_below[parent] || is_listed[parent]);
    if (is_listed[i] && parent != none)
      warnings.add(
          "a node listed in the scene is not a root; it is shown where its parents place it");
  }
  std::erase_if(roots, [&](uint32_t i) { return is_below[i]; });
  return roots;
}

}  // namespace

GltfNodes gltf_nodes(const JsonNode& root, const GltfPoses& poses, WarningLog& warnings) {
  const auto nodes = root.find("nodes");
  if (!nodes) return {};
  const Hierarchy hierarchy = read_hierarchy(*nodes);
  GltfNodes out;
  out.world.resize(hierarchy.parent.size());
  for (const uint32_t i : hierarchy.in_order) {
    const auto pose = poses.find(i);
    const Affine local =
        local_transform(nodes->element(i), pose == poses.end() ? GltfNodePose{} : pose->second);
    const uint32_t parent = hierarchy.parent[i];
    out.world[i] = parent == none ? local : out.world[parent] * local;
  }
  std::vector<uint32_t> stack = roots_of_scene(root, hierarchy, warnings);  // next node on top
  std::reverse(stack.begin(), stack.end());
  while (!stack.empty()) {
    const uint32_t next = stack.back();
    stack.pop_back();
    const auto visibility = nodes->element(next).extension("KHR_node_visibility");
    if (visibility && !visibility->bool_or("visible", true)) continue;  // hides descendants too
    out.shown.push_back({next, out.world[next]});
    const auto& below = hierarchy.children[next];
    stack.insert(stack.end(), below.rbegin(), below.rend());
  }
  return out;
}

}  // namespace troffer
