#include "report/flat_faces.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "base/disjoint_sets.h"
#include "base/random.h"
#include "scene/mesh_in_world.h"

namespace troffer {

namespace {

constexpr double least_cosine = 0.99985;  // cosine of one degree

using Corners = std::array<Vec3d, 3>;

Corners corners_in_file(const Scene& scene, const MeshInWorld& mesh, size_t i) {
  const auto c = mesh.corners(i);
  return {Vec3d(c[0]) + scene.origin, Vec3d(c[1]) + scene.origin, Vec3d(c[2]) + scene.origin};
}

// Twice the area of a triangle, along its front normal.
Vec3d area_of(const Corners& c) {
  return cross(c[1] - c[0], c[2] - c[0]);
}

struct Found {
  std::vector<Corners> triangles;
  std::vector<uint32_t> mesh;  // number of the mesh's name, per triangle
  std::vector<std::string> names;
};

Found triangles_towards(const Scene& scene, const Vec3d& towards, const std::string* node) {
  Found found;
  for_each_mesh(scene, [&](uint32_t, const MeshInWorld& mesh) {
    if (node != nullptr && mesh.name() != *node) return;
    const auto name = uint32_t(found.names.size());
    found.names.push_back(mesh.name());
    for (size_t i = 0; i < mesh.size(); ++i) {
      const Corners c = corners_in_file(scene, mesh, i);
      const Vec3d a = area_of(c);
      const double area = length(a);
      if (!(area > 0) || dot(a, towards) < least_cosine * area) continue;
      found.triangles.push_back(c);
      found.mesh.push_back(name);
    }
  });
  return found;
}

uint64_t key_of(const Vec3d& p) {
  const auto cell = [](double x) { return uint64_t(std::llround(x * 1e4)); };
  return hash_of(cell(p.x), cell(p.y), cell(p.z));
}

DisjointSets joined(const std::vector<Corners>& triangles) {
  DisjointSets sets(triangles.size());
  std::unordered_map<uint64_t, uint32_t> first;
  for (uint32_t i = 0; i < triangles.size(); ++i)
    for (const Vec3d& p : triangles[i]) {
      const auto [at, is_new] = first.emplace(key_of(p), i);
      if (!is_new) sets.join(at->second, i);
    }
  return sets;
}

}  // namespace

std::vector<FlatFace> flat_faces(const Scene& scene, const Vec3d& towards,
                                 const std::string* node) {
  const Found found = triangles_towards(scene, towards, node);
  DisjointSets sets = joined(found.triangles);
  std::map<uint32_t, uint32_t> number;  // index of the face of a set
  std::vector<FlatFace> faces;
  std::vector<std::map<uint32_t, double>> parts;  // area by mesh, per face
  for (uint32_t i = 0; i < found.triangles.size(); ++i) {
    const auto [at, is_new] = number.emplace(sets.find(i), uint32_t(faces.size()));
    if (is_new) {
      faces.emplace_back();
      parts.emplace_back();
    }
    FlatFace& face = faces[at->second];
    const double area = 0.5 * length(area_of(found.triangles[i]));
    face.triangles.push_back(found.triangles[i]);
    face.area += area;
    face.height += area * dot(found.triangles[i][0], towards);
    parts[at->second][found.mesh[i]] += area;
  }
  for (size_t f = 0; f < faces.size(); ++f) {
    faces[f].height /= faces[f].area;
    const auto most = std::max_element(parts[f].begin(), parts[f].end(),
                                       [](auto& a, auto& b) { return a.second < b.second; });
    faces[f].name = found.names[most->first];
  }
  std::stable_sort(faces.begin(), faces.end(),
                   [](const FlatFace& a, const FlatFace& b) { return a.area > b.area; });
  return faces;
}

bool has_node(const Scene& scene, const std::string& node) {
  bool is_there = false;
  for_each_mesh(scene, [&](uint32_t, const MeshInWorld& mesh) {
    is_there = is_there || mesh.name() == node;
  });
  return is_there;
}

Vec3d facing_of_node(const Scene& scene, const std::string& node) {
  constexpr double flatness = 0.97;
  Vec3d sum;
  double all = 0;
  for_each_mesh(scene, [&](uint32_t, const MeshInWorld& mesh) {
    if (mesh.name() != node) return;
    for (size_t i = 0; i < mesh.size(); ++i) {
      const Vec3d a = area_of(corners_in_file(scene, mesh, i));
      sum += a;
      all += length(a);
    }
  });
  return length(sum) > flatness * all && all > 0 ? normalize(sum) : Vec3d{};
}

}  // namespace troffer
