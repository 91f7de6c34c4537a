// Shapes of a pbrt file -> geometry and lights of the scene, in world space.
#pragma once

#include "import/gltf/mesh_instancer.h"
#include "import/pbrt/pbrt_shape.h"

namespace troffer {

class PbrtPlacer {
 public:
  PbrtPlacer(Scene& scene, PbrtMaterials& materials, PlacedBounds& bounds)
      : scene_(scene), materials_(materials), bounds_(bounds), instancer_(scene, bounds) {}

  // Adds the shape, emission included.
  void place(const PbrtShape& shape, const PbrtPlace& place);
  // Adds one more copy, transformed, without emission.
  void place_instance(const PbrtShape& shape, const Affine& world_from_instance,
                      const PbrtPlace& place);
  // Counts a shape that waits in an object, so that the limit holds for what is never placed too.
  void count_waiting(const PbrtShape& shape, const PbrtPlace& place);
  // Another shape with an area light has appeared that will not be placed: it keeps its number.
  void skip_light() { ++lights_; }
  // Lights without surface are counted apart, so that those of shapes keep their numbers.
  size_t next_light_source() { return light_sources_++; }

 private:
  // A shape on its way into the scene.
  struct Placing {
    const PbrtShape& shape;
    Affine world_from_object;         // its translation from the scene's origin
    bool is_flipped_quadric = false;  // normals of quadrics point the other way
    bool is_emitting = false;
    bool is_instance = false;  // one of many, of an object
    PbrtPlace place;
  };

  Scene& scene_;
  PbrtMaterials& materials_;
  PlacedBounds& bounds_;
  MeshInstancer instancer_;
  size_t lights_ = 0, light_sources_ = 0;
  size_t cost_ = 0;                // triangles so far; small shapes count as a few
  uint64_t placed_triangles_ = 0;  // by instances

  void place(Placing placing);
  void place_sphere(const Placing& placing);
  void place_disk(const Placing& placing);
  void place_mesh(const Placing& placing, const AnchoredMesh& local, bool is_quadric);
  bool place_shared(const Placing& placing, const AnchoredMesh& local, bool is_quadric);
  void set_normal_map(Mesh& mesh);
  static bool are_normals_turned(const Placing& placing, bool is_quadric);
  uint32_t material_of(const Placing& placing);
  bool needs_triangles(const Placing& placing);
  // Emission of the next light, whose area (m²) turns power into radiance.
  Light next_light(const PbrtAreaLight& light, double area);
  void spend(size_t triangles, const PbrtPlace& place);
};

}  // namespace troffer
