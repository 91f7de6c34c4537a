// Meshes in world space: those of Scene::meshes, and instances. Corners of instances are computed
// on demand in double precision and rounded once, so they equal those of a copy in the world. Used
// by ray tracing, lights and exporters. Positions are in metres from Scene::origin.
//
// Geometry numbers of hits: meshes first, then one number for all spheres, one for all disks, then
// instances.
#pragma once

#include <array>
#include <cstdint>
#include <utility>

#include "scene/scene.h"

namespace troffer {

inline uint32_t first_instance(const Scene& scene) {
  return uint32_t(scene.meshes.size()) + 2;
}
inline bool is_instance(const Scene& scene, uint32_t geometry) {
  return geometry >= first_instance(scene);
}
inline bool is_mesh(const Scene& scene, uint32_t geometry) {
  return geometry < scene.meshes.size() || is_instance(scene, geometry);
}

class MeshInWorld {
 public:
  // Both must outlive this object. Without an instance the mesh is in world space already.
  explicit MeshInWorld(const Mesh& mesh, const Instance* instance = nullptr)
      : mesh_(mesh), instance_(instance) {}

  const Mesh& mesh() const { return mesh_; }
  const Instance* instance() const { return instance_; }
  const std::string& name() const { return instance_ != nullptr ? instance_->name : mesh_.name; }
  size_t size() const { return mesh_.triangles.size(); }

  // Vertex indices, in the order that shows the front in world space.
  Triangle triangle(size_t i) const {
    const Triangle& t = mesh_.triangles[i];
    return instance_ != nullptr && instance_->is_mirrored ? Triangle{t[0], t[2], t[1]} : t;
  }
  Vec3 position(uint32_t vertex) const {
    const Vec3& p = mesh_.positions[vertex];
    return instance_ != nullptr ? Vec3(instance_->world_from_mesh.point(Vec3d(p))) : p;
  }
  // Unit normal. The mesh must have normals.
  Vec3 normal(uint32_t vertex) const {
    const Vec3& n = mesh_.normals[vertex];
    return instance_ != nullptr ? in_world(n) : n;
  }
  std::array<Vec3, 3> corners(size_t i) const {
    const Triangle t = triangle(i);
    return {position(t[0]), position(t[1]), position(t[2])};
  }

 private:
  Vec3 in_world(const Vec3& normal) const;

  const Mesh& mesh_;
  const Instance* instance_;
};

// Returns the mesh with that geometry number. Requires is_mesh().
inline MeshInWorld mesh_at(const Scene& scene, uint32_t geometry) {
  if (geometry < scene.meshes.size()) return MeshInWorld(scene.meshes[geometry]);
  const Instance& i = scene.instances[geometry - first_instance(scene)];
  return MeshInWorld(scene.instanced_meshes[i.mesh], &i);
}

// Calls visit(number, MeshInWorld) for all meshes, then for all instances.
template <class Visit>
void for_each_mesh(const Scene& scene, const Visit& visit) {
  const auto meshes = uint32_t(scene.meshes.size()), instances = uint32_t(scene.instances.size());
  for (uint32_t i = 0; i < meshes; ++i) visit(i, mesh_at(scene, i));
  for (uint32_t i = 0; i < instances; ++i) visit(meshes + 2 + i, mesh_at(scene, meshes + 2 + i));
}

// Makes an instance of instanced mesh `number`. The transform must be is_instanceable(). `reach` is
// reach_of() the mesh and `bounds` its bounds_in_world().
Instance make_instance(uint32_t number, const Affine& world_from_mesh, std::string name,
                       const Vec3& reach, const Box& bounds);
Vec3 reach_of(const Mesh& mesh);  // largest absolute coordinate per axis
Box bounds_in_world(const Mesh& mesh, const Affine& world_from_mesh);  // box of all vertices

// True if rays can be transformed to a mesh and back without losing more than a few times the
// rounding error of world space. False for singular, nearly singular and infinite transforms.
bool is_instanceable(const Affine& world_from_mesh);

// Returns a copy of the mesh in world space.
Mesh copied_to_world(const MeshInWorld& mesh);

}  // namespace troffer
