// Queries of Occluders: descends the tree, and the trees of instanced meshes in their own space.
#include <algorithm>
#include <array>
#include <cmath>

#include "trace/occluders.h"

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define TROFFER_CULL_DISPATCH 1
#endif
#define TROFFER_CULL_WIDTH 4
#define TROFFER_CULL_NAMESPACE cull_plain
#include "trace/occluders_kernels.h"
#ifdef TROFFER_CULL_DISPATCH
#pragma GCC push_options
#pragma GCC target("avx2")
#define TROFFER_CULL_WIDTH 8
#define TROFFER_CULL_NAMESPACE cull_avx2
#include "trace/occluders_kernels.h"
#pragma GCC pop_options
#endif

namespace troffer {

namespace {

constexpr size_t most_planes = 32;

struct Kernels {
  decltype(&cull_plain::boxes_outside) boxes;
  decltype(&cull_plain::facet_outside) facet;
};

Kernels best_kernels() {
#ifdef TROFFER_CULL_DISPATCH
  if (__builtin_cpu_supports("avx2")) return {cull_avx2::boxes_outside, cull_avx2::facet_outside};
#endif
  return {cull_plain::boxes_outside, cull_plain::facet_outside};
}
const Kernels kernels = best_kernels();

}  // namespace

// Planes in separate arrays, padded with planes that exclude nothing.
struct Occluders::PlaneSet {
  alignas(64) float x[most_planes];
  alignas(64) float y[most_planes];
  alignas(64) float z[most_planes];
  alignas(64) float distance[most_planes];
  int count = 0, padded = 0;

  explicit PlaneSet(std::span<const Plane> planes) {
    for (const Plane& p : planes.first(std::min(planes.size(), most_planes))) add(p);
    pad();
  }

  // Transforms planes to the space of an instance's mesh: n·(L p + t) <= d becomes (L^T n)·p <= d -
  // n·t. Each plane is moved outwards by the rounding errors in both spaces.
  PlaneSet(const PlaneSet& world, const Stand& stand) {
    constexpr double rounding = 2e-6;
    const std::array<Vec3d, 3>& columns = stand.world_from_space.columns;
    const Vec3d& t = stand.world_from_space.translation;
    for (int i = 0; i < world.count; ++i) {
      const Vec3d n(Vec3{world.x[i], world.y[i], world.z[i]});
      const auto d = double(world.distance[i]);
      const Vec3d own{dot(columns[0], n), dot(columns[1], n), dot(columns[2], n)};
      const Vec3d size = abs(n);
      const double largest = dot(size, stand.reach) + std::abs(d);
      add({Vec3(own), float(d - dot(n, t) + rounding * largest)});
    }
    pad();
  }

  bool has_outside(const Quad& q) const {
    return kernels.facet(&q[0].x, x, y, z, distance, padded);
  }
  // True if a ball around `centre` lies outside one plane.
  bool has_outside(const Vec3& centre, float radius) const {
    for (int p = 0; p < count; ++p)
      if (centre.x * x[p] + centre.y * y[p] + centre.z * z[p] - radius > distance[p]) return true;
    return false;
  }

 private:
  void add(const Plane& p) {
    x[count] = p.normal.x;
    y[count] = p.normal.y;
    z[count] = p.normal.z;
    distance[count++] = p.distance;
  }
  void pad() {
    padded = (count + 7) / 8 * 8;
    for (int i = count; i < padded; ++i) {
      x[i] = y[i] = z[i] = 0;
      distance[i] = std::numeric_limits<float>::infinity();
    }
  }
};

// Returns the facet in world space. In a mirrored instance the corners are reversed, so that the
// front stays the front. A triangle still repeats its last corner.
Quad Occluders::Stand::placed(const Quad& own) const {
  Quad q;
  for (size_t k = 0; k < 4; ++k) q[k] = Vec3(world_from_space.point(Vec3d(own[k])));
  if (!is_mirrored) return q;
  return own[2] == own[3] ? Quad{q[0], q[2], q[1], q[1]} : Quad{q[0], q[3], q[2], q[1]};
}

const Occluders::Stand& Occluders::stand_of(uint32_t facet) const {
  const auto& stands = instanced_.stands;
  const auto after = std::upper_bound(stands.begin(), stands.end(), facet,
                                      [](uint32_t f, const Stand& s) { return f < s.first_facet; });
  return *(after - 1);
}

Quad Occluders::instance_facet(uint32_t facet) const {
  const Stand& stand = stand_of(facet);
  return stand.placed(instanced_.spaces[stand.space]->facet(facet - stand.first_facet));
}

Occluders::Component Occluders::component_of(uint32_t facet) const {
  if (facet < facet_count()) return components_[component_[facet]];
  const Stand& stand = stand_of(facet);
  const Component own = instanced_.spaces[stand.space]->component_of(facet - stand.first_facet);
  // bounds of the transformed box, with room for rounding
  constexpr double rounding = 1e-6;
  const Vec3d middle = stand.world_from_space.point(Vec3d(own.bounds.centre()));
  const Vec3d half = Vec3d(own.bounds.extent()) * 0.5;
  Vec3d reach = stand.reach * rounding;
  for (size_t a = 0; a < 3; ++a) reach += abs(stand.world_from_space.columns[a]) * half[a];
  return {{Vec3(middle - reach), Vec3(middle + reach)}, own.is_closed};
}

// Calls look(item) for the items that may be inside all planes. Returns false as soon as look does.
template <class Look>
bool Occluders::walk(const PlaneSet& set, uint64_t& visited, const Look& look) const {
  const auto look_at_leaf = [&](uint32_t first, uint32_t count) {
    for (uint32_t i = first; i < first + count; ++i)
      if (!look(leaf_items_[i])) return false;
    return true;
  };
  if (nodes_.empty()) return look_at_leaf(0, root_leaf_count_);
  std::array<uint32_t, 64 * 8> stack;  // depth × children: cannot overflow
  size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[stack[--size]];
    ++visited;
    const uint32_t outside = kernels.boxes(&node.lower[0][0], &node.upper[0][0], set.x, set.y,
                                           set.z, set.distance, set.count);
    for (uint32_t i = 0; i < 8; ++i) {
      if ((outside >> i & 1u) != 0 || node.count[i] == 255) continue;
      if (node.count[i] == 0)
        stack[size++] = node.child[i];
      else if (!look_at_leaf(node.child[i], node.count[i]))
        return false;
    }
  }
  return true;
}

// Adds an occluder that is not a facet. Returns false if the list has become too long.
bool Occluders::look_at_other(const Other& o, const PlaneSet& set, size_t most, Found& found) {
  if (o.key == found.own && o.key != no_key) return true;
  if (o.is_flat ? set.has_outside(o.cover)
                : set.has_outside(o.round.centre, o.bounds.upper.x - o.round.centre.x))
    return true;
  if (!(o.round.radius > 0)) {
    ++found.others;
    if (found.masked.size() < most_masked) found.masked.push_back(o.cover);
    return true;
  }
  if (found.rounds.size() >= most) return false;
  found.rounds.push_back(o.round);
  return true;
}

// Adds the occluders of an instance. Candidates from the mesh's space are tested again in world
// space. Either all triangles of a mesh have a mask or none has. Returns false if the list has
// become too long.
bool Occluders::look_at_stand(const Stand& stand, const PlaneSet& set, size_t most,
                              Found& found) const {
  const Occluders& space = *instanced_.spaces[stand.space];
  const PlaneSet own(set, stand);
  if (space.facet_count() == 0) {
    // beyond most_masked, the exact number does not matter
    space.walk(own, found.visited_nodes, [&](uint32_t item) {
      if (found.others > most_masked) return false;
      Other o = space.others_[item];
      o.cover = stand.placed(o.cover);
      return look_at_other(o, set, most, found);
    });
    return true;
  }
  return space.walk(own, found.visited_nodes, [&](uint32_t item) {
    const Quad facet = space.facet(item);
    if (own.has_outside(facet) || set.has_outside(stand.placed(facet))) return true;
    if (found.facets.size() >= most) return false;
    found.facets.push_back(stand.first_facet + item);
    return true;
  });
}

void Occluders::gather(std::span<const Plane> planes, size_t most, Found& found) const {
  const PlaneSet set(planes);
  const auto facets = uint32_t(facet_count()), others = uint32_t(others_.size());
  const bool is_through = walk(set, found.visited_nodes, [&](uint32_t item) {
    if (item >= facets)
      return item - facets < others
                 ? look_at_other(others_[item - facets], set, most, found)
                 : look_at_stand(instanced_.stands[item - facets - others], set, most, found);
    if (set.has_outside(facet(item))) return true;
    if (found.facets.size() >= most) return false;
    found.facets.push_back(item);
    return true;
  });
  found.is_complete = is_through && found.is_complete;
}

bool Occluders::may_meet(uint32_t facet, std::span<const Plane> planes) const {
  return !PlaneSet(planes).has_outside(this->facet(facet));
}

}  // namespace troffer
