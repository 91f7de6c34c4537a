// Shapes in spaces of their own -> geometry and sources of a scene, in world space.
#pragma once

#include <optional>

#include "base/transform.h"
#include "import/emissive.h"
#include "import/recentre.h"
#include "import/source_place.h"

namespace troffer {

// What a shape wears, and where its file names it.
struct PlacedLook {
  uint32_t material = 0;
  std::optional<EmissionSpec> emission;  // black: as if there were none
  SourcePlace place;
};

// Every function takes transforms to the file's world and counts positions from Scene::origin. A
// shape that is not finite or has no area is left out with a warning. InputError, at the shape's
// place: more geometry than a scene may have.
class GeometryPlacer {
 public:
  // Both must outlive this.
  GeometryPlacer(Scene& scene, PlacedBounds& bounds) : scene_(scene), bounds_(bounds) {}

  // Front: the side of the mesh's normals where there are some, else of its winding in the world;
  // the other one where is_turned. Normals keep their side under transforms that mirror.
  void add_mesh(const AnchoredMesh& local, const Affine& world_from_local, bool is_turned,
                const PlacedLook& look);
  // Front: outside, or inside where is_turned. Triangles where the transform is no similarity or
  // the material has textures.
  void add_sphere(const Affine& world_from_local, const Vec3d& centre, double radius,
                  bool is_turned, const PlacedLook& look);
  // About the origin; front: the side +z is taken to, or the other one. Triangles as for spheres.
  void add_disk(const Affine& world_from_local, double radius, bool is_turned,
                const PlacedLook& look);

 private:
  Scene& scene_;
  PlacedBounds& bounds_;
  size_t cost_ = 0;  // triangles so far; small shapes count as a few

  void spend(size_t triangles, const SourcePlace& place);
  bool needs_coordinates(const PlacedLook& look) const;
  // Appends the light of a sphere or disk; no_light where it is dark.
  int32_t add_light(const PlacedLook& look, LightKind kind, size_t geometry);
};

// A normal taken along: inverse transpose up to a positive factor, which keeps the side that it
// points to.
Vec3d covector(const Affine& t, const Vec3d& n);

// The front of each triangle: the side of its normals where there are some, else of its winding,
// turned where is_turned.
void orient(Mesh& mesh, bool is_turned);

// Whether that transform takes circles in the plane of those two axes to circles.
bool keeps_circles(const Affine& t, size_t axis_a, size_t axis_b);

}  // namespace troffer
