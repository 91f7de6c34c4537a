// Builds the mesh for radiosity from a scene: sheets, elements, patches and sample points
// (radiosity/patch.h). The solver uses it; lengths are in metres.
//
// Triangles larger than the patch size are cut into sheets of at most that size. Smaller ones are
// joined with nearly coplanar neighbours of the same mesh up to that size. Both are cut or joined
// into elements by the element size. Spheres and disks are cut into round pieces.
//
// The numbers of sheets and elements are bounded. Where they would be exceeded, the sizes and the
// joining angle grow. At last, triangles are joined that are merely close and face roughly the same
// way. Any scene therefore takes bounded time and memory.
//
// A triangle with the same corners as another, in any mesh, is treated as that one, unless one of
// them emits. Not handled: surfaces that coincide without sharing triangles; both reflect.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bsdf/tables.h"
#include "radiosity/patch.h"
#include "radiosity/subdivide.h"
#include "scene/scene.h"
#include "trace/tracer.h"

namespace troffer {

struct MeshingOptions {
  float element_size = 0;    // metres, longest edge; 0: about 4 000 elements would cover the scene
  float patch_size = 0;      // metres; 0: four element sizes
  float join_angle_deg = 5;  // between normals of joined triangles
  uint32_t max_elements = 24000;  // each has up to two sample points
  uint32_t max_sheets = 3000;     // each has up to two patches
  bool prune_hidden_sides = true;
};

struct RadiosityMesh {
  float element_size = 0, patch_size = 0, join_angle_deg = 0;  // values finally used
  float coarsened = 1;    // element length over the requested length, to keep the bounds
  uint32_t left_out = 0;  // triangles, spheres and disks beyond farthest_surface
  uint32_t element_count = 0;

  std::vector<ElementPoint> points;  // by patch
  std::vector<Patch> patches;
  std::vector<Sheet> sheets;
  std::vector<std::array<uint32_t, 2>> pieces;  // first corner in piece_corners, number of corners
  std::vector<Vec3> piece_corners;
  std::vector<std::array<uint32_t, 2>> element_points;  // front, back; no_point: unreachable

  BaseGeometry geometry;          // base triangles and all vertices
  std::vector<uint32_t> same_as;  // per base triangle: itself, or its duplicate
  std::vector<int32_t> roots;     // per base triangle: node, ~fragment, or no_root
  std::vector<SplitNode> nodes;
  std::vector<Fragment> fragments;
  std::vector<uint32_t> vertex_first, vertex_fragments;  // fragments around each vertex

  static constexpr int32_t no_root = INT32_MIN;
  size_t memory_bytes() const;
};

// Builds the mesh. `tracer` and `tables` are those of the scene. Results do not depend on
// `threads`.
RadiosityMesh mesh_for_radiosity(const Scene& scene, const Tracer& tracer, const BsdfTables& tables,
                                 const MeshingOptions& options, int threads);

// Returns the fragment of a mesh triangle (or sphere, disk) at weights u, v of corners 1 and 2, and
// sets the weights of the fragment's corners. `geometry` and `primitive` are as in Hit; round
// surfaces are looked up by `position`. is_back says that the back was hit; it is inverted if the
// fragment's triangle is a copy that faces the other way. Returns no_fragment for triangles without
// area.
uint32_t fragment_at(const Scene& scene, const RadiosityMesh& mesh, uint32_t geometry,
                     uint32_t primitive, float u, float v, const Vec3& position, bool& is_back,
                     Vec3& weights);

// Returns the unit normal of a fragment, on the front of its triangle.
Vec3 fragment_normal(const RadiosityMesh& mesh, uint32_t fragment);

}  // namespace troffer
