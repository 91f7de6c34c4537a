// From a scene to what radiosity is computed on: sheets, elements, patches, sample points.
//
// Triangles larger than the patch size are cut into sheets of at most that size. Smaller ones are
// joined with neighbours of the same mesh, as far as they are nearly coplanar, until they reach it.
// Both are cut (or joined) further into elements, by the element size. Spheres and disks are cut
// into round pieces. Numbers of sheets and elements are bounded: where they would be exceeded,
// sizes and the angle of joining grow, and in the end triangles are joined that merely are close
// and face about the same way; so any scene costs bounded time and memory.
//
// Triangles that are copies of another, in whatever mesh, are that other one (unless one of them
// emits). Not dealt with: surfaces that coincide without sharing their triangles; both reflect.
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
  float element_size = 0;         // metres, longest edge; 0: chosen such that about 4 000 elements
                                  // would cover the scene's surfaces
  float patch_size = 0;           // metres; 0: four element sizes
  float join_angle_deg = 5;       // between the normals of triangles that are joined
  uint32_t max_elements = 24000;  // each has up to two sample points
  uint32_t max_sheets = 3000;     // each has up to two patches
  bool prune_hidden_sides = true;
};

struct RadiosityMesh {
  float element_size = 0, patch_size = 0, join_angle_deg = 0;  // what was used in the end
  float coarsened = 1;    // elements are so many times as long as wanted, to keep the bounds
  uint32_t left_out = 0;  // triangles, spheres and disks beyond farthest_surface
  uint32_t element_count = 0;

  std::vector<ElementPoint> points;  // by patch
  std::vector<Patch> patches;
  std::vector<Sheet> sheets;
  std::vector<std::array<uint32_t, 2>> pieces;  // first corner in piece_corners, and how many
  std::vector<Vec3> piece_corners;
  std::vector<std::array<uint32_t, 2>> element_points;  // front, back; no_point: nothing gets there

  BaseGeometry geometry;          // base triangles and all vertices
  std::vector<uint32_t> same_as;  // per base triangle: itself, or the one that it duplicates
  std::vector<int32_t> roots;     // per base triangle: node, ~fragment, or no_root
  std::vector<SplitNode> nodes;
  std::vector<Fragment> fragments;
  std::vector<uint32_t> vertex_first, vertex_fragments;  // fragments around each vertex

  static constexpr int32_t no_root = INT32_MIN;
  size_t memory_bytes() const;
};

// `tracer` and `tables` are the scene's. Results do not depend on `threads`.
RadiosityMesh mesh_for_radiosity(const Scene& scene, const Tracer& tracer, const BsdfTables& tables,
                                 const MeshingOptions& options, int threads);

// The fragment of a mesh's triangle (or sphere, disk) at weights u, v of corners 1 and 2, and the
// weights of the fragment's corners. `geometry` and `primitive` as in Hit; round surfaces are
// looked up by `position` instead. is_back: whether the back of what was hit is asked for; turned
// round where the fragment stands for a copy of its triangle that faces the other way. no_fragment
// on triangles without area.
uint32_t fragment_at(const Scene& scene, const RadiosityMesh& mesh, uint32_t geometry,
                     uint32_t primitive, float u, float v, const Vec3& position, bool& is_back,
                     Vec3& weights);

// Unit normal of a fragment, on the front of its triangle.
Vec3 fragment_normal(const RadiosityMesh& mesh, uint32_t fragment);

}  // namespace troffer
