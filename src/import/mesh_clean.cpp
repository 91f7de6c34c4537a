#include "import/mesh_clean.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "import/triangle_check.h"

namespace troffer {

namespace {

constexpr size_t cleaned_at_once = size_t(1) << 16;  // items per parallel task

bool is_good(TriangleCheck& check, const Mesh& mesh, const Triangle& t) {
  return check.is_good(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]);
}

void drop_triangles(Mesh& mesh, WarningLog& warnings) {
  std::vector<TriangleCheck> checks(mesh.triangles.size() / cleaned_at_once + 1);
  parallel_pieces(mesh.triangles.size(), cleaned_at_once, [&](size_t first, size_t end) {
    TriangleCheck own;
    for (size_t i = first; i < end; ++i) is_good(own, mesh, mesh.triangles[i]);
    checks[first / cleaned_at_once] = own;
  });
  TriangleCheck all;
  for (const TriangleCheck& check : checks) all.add(check);
  all.report(warnings);
  if (all.bad() == 0) return;
  size_t kept = 0;
  for (size_t first = 0; first < mesh.triangles.size(); first += cleaned_at_once) {
    const size_t end = std::min(first + cleaned_at_once, mesh.triangles.size());
    const bool is_any_bad = checks[first / cleaned_at_once].bad() > 0;
    for (size_t i = first; i < end; ++i) {
      TriangleCheck again;
      if (!is_any_bad || is_good(again, mesh, mesh.triangles[i]))
        mesh.triangles[kept++] = mesh.triangles[i];
    }
  }
  mesh.triangles.resize(kept);
}

// True if is_sound(i) for all i in [0, n).
template <class IsSound>
bool are_all(size_t n, const IsSound& is_sound) {
  std::atomic<bool> result{true};
  parallel_pieces(n, cleaned_at_once, [&](size_t first, size_t end) {
    for (size_t i = first; i < end && result; ++i)
      if (!is_sound(i)) result = false;
  });
  return result;
}

void drop_vertices(Mesh& mesh) {
  if (are_all(mesh.positions.size(), [&](size_t i) { return is_finite(mesh.positions[i]); }))
    return;
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

// Normalises a vector; false if it is zero or not finite.
bool make_unit(Vec3& normal) {
  const Vec3d n(normal);
  const double size = length(n);
  if (!(size > 0 && std::isfinite(size))) return false;
  normal = Vec3(n / size);
  return true;
}

void repair_normals(Mesh& mesh) {
  std::vector<uint8_t> is_bad(mesh.normals.size());
  parallel_pieces(mesh.normals.size(), cleaned_at_once, [&](size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) is_bad[i] = !make_unit(mesh.normals[i]);
  });
  if (std::find(is_bad.begin(), is_bad.end(), 1) == is_bad.end()) return;
  std::vector<Vec3d> replacements;
  replacements.resize(mesh.normals.size());
  for (const Triangle& t : mesh.triangles)
    for (const uint32_t v : t) replacements[v] += area_vector(mesh, t);
  for (size_t i = 0; i < mesh.normals.size(); ++i) {
    if (!is_bad[i]) continue;
    const double size = length(replacements[i]);
    // no triangle uses the vertex
    mesh.normals[i] = size > 0 ? Vec3(replacements[i] / size) : Vec3{0, 0, 1};
  }
}

}  // namespace

void clean_mesh(Mesh& mesh, WarningLog& warnings) {
  drop_triangles(mesh, warnings);
  drop_vertices(mesh);
  repair_normals(mesh);
  for (std::vector<Vec2>* const set : {&mesh.uvs, &mesh.uvs_2})
    parallel_pieces(set->size(), cleaned_at_once, [&](size_t first, size_t end) {
      for (size_t i = first; i < end; ++i) {
        Vec2& uv = (*set)[i];
        if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) uv = {0, 0};
      }
    });
}

void add_only_mesh(Mesh mesh, Scene& scene) {
  clean_mesh(mesh, scene.warnings);
  scene.materials.emplace_back();
  if (mesh.triangles.empty()) {
    scene.warnings.add("the scene has no visible triangles");
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
