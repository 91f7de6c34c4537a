#include "import/gltf/mesh_instancer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "import/mesh_clean.h"
#include "import/thin_glass.h"
#include "import/triangle_check.h"
#include "scene/mesh_in_world.h"

namespace troffer {

namespace {

// Thresholds from measured ray times in halls full of bushes, instances relative to copies: 1.4 for
// meshes of 70 triangles, 1.1 for 250, 0.8 for 1000. The smallest meshes are always copied. Others
// are copied until all copies together take some hundred MB.
constexpr size_t fewest_triangles = 64, few_triangles = 512;
constexpr size_t most_copied = 1 << 18, most_copied_of_few = 1 << 21;

void drop_unused_vertices(Mesh& mesh) {
  std::vector<uint32_t> number(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (const uint32_t v : t) number[v] = 1;
  uint32_t kept = 0;
  for (size_t v = 0; v < number.size(); ++v) {
    if (number[v] == 0) continue;
    mesh.positions[kept] = mesh.positions[v];
    if (!mesh.normals.empty()) mesh.normals[kept] = mesh.normals[v];
    if (!mesh.uvs.empty()) mesh.uvs[kept] = mesh.uvs[v];
    if (!mesh.uvs_2.empty()) mesh.uvs_2[kept] = mesh.uvs_2[v];
    number[v] = kept++;
  }
  mesh.positions.resize(kept);
  if (!mesh.normals.empty()) mesh.normals.resize(kept);
  if (!mesh.uvs.empty()) mesh.uvs.resize(kept);
  if (!mesh.uvs_2.empty()) mesh.uvs_2.resize(kept);
  for (Triangle& t : mesh.triangles)
    for (uint32_t& v : t) v = number[v];
}

}  // namespace

std::string too_many_by_instances() {
  return "the scene has more than " + std::to_string(max_placed_triangles) +
         " triangles by instances";
}

bool MeshInstancer::is_worth(size_t triangles, uint32_t material) const {
  return triangles >= fewest_triangles && !may_be_thin_glass(scene_.materials[material]);
}

// True if a new mesh of that size should be shared. Otherwise counts its triangles as copied.
bool MeshInstancer::wants(size_t triangles) {
  const size_t most = triangles < few_triangles ? most_copied_of_few : most_copied;
  if (copied_triangles_ + triangles > most) return true;
  copied_triangles_ += triangles;
  return false;
}

MeshInstancer::Stored MeshInstancer::store(Mesh mesh) {
  drop_unused_vertices(mesh);
  Stored out{uint32_t(scene_.instanced_meshes.size()), reach_of(mesh),
             std::numeric_limits<double>::infinity(), 0};
  for (const Triangle& t : mesh.triangles) {
    double longest = 0;
    for (size_t k = 0; k < 3; ++k)
      longest =
          std::max(longest, double(length(mesh.positions[t[(k + 1) % 3]] - mesh.positions[t[k]])));
    out.least_height = std::min(out.least_height, length(area_vector(mesh, t)) / longest);
    out.longest_edge = std::max(out.longest_edge, longest);
  }
  scene_.instanced_meshes.push_back(std::move(mesh));
  return out;
}

// True if all triangles pass TriangleCheck in world space. A bound by the flattest triangle settles
// most meshes. Under singular values between `least` and `most`, a height h over an edge becomes at
// least h least² / most, less rounding.
bool MeshInstancer::is_good(const Stored& stored, const Affine& world_from_mesh) const {
  constexpr double rounding = 4 * 0x1p-24, flattest = 1e-8;
  double squares = 0, largest = 0;
  for (const Vec3d& column : world_from_mesh.columns) squares += length_squared(column);
  const Vec3d farthest = abs(world_from_mesh.translation);
  for (size_t a = 0; a < 3; ++a)
    largest = std::max(largest, farthest[a] + std::sqrt(squares) * length(Vec3d(stored.reach)));
  const double most = std::sqrt(squares), least = std::abs(world_from_mesh.determinant()) / squares;
  const double height = stored.least_height * least * least / most;
  constexpr double largest_good = 1e8, least_area = 1e-18;  // well within the range of floats
  if (largest < largest_good &&
      height > rounding * largest + flattest * most * stored.longest_edge &&
      height * height > least_area)
    return true;
  const Mesh& mesh = scene_.instanced_meshes[stored.number];
  TriangleCheck check;
  const auto at = [&](uint32_t v) { return Vec3(world_from_mesh.point(Vec3d(mesh.positions[v]))); };
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
    return check.is_good(at(t[0]), at(t[1]), at(t[2]));
  });
}

bool MeshInstancer::place(const Key& key, size_t triangles, const Affine& world_from_mesh,
                          const std::string& name, const std::function<Mesh()>& make) {
  if (!is_instanceable(world_from_mesh)) return false;
  auto known = meshes_.find(key);
  if (known == meshes_.end()) {
    if (!is_worth(triangles, key.material) || !wants(triangles)) return false;
    Mesh mesh = make();
    if (mesh.triangles.empty()) return false;
    known = meshes_.emplace(key, store(std::move(mesh))).first;
  }
  const Stored& stored = known->second;
  if (!is_good(stored, world_from_mesh)) return false;
  const Box box = bounds_in_world(scene_.instanced_meshes[stored.number], world_from_mesh);
  bounds_.add_box({Vec3d(box.lower), Vec3d(box.upper)});
  scene_.instances.push_back(
      make_instance(stored.number, world_from_mesh, name, stored.reach, box));
  return true;
}

void finalize_instances(Scene& scene) {
  std::vector<uint32_t> uses(scene.instanced_meshes.size(), 0);
  for (const Instance& i : scene.instances) ++uses[i.mesh];
  std::erase_if(scene.instances, [&](const Instance& i) {
    if (uses[i.mesh] > 1) return false;
    Mesh& mesh = scene.instanced_meshes[i.mesh];
    scene.meshes.push_back(copied_to_world(MeshInWorld(mesh, &i)));
    mesh = {};
    return true;
  });
  std::vector<Mesh> kept;
  std::vector<uint32_t> number(uses.size(), 0);
  for (size_t m = 0; m < uses.size(); ++m) {
    if (uses[m] < 2) continue;
    number[m] = uint32_t(kept.size());
    kept.push_back(std::move(scene.instanced_meshes[m]));
  }
  scene.instanced_meshes = std::move(kept);
  for (Instance& i : scene.instances) i.mesh = number[i.mesh];
}

}  // namespace troffer
