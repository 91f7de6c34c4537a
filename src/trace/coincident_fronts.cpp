#include "trace/coincident_fronts.h"

#include <algorithm>
#include <array>

#include "base/hasher.h"

namespace troffer {

namespace {

struct SortedTriangle {
  uint64_t key = 0;  // hash of the corners, in an order that does not depend on the winding
  uint32_t mesh = 0, triangle = 0;
  bool is_odd = false;  // sorting the corners took an odd permutation
};

bool is_less(const Vec3& a, const Vec3& b) {
  if (a.x != b.x) return a.x < b.x;
  return a.y != b.y ? a.y < b.y : a.z < b.z;
}

SortedTriangle sorted(const Mesh& mesh, uint32_t m, uint32_t t) {
  std::array<Vec3, 3> corners;
  for (size_t k = 0; k < 3; ++k) corners[k] = mesh.positions[mesh.triangles[t][k]];
  SortedTriangle s{0, m, t, false};
  for (const auto& [i, k] : {std::pair{0, 1}, {1, 2}, {0, 1}})
    if (is_less(corners[size_t(k)], corners[size_t(i)])) {
      std::swap(corners[size_t(i)], corners[size_t(k)]);
      s.is_odd = !s.is_odd;
    }
  Hasher h(3);
  for (const Vec3& c : corners) h.add(c + Vec3{0, 0, 0});  // -0 becomes 0
  s.key = h.value();
  return s;
}

}  // namespace

std::vector<std::vector<uint8_t>> coincident_fronts(const Scene& scene) {
  std::vector<SortedTriangle> all;
  for (uint32_t m = 0; m < scene.meshes.size(); ++m) {
    const Mesh& mesh = scene.meshes[m];
    if (scene.materials[mesh.material].back_faces != BackFaces::unseen) continue;
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) all.push_back(sorted(mesh, m, t));
  }
  std::sort(all.begin(), all.end(), [](const SortedTriangle& a, const SortedTriangle& b) {
    return a.key != b.key ? a.key < b.key : a.is_odd < b.is_odd;
  });
  std::vector<std::vector<uint8_t>> flags(scene.meshes.size());
  for (size_t first = 0; first < all.size();) {
    size_t end = first + 1;
    while (end < all.size() && all[end].key == all[first].key) ++end;
    if (all[first].is_odd != all[end - 1].is_odd)
      for (size_t i = first; i < end; ++i) {
        std::vector<uint8_t>& of_mesh = flags[all[i].mesh];
        of_mesh.resize(scene.meshes[all[i].mesh].triangles.size(), 0);
        of_mesh[all[i].triangle] = 1;
      }
    first = end;
  }
  return flags;
}

}  // namespace troffer
