// Adds the shapes of a pbrt file to the scene's geometry and lights, in world space. Used by
// PbrtInterpreter, which hands over each shape when its directive is read.
#pragma once

#include "import/gltf/mesh_instancer.h"
#include "import/pbrt/pbrt_shape.h"

namespace troffer {

class PbrtPlacer {
 public:
  PbrtPlacer(Scene& scene, PbrtMaterials& materials, PlacedBounds& bounds)
      : scene_(scene), materials_(materials), bounds_(bounds), instancer_(scene, bounds) {}

  // Adds the shape with its emission.
  void place(const PbrtShape& shape, const PbrtPlace& place);
  // Adds one more transformed copy, without emission.
  void place_instance(const PbrtShape& shape, const Affine& world_from_instance,
                      const PbrtPlace& place);
  // Counts a shape of an object definition, so that the limit covers objects that are never placed.
  void count_waiting(const PbrtShape& shape, const PbrtPlace& place);
  // Reserves the number of an emitting shape that is not placed, so that later lights keep theirs.
  void skip_light() { ++lights_; }
  // Number of the next light without a surface. These have a count of their own, so that the lights
  // of shapes keep their numbers.
  size_t next_light_source() { return light_sources_++; }

 private:
  // A shape that is being placed.
  struct Placing {
    const PbrtShape& shape;
    Affine world_from_object;         // relative to the scene's origin
    bool is_flipped_quadric = false;  // the quadric's normals point the other way
    bool is_emitting = false;
    bool is_instance = false;  // part of an object that is instanced
    PbrtPlace place;
  };

  Scene& scene_;
  PbrtMaterials& materials_;
  PlacedBounds& bounds_;
  MeshInstancer instancer_;
  size_t lights_ = 0, light_sources_ = 0;
  size_t cost_ = 0;                // triangles so far; each shape counts at least least_shape_cost
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
  // Returns the emission of the next light. Its area (m²) converts power to radiance.
  Light next_light(const PbrtAreaLight& light, double area);
  void spend(size_t triangles, const PbrtPlace& place);
};

}  // namespace troffer
