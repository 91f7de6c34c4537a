#include "import/gltf_nodes.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace troffer {

namespace {

constexpr uint32_t none = 0xffffffffu;

// The rotation of a quaternion (x, y, z, w) of any length but zero [1] §3.5.3.
Affine rotation_of(const JsonNode& node) {
  const std::vector<double> q = node.as_numbers(4);
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(length > 1e-6) || !std::isfinite(length)) node.fail("is no rotation");
  const double x = q[0] / length, y = q[1] / length, z = q[2] / length, w = q[3] / length;
  Affine a;
  a.columns = {Vec3d{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
               Vec3d{2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
               Vec3d{2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}};
  return a;
}

Affine local_transform(const JsonNode& node) {
  if (const auto matrix = node.find("matrix")) {
    const std::vector<double> m = matrix->as_numbers(16);
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
      matrix->fail("is not affine: its last row should be 0 0 0 1");
    Affine a;
    a.columns = {Vec3d{m[0], m[1], m[2]}, Vec3d{m[4], m[5], m[6]}, Vec3d{m[8], m[9], m[10]}};
    a.translation = {m[12], m[13], m[14]};
    return a;
  }
  const std::vector<double> t = node.numbers_or("translation", {0, 0, 0});
  const std::vector<double> s = node.numbers_or("scale", {1, 1, 1});
  Affine a = Affine::translate({t[0], t[1], t[2]});
  if (const auto rotation = node.find("rotation")) a = a * rotation_of(*rotation);
  return a * Affine::scale({s[0], s[1], s[2]});
}

struct Hierarchy {
  std::vector<std::vector<uint32_t>> children;
  std::vector<uint32_t> parent;  // none for roots
};

// A strict tree [1] §3.5.2: with one parent each, whatever no root leads to lies on or below a
// cycle.
Hierarchy read_hierarchy(const JsonNode& nodes) {
  const size_t n = nodes.size();
  Hierarchy h{std::vector<std::vector<uint32_t>>(n), std::vector<uint32_t>(n, none)};
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
  if (reached.size() == n) return h;
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
    const JsonNode reference = list->element(k);
    const uint32_t i = reference.as_index(hierarchy.parent.size(), "nodes");
    if (hierarchy.parent[i] != none)
      reference.fail("node " + std::to_string(i) + " is not a root: it is a child of node " +
                     std::to_string(hierarchy.parent[i]));
    if (is_listed[i]) reference.fail("node " + std::to_string(i) + " is listed twice");
    is_listed[i] = true;
    roots.push_back(i);
  }
  return roots;
}

}  // namespace

std::vector<GltfNode> gltf_nodes(const JsonNode& root, WarningLog& warnings) {
  const auto nodes = root.find("nodes");
  if (!nodes) return {};
  const Hierarchy hierarchy = read_hierarchy(*nodes);
  const std::vector<uint32_t> roots = roots_of_scene(root, hierarchy, warnings);

  struct Pending {
    uint32_t index;
    Affine world_from_parent;
  };
  std::vector<Pending> stack;  // the next one on top
  for (auto it = roots.rbegin(); it != roots.rend(); ++it) stack.push_back({*it, Affine{}});
  std::vector<GltfNode> shown;
  while (!stack.empty()) {
    const Pending next = stack.back();
    stack.pop_back();
    const Affine world = next.world_from_parent * local_transform(nodes->element(next.index));
    shown.push_back({next.index, world});
    const auto& below = hierarchy.children[next.index];
    for (auto it = below.rbegin(); it != below.rend(); ++it) stack.push_back({*it, world});
  }
  return shown;
}

}  // namespace troffer
