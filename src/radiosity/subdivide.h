// Bisects triangles at their longest edges into fragments, without gaps. Edges are cut in the
// middle until none is longer than requested, so that both triangles at an edge cut it alike.
// Lengths are in metres.
//
// Spheres and disks are subdivided as octahedra and squares, and bulged afterwards.
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

// One mesh, sphere, disk or instance of the scene. Vertices are welded by position within the
// surface; triangles without area have none.
struct BaseSurface {
  Bulge bulge = Bulge::none;
  uint32_t index = 0;  // sphere or disk of the scene; else geometry as in Hit
  uint32_t material = 0;
  uint32_t first_triangle = 0, triangle_count = 0;  // in BaseGeometry::triangles
};

struct BaseTriangle {
  std::array<uint32_t, 3> vertices{};
  uint32_t surface = 0;
  int32_t light = no_light;
  bool is_degenerate = false;
};

// Metres from the origin. More distant surfaces are left out, because products of their sizes
// overflow a float.
constexpr float farthest_surface = 1e10f;

// All surfaces of a scene as triangles over welded vertices.
struct BaseGeometry {
  std::vector<BaseSurface> surfaces;  // meshes, spheres, disks, instances
  std::vector<BaseTriangle> triangles;
  std::vector<Vec3> positions;  // world
  // positions before bulging, in the sphere's or disk's frame; meshes: unused
  std::vector<Vec3> flat;
  uint32_t left_out = 0;  // triangles, spheres and disks beyond farthest_surface
};
BaseGeometry base_geometry(const Scene& scene);

// Maps a point of the octahedron |x|+|y|+|z| = 1 (disk: z = 0) to the round surface, in world
// space.
Vec3 bulged(const Scene& scene, const BaseSurface& surface, const Vec3& flat);
// Inverse of bulged(): returns the triangle of the surface that contains the point, and its
// weights.
uint32_t flat_triangle(const Scene& scene, const BaseSurface& surface, const Vec3& position,
                       Vec3& weights);

// Makes the vertices of subdivision; triangles share those of common edges.
class Subdivider {
 public:
  Subdivider(const Scene& scene, BaseGeometry& geometry) : scene_(scene), geometry_(geometry) {}

  // Returns the longest edge in metres; `edge` is its index.
  float longest_edge(const std::array<uint32_t, 3>& t, uint8_t& edge) const;
  uint32_t midpoint(uint32_t surface, uint32_t a, uint32_t b);
  // Returns the corners of both halves.
  std::array<std::array<uint32_t, 3>, 2> split(uint32_t surface, const std::array<uint32_t, 3>& t,
                                               uint8_t edge);

 private:
  const Scene& scene_;
  BaseGeometry& geometry_;
  std::unordered_map<uint64_t, uint32_t> midpoints_;
};

// Longest edge of a triangle: between corners `number` and number + 1.
struct LongestEdge {
  size_t number = 0;
  float square = -1;  // squared length, m²
};
LongestEdge longest_edge(std::span<const Vec3, 3> triangle);

// Returns the number of fragments no longer than `size` in a triangle (approximate for round
// surfaces); stops at `limit`.
size_t count_fragments(const BaseGeometry& geometry, uint32_t triangle, double size, size_t limit);

}  // namespace troffer
