#include "import/mesh_clean.h"

#include "import/triangle_check.h"

namespace troffer {

namespace {

void drop_triangles(Mesh& mesh, WarningLog& warnings) {
  TriangleCheck check;
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return !check.is_good(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]);
  });
  check.report(warnings);
}

void drop_vertices(Mesh& mesh) {
  std::vector<uint32_t> renumbered(mesh.positions.size());
  size_t kept = 0;
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    renumbered[i] = uint32_t(kept);
    if (!is_finite(mesh.positions[i])) continue;
    mesh.positions[kept] = mesh.positions[i];
    if (!mesh.normals.empty()) mesh.normals[kept] = mesh.normals[i];
    if (!mesh.uvs.empty()) mesh.uvs[kept] = mesh.uvs[i];
    if (!mesh.uvs_2.empty()) mesh.uvs_2[kept] = mesh.uvs_2[i];
    ++kept;
  }
  if (kept == mesh.positions.size()) return;
  mesh.positions.resize(kept);
  if (!mesh.normals.empty()) mesh.normals.resize(kept);
  if (!mesh.uvs.empty()) mesh.uvs.resize(kept);
  if (!mesh.uvs_2.empty()) mesh.uvs_2.resize(kept);
  for (Triangle& t : mesh.triangles)
    for (uint32_t& v : t) v = renumbered[v];
}

void repair_normals(Mesh& mesh) {
  std::vector<Vec3d> replacements;
  std::vector<bool> is_bad;
  for (size_t i = 0; i < mesh.normals.size(); ++i) {
    const Vec3d n(mesh.normals[i]);
    const double size = length(n);
    if (size > 0 && std::isfinite(size)) {
      mesh.normals[i] = Vec3(n / size);
      continue;
    }
    if (is_bad.empty()) is_bad.resize(mesh.normals.size());
    is_bad[i] = true;
  }
  if (is_bad.empty()) return;
  replacements.resize(mesh.normals.size());
  for (const Triangle& t : mesh.triangles)
    for (const uint32_t v : t) replacements[v] += area_vector(mesh, t);
  for (size_t i = 0; i < mesh.normals.size(); ++i) {
    if (!is_bad[i]) continue;
    const double size = length(replacements[i]);
    mesh.normals[i] = size > 0 ? Vec3(replacements[i] / size) : Vec3{0, 0, 1};  // no triangle here
  }
}

}  // namespace

void clean_mesh(Mesh& mesh, WarningLog& warnings) {
  drop_triangles(mesh, warnings);
  drop_vertices(mesh);
  repair_normals(mesh);
  for (std::vector<Vec2>* const set : {&mesh.uvs, &mesh.uvs_2})
    for (Vec2& uv : *set)
      if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) uv = {0, 0};
}

void show_alone(Mesh mesh, Scene& scene) {
  clean_mesh(mesh, scene.warnings);
  scene.materials.emplace_back();
  if (mesh.triangles.empty()) {
    scene.warnings.add("the scene shows no triangles");
    return;
  }
  scene.meshes.push_back(std::move(mesh));
}

double area_of(const Mesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) sum += 0.5 * length(area_vector(mesh, t));
  return sum;
}

void add_default_uvs(Mesh& mesh) {
  if (!mesh.uvs.empty()) return;
  Mesh split;
  const size_t corners = mesh.triangles.size() * 3;
  split.positions.reserve(corners);
  split.uvs.reserve(corners);
  if (!mesh.normals.empty()) split.normals.reserve(corners);
  for (Triangle& t : mesh.triangles) {
    for (const uint32_t v : t) {
      split.positions.push_back(mesh.positions[v]);
      if (!mesh.normals.empty()) split.normals.push_back(mesh.normals[v]);
    }
    split.uvs.insert(split.uvs.end(), {Vec2{0, 0}, Vec2{1, 0}, Vec2{1, 1}});
    const auto first = uint32_t(split.positions.size() - 3);
    t = {first, first + 1, first + 2};
  }
  mesh.positions = std::move(split.positions);
  mesh.normals = std::move(split.normals);
  mesh.uvs = std::move(split.uvs);
}

}  // namespace troffer
