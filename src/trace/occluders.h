// All occluders of a scene as convex facets in a bounding volume hierarchy, which is queried with
// convex regions (shafts). Certified visibility gathers its facet lists here.
// Coplanar triangles of a mesh are merged into larger triangles and convex quadrilaterals where
// that is exact to rounding (base/merge_polygons.h). Each triangle with area belongs to exactly one
// facet. Spheres and disks are reported as such, and triangles with an alpha mask separately,
// because only rays can decide what they hide. Instances share facets and hierarchy of their mesh.
// Their facets have numbers after all others, and their corners are computed on demand.
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

// Immutable and thread safe after construction.
class Occluders {
 public:
  // Builds the hierarchy on the calling thread. Does not keep a reference to the scene. The result,
  // including the order of gathered lists, depends on the scene alone. Throws EnvironmentError if
  // memory or facet numbers run out.
  explicit Occluders(const Scene& scene) : Occluders(scene, nullptr) {}
  // Does the same with panes, which hide nothing; glass: null if there are none.
  Occluders(const Scene& scene, const PaneGlass* glass);

  // Returns the number of facets without those of instances, whose numbers follow.
  size_t facet_count() const { return component_.size(); }
  Quad facet(uint32_t id) const {
    if (id >= component_.size()) return instance_facet(id);
    if (!quads_.empty()) return quads_[id];
    const Corners& c = corners_[id];
    return {vertices_[c[0]], vertices_[c[1]], vertices_[c[2]], vertices_[c[3]]};
  }
  // Returns the facet of a hit (trace/ray.h), or no_facet if there is none.
  uint32_t facet_of(uint32_t geometry, uint32_t primitive) const;

  // A connected piece of surface. It is closed if each edge belongs to exactly two triangles that
  // run along it in opposite directions. A segment with both ends outside `bounds` then crosses as
  // many facets from the front as from the back. Facets of one orientation suffice to decide if it
  // is hidden.
  struct Component {
    Box bounds;
    bool is_closed = false;
  };
  Component component_of(uint32_t facet) const;

  static constexpr uint64_t no_key = ~0ull;
  static uint64_t key(uint32_t geometry, uint32_t primitive) {
    return uint64_t(geometry) << 32 | primitive;
  }

  // Appends the ids of all facets that may have a point inside all planes to `facets`, and such
  // spheres and disks to `rounds`. Counts triangles with an alpha mask in `others`; the first
  // most_masked of them go to `masked`. Stops at more than `most` of a kind and then clears
  // is_complete. A facet is left out only if all of it lies outside one plane.
  static constexpr size_t most_masked = 256;
  struct Found {
    std::vector<uint32_t> facets;
    std::vector<RoundBody> rounds;
    std::vector<Quad> masked;
    uint32_t others = 0;
    // Sphere or disk that is ignored: key() of a hit on it; none by default.
    uint64_t own = no_key;
    bool is_complete = true;
    uint64_t visited_nodes = 0;
  };
  void gather(std::span<const Plane> planes, size_t most, Found& found) const;

  // True if some point of the facet may lie inside all planes, as in gather.
  bool may_meet(uint32_t facet, std::span<const Plane> planes) const;

 private:
  // Bounds of eight children in separate arrays. A child is a node, a leaf or nothing.
  struct alignas(64) Node {
    float lower[3][8], upper[3][8];
    uint32_t child[8];  // node index; for a leaf its first entry of leaf_items_
    uint8_t count[8];   // items of a leaf; 0: a node; 255: no child
  };
  struct PlaneSet;
  struct Other;
  struct Stand;
  // Builds the hierarchy of one mesh in its own space.
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

  // Facets in one of two forms: quads_ holds vertices; corners_ holds vertex indices and serves
  // large scenes, with a third of the memory and slower access.
  std::vector<Quad> quads_;
  using Corners = std::array<uint32_t, 4>;  // a triangle repeats its last
  std::vector<Corners> corners_;
  std::vector<Vec3> vertices_;  // vertices of all meshes
  bool is_large_ = false;
  std::vector<uint32_t> component_;  // per facet
  std::vector<Component> components_;
  // An occluder that is not a facet: its bounds, and a covering quadrilateral if it is flat.
  struct Other {
    Box bounds;
    Quad cover;
    bool is_flat;
    RoundBody round;  // radius 0: neither a sphere nor a disk
    uint64_t key;     // key of a hit on it
  };
  std::vector<Other> others_;
  std::vector<std::vector<uint32_t>> facet_of_;  // per mesh, per triangle
  std::vector<Node> nodes_;
  // Item numbers: facets, then others, then instances.
  std::vector<uint32_t> leaf_items_;
  uint32_t root_leaf_count_ = 0;                     // without nodes, everything is one leaf
  static constexpr uint32_t no_space = 0xffffffffu;  // instances of panes
  // An instance of a mesh.
  struct Stand {
    Affine world_from_space;
    Vec3d reach;  // upper bound per axis of coordinates during the transform
    Box bounds;   // in world space
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
