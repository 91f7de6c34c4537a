// Cutting of triangles by their longest edges into fragments, without gaps: edges are cut in the
// middle until no edge is longer than wanted, so that both triangles at an edge cut it alike.
//
// Spheres and disks take part as octahedra and squares, cut in the flat and bulged out afterwards.
// References: [1] Rivara, "Algorithms for Refining Triangular Grids Suitable for Adaptive and
//   Multigrid Techniques", Int. J. Numer. Meth. Eng. 20, 1984.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "radiosity/patch.h"
#include "scene/scene.h"

namespace troffer {

enum class Bulge : uint8_t { none, sphere, disk };

// One mesh, sphere, disk or instance of the scene. Corners are numbers of welded vertices (by
// position, within the surface); triangles without area have none.
struct BaseSurface {
  Bulge bulge = Bulge::none;
  uint32_t index = 0;  // sphere or disk of the scene; else geometry, as hits have it
  uint32_t material = 0;
  uint32_t first_triangle = 0, triangle_count = 0;  // in BaseGeometry::triangles
};

struct BaseTriangle {
  std::array<uint32_t, 3> vertices{};
  uint32_t surface = 0;
  int32_t light = no_light;
  bool is_degenerate = false;
};

// All surfaces of a scene as triangles over welded vertices.
// Metres from the origin. Farther surfaces are left out: products of their sizes do not fit a
// float.
constexpr float farthest_surface = 1e10f;

struct BaseGeometry {
  std::vector<BaseSurface> surfaces;  // meshes, spheres, disks, instances
  std::vector<BaseTriangle> triangles;
  std::vector<Vec3> positions;  // world
  std::vector<Vec3> flat;       // the same before bulging, in the sphere's or disk's own frame;
                                // equal to the position for meshes
  uint32_t left_out = 0;        // triangles, spheres and disks that reach beyond farthest_surface
};
BaseGeometry base_geometry(const Scene& scene);

// A point of the octahedron |x|+|y|+|z| = 1 (disk: z = 0) on the round surface, in world space.
Vec3 bulged(const Scene& scene, const BaseSurface& surface, const Vec3& flat);
// The inverse, and the triangle of the surface that the point belongs to, with weights.
uint32_t flat_triangle(const Scene& scene, const BaseSurface& surface, const Vec3& position,
                       Vec3& weights);

// The vertices that subdivision adds; those of equal edges are shared.
class Subdivider {
 public:
  Subdivider(const Scene& scene, BaseGeometry& geometry) : scene_(scene), geometry_(geometry) {}

  // Longest edge, metres; `edge` is its number.
  float longest_edge(const std::array<uint32_t, 3>& t, uint8_t& edge) const;
  uint32_t midpoint(uint32_t surface, uint32_t a, uint32_t b);
  // The corners of both halves.
  std::array<std::array<uint32_t, 3>, 2> split(uint32_t surface, const std::array<uint32_t, 3>& t,
                                               uint8_t edge);

 private:
  const Scene& scene_;
  BaseGeometry& geometry_;
  std::unordered_map<uint64_t, uint32_t> midpoints_;
};

// A triangle's longest edge: between corners `number` and number + 1.
struct LongestEdge {
  size_t number = 0;
  float square = -1;  // of its length, m²
};
LongestEdge longest_edge(std::span<const Vec3, 3> triangle);

// How many fragments no longer than `size` a triangle has (a round one: about); stops at `limit`.
size_t count_fragments(const BaseGeometry& geometry, uint32_t triangle, double size, size_t limit);

}  // namespace troffer
