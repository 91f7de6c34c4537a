// Everything in a scene that can hide a light, as flat convex facets in a bounding-volume hierarchy
// that is asked for what meets a convex region (a shaft).
//
// Triangles of a mesh that lie in one plane are merged to larger triangles and convex
// quadrilaterals where that is exact to rounding (base/merge_polygons.h), so that a tessellated
// wall is one facet. Each triangle with area belongs to one facet, whole. Spheres and disks are
// reported as they are, triangles with an alpha mask apart from the others: only rays can tell what
// these hide. Instances share the facets and the hierarchy of their mesh: theirs have numbers of
// their own, behind all others, and their corners are computed when they are asked for.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "base/box.h"
#include "base/quad.h"
#include "base/round_body.h"
#include "base/transform.h"
#include "scene/scene.h"
#include "trace/panes.h"

namespace troffer {

constexpr uint32_t no_facet = 0xffffffffu;

class Occluders {
 public:
  // Throws EnvironmentError if memory or numbers of facets run out. The scene is not kept. Works on
  // the calling thread alone; what is built, the order of gathered lists too, depends on the scene
  // alone.
  explicit Occluders(const Scene& scene) : Occluders(scene, nullptr) {}
  // … and what panes are, which hide nothing: none if null.
  Occluders(const Scene& scene, const PaneGlass* glass);

  // Those of instances, whose numbers follow, do not count.
  size_t facet_count() const { return component_.size(); }
  Quad facet(uint32_t id) const {
    if (id >= component_.size()) return instance_facet(id);
    if (!quads_.empty()) return quads_[id];
    const Corners& c = corners_[id];
    return {vertices_[c[0]], vertices_[c[1]], vertices_[c[2]], vertices_[c[3]]};
  }
  // The facet that a hit (trace/ray.h) lies on; no_facet for what is none.
  uint32_t facet_of(uint32_t geometry, uint32_t primitive) const;

  // Facets of one connected piece of surface. Where it is closed (each edge of a triangle belongs
  // to exactly two triangles that run along it in opposite directions), a segment with both ends
  // outside `bounds` crosses as many facets from the front as from the back: facets of one side
  // suffice to tell whether it is hidden.
  struct Component {
    Box bounds;
    bool is_closed = false;
  };
  Component component_of(uint32_t facet) const;

  static constexpr uint64_t no_key = ~0ull;
  static uint64_t key(uint32_t geometry, uint32_t primitive) {
    return uint64_t(geometry) << 32 | primitive;
  }

  // Appends to `facets` the ids of all facets of which a point may lie inside all planes, and to
  // `rounds` spheres and disks, until more than `most` have been found; counts triangles with an
  // alpha mask in `others`, of which the first most_masked are in `masked`. Where it stops early
  // the list is incomplete. A facet is left out only if one plane has all of it outside.
  static constexpr size_t most_masked = 256;
  struct Found {
    std::vector<uint32_t> facets;
    std::vector<RoundBody> rounds;
    std::vector<Quad> masked;
    uint32_t others = 0;
    // A sphere or disk that does not count: key() of what a hit on it says; none by default.
    uint64_t own = no_key;
    bool is_complete = true;
    uint64_t visited_nodes = 0;
  };
  void gather(std::span<const Plane> planes, size_t most, Found& found) const;

  // Whether some point of the facet may lie inside all planes, in the sense of gather.
  bool may_meet(uint32_t facet, std::span<const Plane> planes) const;

 private:
  // Bounds of eight children side by side; a child is a node, a leaf, or nothing.
  struct alignas(64) Node {
    float lower[3][8], upper[3][8];
    uint32_t child[8];  // node index; leaf: first entry of leaf_items_
    uint8_t count[8];   // leaf: items; 0: a node; 255: nothing
  };
  struct PlaneSet;
  struct Other;
  struct Stand;
  // Of one mesh, in its own space.
  Occluders(const Mesh& mesh, bool is_alpha_masked);
  void join_and_add(const Mesh& mesh, std::vector<uint32_t>& facet_of);
  void add_masked(const Mesh& mesh);
  void add_flat(const Quad& q, const RoundBody& round, uint64_t key);
  void add_round(const Scene& scene, const PaneGlass* glass);
  void add_instances(const Scene& scene, const PaneGlass* glass);
  void build_tree();
  void reserve(std::span<const Mesh> meshes);
  Quad instance_facet(uint32_t facet) const;
  const Stand& stand_of(uint32_t facet) const;
  template <class Look>
  bool walk(const PlaneSet& set, uint64_t& visited, const Look& look) const;
  static bool look_at_other(const Other& other, const PlaneSet& set, size_t most, Found& found);
  bool look_at_stand(const Stand& stand, const PlaneSet& set, size_t most, Found& found) const;

  // Facets, in one way or the other: with their vertices, or, of large scenes, by their numbers,
  // which take a third of the memory and more time to look at.
  std::vector<Quad> quads_;
  using Corners = std::array<uint32_t, 4>;  // a triangle repeats its last
  std::vector<Corners> corners_;
  std::vector<Vec3> vertices_;  // of all meshes
  bool is_large_ = false;
  std::vector<uint32_t> component_;  // per facet
  std::vector<Component> components_;
  // What is no facet: its bounds, and where it is flat a facet that covers it.
  struct Other {
    Box bounds;
    Quad cover;
    bool is_flat;
    RoundBody round;  // of no radius: it is neither sphere nor disk
    uint64_t key;     // of a hit on it
  };
  std::vector<Other> others_;
  std::vector<std::vector<uint32_t>> facet_of_;  // per mesh, per triangle
  std::vector<Node> nodes_;
  // facet, or facet_count() + other, or that + number of others + stand
  std::vector<uint32_t> leaf_items_;
  uint32_t root_leaf_count_ = 0;                     // no nodes: everything is one leaf
  static constexpr uint32_t no_space = 0xffffffffu;  // of panes
  // An instance.
  struct Stand {
    Affine world_from_space;
    Vec3d reach;  // per axis: no coordinate on the way to the world is larger
    Box bounds;   // in the world
    uint32_t space = no_space, first_facet = 0;
    bool is_mirrored = false;

    Quad placed(const Quad& own) const;
  };
  struct Instanced {
    std::vector<std::unique_ptr<const Occluders>> spaces;  // per instanced mesh
    std::vector<Stand> stands;                             // per instance
  } instanced_;
};

}  // namespace troffer
