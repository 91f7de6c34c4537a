// Placement of shapes with spaces of their own into a scene: geometry and lights in world space.
// The importers of Mitsuba and Radiance use GeometryPlacer; pbrt uses the functions below it.
// Repeated meshes become instances (gltf/mesh_instancer.h).
#pragma once

#include <optional>

#include "base/transform.h"
#include "import/emissive.h"
#include "import/gltf/mesh_instancer.h"
#include "import/recentre.h"
#include "import/source_place.h"

namespace troffer {

// Material and emission of a shape, and its place in the file.
struct ShapeAttributes {
  uint32_t material = 0;
  const void* shape = nullptr;           // identity of a shape with several placements; else null
  std::optional<EmissionSpec> emission;  // black: no emission
  SourcePlace place;
};

// Adds shapes to a scene. Transforms lead to the file's world; positions are then counted from
// Scene::origin. A shape that is not finite or has no area is left out with a warning. Throws
// InputError at the shape's place if the scene exceeds its limits.
class GeometryPlacer {
 public:
  // Both must outlive this object.
  GeometryPlacer(Scene& scene, PlacedBounds& bounds)
      : scene_(scene), bounds_(bounds), instancer_(scene, bounds) {}

  // Adds a mesh or an instance. Its front is the side of the mesh's normals, or of its winding in
  // the world if it has none; `is_turned` selects the other side. Normals keep their side under
  // mirroring transforms.
  void add_mesh(const AnchoredMesh& local, const Affine& world_from_local, bool is_turned,
                const ShapeAttributes& look);
  // Adds a sphere whose front is outside, or inside if `is_turned`. Tessellates it if the transform
  // is not a similarity or the material depends on (u,v).
  void add_sphere(const Affine& world_from_local, const Vec3d& centre, double radius,
                  bool is_turned, const ShapeAttributes& look);
  // True if that material or emission depends on (u,v).
  bool needs_coordinates(const ShapeAttributes& look) const;
  // Adds a disk around the origin. Its front is the side that +z is mapped to; `is_turned` selects
  // the other side. Tessellates as add_sphere does.
  void add_disk(const Affine& world_from_local, double radius, bool is_turned,
                const ShapeAttributes& look);

 private:
  Scene& scene_;
  PlacedBounds& bounds_;
  MeshInstancer instancer_;
  size_t cost_ = 0;  // triangles so far; small shapes count as least_shape_cost
  uint64_t placed_triangles_ = 0;

  bool add_instance(const AnchoredMesh& local, const Affine& world_from_local, bool is_turned,
                    const ShapeAttributes& look);
  void spend(size_t triangles, const SourcePlace& place);
  // Appends the light of a sphere or disk; returns no_light if it does not emit.
  int32_t add_light(const ShapeAttributes& look, LightKind kind, size_t geometry);
};

// Returns a mesh in the target space of a transform, not cleaned (mesh_clean.h). The front of each
// triangle is the side of its normals, reversed if `are_normals_turned`. Without normals it is the
// side of its winding in the target, reversed if `is_winding_turned`.
Mesh transformed(const AnchoredMesh& local, const Affine& target_from_local,
                 bool are_normals_turned, bool is_winding_turned);

// Adds the triangles of a transformed mesh to `bounds`.
void add_bounds(const AnchoredMesh& local, const Affine& target_from_local, PlacedBounds& bounds);

// Transforms a normal: inverse transpose up to a positive factor, which keeps the side that it
// points to.
Vec3d covector(const Affine& t, const Vec3d& n);

// Winds each triangle so that its front is the side of its normals; without normals, reverses it if
// `is_turned`.
void orient(Mesh& mesh, bool is_turned);

// True if the transform maps circles in the plane of the two axes to circles.
bool keeps_circles(const Affine& t, size_t axis_a, size_t axis_b);

}  // namespace troffer
