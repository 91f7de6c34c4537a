// Instancing of meshes that a file places many times: a mesh is stored once if that saves memory
// without slowing rays. Importers (glTF, pbrt, Mitsuba) offer each placement to
// MeshInstancer::place and copy the mesh if it declines. docs/reference/formats.md#instances lists
// the rules.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "base/transform.h"
#include "import/recentre.h"
#include "scene/scene.h"

namespace troffer {

// Limit on all triangles of a scene, instances counted in full: triangle numbers have 32 bits.
constexpr uint64_t max_placed_triangles = 4'000'000'000;

// Returns the error message for scenes beyond that limit.
std::string too_many_by_instances();

// Decides between instances and copies, and stores the shared meshes of a scene.
class MeshInstancer {
 public:
  // Both must outlive this object.
  MeshInstancer(Scene& scene, PlacedBounds& bounds) : scene_(scene), bounds_(bounds) {}

  // Identity of a shared mesh: placements with equal keys share it.
  struct Key {
    const void* shape = nullptr;  // must outlive this object
    uint32_t material = 0;
    uint32_t variant = 0;  // distinguishes different versions of a shape, for example reversed ones
    auto operator<=>(const Key&) const = default;
  };

  // Adds an instance, or returns false if the mesh must or should be copied. The first meshes are
  // copied while all copies together are small. The following are always copied:
  // - meshes of few triangles;
  // - glass that may be thin, because thin_glass.h works in world space;
  // - meshes under a nearly singular transform, or one that reduces a triangle's area to 0.
  // `triangles`: the file's count. `world_from_mesh`: relative to Scene::origin. `make`: returns
  // the cleaned mesh with its material in its own space, with the front that it has there. It is
  // called at most once per stored mesh.
  bool place(const Key& key, size_t triangles, const Affine& world_from_mesh,
             const std::string& name, const std::function<Mesh()>& make);

  // True if a mesh of that size and material may be shared at all.
  bool is_worth(size_t triangles, uint32_t material) const;

 private:
  // A stored mesh, with the bounds that prove that its triangles keep an area in world space.
  struct Stored {
    uint32_t number = 0;      // index into Scene::instanced_meshes
    Vec3 reach;               // reach_of() the mesh
    double least_height = 0;  // smallest height of a triangle over its longest edge
    double longest_edge = 0;
  };
  bool wants(size_t triangles);
  Stored store(Mesh mesh);
  bool is_good(const Stored& stored, const Affine& world_from_mesh) const;

  Scene& scene_;
  PlacedBounds& bounds_;
  std::map<Key, Stored> meshes_;
  size_t copied_triangles_ = 0;
};

// Turns meshes with a single instance into plain meshes, and removes meshes without instances.
void finalize_instances(Scene& scene);

}  // namespace troffer
