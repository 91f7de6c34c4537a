// Shapes that a file places many times -> instances of a mesh that is stored once, where that pays.
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

// What a scene may hold by instances, all else included: numbers of triangles are 32 bits.
constexpr uint64_t max_placed_triangles = 4'000'000'000;

std::string too_many_by_instances();

class MeshInstancer {
 public:
  // Both must outlive this.
  MeshInstancer(Scene& scene, PlacedBounds& bounds) : scene_(scene), bounds_(bounds) {}

  // What placements have in common that share a mesh.
  struct Key {
    const void* shape = nullptr;  // lives as long as this
    uint32_t material = 0;
    uint32_t variant = 0;  // any number that tells ways to turn it apart
    auto operator<=>(const Key&) const = default;
  };

  // Adds one more instance: false where a copy is better or the only way, and none was added. That
  // is so of meshes of few triangles, of the first ones of a scene, while all copies together are
  // small; where the transform is next to singular, or a triangle has no area under it; and of
  // glass that may be thin, which is looked at in the world (thin_glass.h). triangles: as the file
  // counts them. world_from_mesh: from Scene::origin. make: the mesh in its own space, cleaned, its
  // front as without the transform, material set; called once for each key.
  bool place(const Key& key, size_t triangles, const Affine& world_from_mesh,
             const std::string& name, const std::function<Mesh()>& make);

  // Whether a mesh of so many triangles and that material is ever shared.
  bool is_worth(size_t triangles, uint32_t material) const;

 private:
  // A mesh that is stored, and what says that its triangles keep an area in the world.
  struct Stored {
    uint32_t number = 0;      // of Scene::instanced_meshes
    Vec3 reach;               // reach_of()
    double least_height = 0;  // of a triangle, above its longest edge
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

// Makes a plain mesh of what has only one instance, and removes what has none.
void settle_instances(Scene& scene);

}  // namespace troffer
