// Shapes in spaces of their own -> geometry and sources of a scene, in world space.
#pragma once

#include <optional>

#include "base/transform.h"
#include "import/emissive.h"
#include "import/gltf/mesh_instancer.h"
#include "import/recentre.h"
#include "import/source_place.h"

namespace troffer {

// What a shape wears, and where its file names it.
struct PlacedLook {
  uint32_t material = 0;
  const void* shape = nullptr;  // the same for all places of a shape that has several; else null
  std::optional<EmissionSpec> emission;  // black: as if there were none
  SourcePlace place;
};

// Every function takes transforms to the file's world and counts positions from Scene::origin. A
// shape that is not finite or has no area is left out with a warning. InputError, at the shape's
// place: more geometry than a scene may have.
class GeometryPlacer {
 public:
  // Both must outlive this.
  GeometryPlacer(Scene& scene, PlacedBounds& bounds)
      : scene_(scene), bounds_(bounds), instancer_(scene, bounds) {}

  // Front: the side of the mesh's normals where there are some, else of its winding in the world;
  // the other one where is_turned. Normals keep their side under transforms that mirror.
  void add_mesh(const AnchoredMesh& local, const Affine& world_from_local, bool is_turned,
                const PlacedLook& look);
  // Front: outside, or inside where is_turned. Triangles where the transform is no similarity or
  // the material has textures.
  void add_sphere(const Affine& world_from_local, const Vec3d& centre, double radius,
                  bool is_turned, const PlacedLook& look);
  // Whether that look depends on (u,v).
  bool needs_coordinates(const PlacedLook& look) const;
  // About the origin; front: the side +z is taken to, or the other one. Triangles as for spheres.
  void add_disk(const Affine& world_from_local, double radius, bool is_turned,
                const PlacedLook& look);

 private:
  Scene& scene_;
  PlacedBounds& bounds_;
  MeshInstancer instancer_;
  size_t cost_ = 0;  // triangles so far; small shapes count as a few
  uint64_t placed_triangles_ = 0;

  bool add_instance(const AnchoredMesh& local, const Affine& world_from_local, bool is_turned,
                    const PlacedLook& look);
  void spend(size_t triangles, const SourcePlace& place);
  // Appends the light of a sphere or disk; no_light where it is dark.
  int32_t add_light(const PlacedLook& look, LightKind kind, size_t geometry);
};

// A mesh under a transform: positions and normals in its target; the front of each triangle the
// side of its normals where there are some, which are turned where are_normals_turned, else of its
// winding there, turned where is_winding_turned. Not cleaned (mesh_clean.h).
Mesh transformed(const AnchoredMesh& local, const Affine& target_from_local,
                 bool are_normals_turned, bool is_winding_turned);

// Counts its triangles, as they come to lie.
void add_bounds(const AnchoredMesh& local, const Affine& target_from_local, PlacedBounds& bounds);

// A normal taken along: inverse transpose up to a positive factor, which keeps the side that it
// points to.
Vec3d covector(const Affine& t, const Vec3d& n);

// The front of each triangle: the side of its normals where there are some, else of its winding,
// turned where is_turned.
void orient(Mesh& mesh, bool is_turned);

// Whether that transform takes circles in the plane of those two axes to circles.
bool keeps_circles(const Affine& t, size_t axis_a, size_t axis_b);

}  // namespace troffer
