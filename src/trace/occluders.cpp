#include "trace/occluders.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/parallel.h"

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
constexpr uint32_t leaf_size = 4;

// Planes side by side, padded with ones that nothing is outside of.
struct PlaneSet {
  alignas(64) float x[most_planes];
  alignas(64) float y[most_planes];
  alignas(64) float z[most_planes];
  alignas(64) float distance[most_planes];
  int count = 0, padded = 0;

  explicit PlaneSet(std::span<const Plane> planes) {
    for (const Plane& p : planes.first(std::min(planes.size(), most_planes))) {
      x[count] = p.normal.x;
      y[count] = p.normal.y;
      z[count] = p.normal.z;
      distance[count++] = p.distance;
    }
    padded = (count + 7) / 8 * 8;
    for (int i = count; i < padded; ++i) {
      x[i] = y[i] = z[i] = 0;
      distance[i] = std::numeric_limits<float>::infinity();
    }
  }
};

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

bool is_outside(const Quad& q, const PlaneSet& planes) {
  return kernels.facet(&q[0].x, planes.x, planes.y, planes.z, planes.distance, planes.padded);
}

// Of a sphere, up to `radius` from the centre.
bool is_outside(const Vec3& centre, float radius, const PlaneSet& planes) {
  for (int p = 0; p < planes.count; ++p)
    if (centre.x * planes.x[p] + centre.y * planes.y[p] + centre.z * planes.z[p] - radius >
        planes.distance[p])
      return true;
  return false;
}

// The tree as rtcBuildBVH makes it; children of a node lie where its allocator put them. Leaves,
// which are most of it, take as little as they can.
struct RawNode {
  uint32_t child_count = 0;  // 0: a leaf
  uint32_t item_count = 0;
};
struct RawInner : RawNode {
  RawNode* child[8] = {};
  RTCBounds bounds[8] = {};
};
struct RawLeaf : RawNode {
  uint32_t items[leaf_size] = {};
};

const RawInner& inner(const RawNode& n) {
  return static_cast<const RawInner&>(n);
}
const RawLeaf& leaf(const RawNode& n) {
  return static_cast<const RawLeaf&>(n);
}

template <class T>
T* new_node(RTCThreadLocalAllocator allocator) {
  return new (rtcThreadLocalAlloc(allocator, sizeof(T), alignof(T))) T;
}

void* create_node(RTCThreadLocalAllocator allocator, unsigned count, void*) {
  auto* node = new_node<RawInner>(allocator);
  node->child_count = count;
  return static_cast<RawNode*>(node);
}

void set_children(void* node, void** children, unsigned count, void*) {
  auto* of = static_cast<RawInner*>(static_cast<RawNode*>(node));
  for (unsigned i = 0; i < count; ++i) of->child[i] = static_cast<RawNode*>(children[i]);
}

void set_bounds(void* node, const RTCBounds** bounds, unsigned count, void*) {
  auto* of = static_cast<RawInner*>(static_cast<RawNode*>(node));
  for (unsigned i = 0; i < count; ++i) of->bounds[i] = *bounds[i];
}

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives,
                  size_t count, void*) {
  auto* node = new_node<RawLeaf>(allocator);
  node->item_count = uint32_t(count);
  for (size_t i = 0; i < count; ++i) node->items[i] = primitives[i].primID;
  std::sort(node->items, node->items + count);
  return static_cast<RawNode*>(node);
}

struct Device {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCBVH bvh = nullptr;
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  ~Device() {
    if (bvh != nullptr) rtcReleaseBVH(bvh);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

RTCBuildPrimitive build_primitive(const Box& b, uint32_t id) {
  return {b.lower.x, b.lower.y, b.lower.z, 0, b.upper.x, b.upper.y, b.upper.z, id};
}

Box bounds_of(const Quad& q) {
  Box b;
  for (const Vec3& v : q) b.grow(v);
  return b;
}

// Embree's tree over the boxes; it lives as long as `embree`.
const RawNode& build_raw_tree(Device& embree, std::vector<RTCBuildPrimitive> boxes) {
  if (embree.device == nullptr) throw EnvironmentError("cannot start Embree");
  embree.bvh = rtcNewBVH(embree.device);
  RTCBuildArguments args = rtcDefaultBuildArguments();
  args.buildQuality = RTC_BUILD_QUALITY_MEDIUM;
  args.maxBranchingFactor = 8;
  args.maxDepth = 64;
  args.minLeafSize = 1;
  args.maxLeafSize = leaf_size;
  // Many facets: full leaves, in a quarter of the nodes; shafts that cross curved surfaces are
  // asked for up to a third faster. Few large ones are told apart better one by one.
  constexpr size_t many = 100'000;
  args.sahBlockSize = boxes.size() > many ? leaf_size : 1;
  args.traversalCost = 1;
  args.intersectionCost = 1;
  args.bvh = embree.bvh;
  args.primitives = boxes.data();
  args.primitiveCount = boxes.size();
  args.primitiveArrayCapacity = boxes.size();
  args.createNode = create_node;
  args.setNodeChildren = set_children;
  args.setNodeBounds = set_bounds;
  args.createLeaf = create_leaf;
  // Embree would take all cores. Lists are cut short in the order of the tree: on one thread
  // nothing of it can depend on how many there are.
  const RawNode* root = nullptr;
  run_on_one_thread([&] { root = static_cast<const RawNode*>(rtcBuildBVH(&args)); });
  if (root == nullptr || rtcGetDeviceError(embree.device) != RTC_ERROR_NONE)
    throw EnvironmentError("cannot build the hierarchy of occluders: out of memory");
  return *root;
}

// Child i of a node, but for where it is; a place without a child has nothing in it.
template <class Node>
void copy_child(const RawInner& raw, uint32_t i, Node& node) {
  const bool is_used = i < raw.child_count;
  const RTCBounds& b = raw.bounds[i];
  const float lower[3] = {b.lower_x, b.lower_y, b.lower_z};
  const float upper[3] = {b.upper_x, b.upper_y, b.upper_z};
  for (int a = 0; a < 3; ++a) {
    node.lower[a][i] = is_used ? lower[a] : 0;
    node.upper[a][i] = is_used ? upper[a] : 0;
  }
  node.child[i] = 0;
  node.count[i] = is_used ? uint8_t(raw.child[i]->item_count) : 255;
}

// The first of the leaf's items in the list.
uint32_t copy_leaf(const RawLeaf& raw, std::vector<uint32_t>& items) {
  const auto first = uint32_t(items.size());
  items.insert(items.end(), raw.items, raw.items + raw.item_count);
  return first;
}

size_t count_inner(const RawNode& node) {
  if (node.child_count == 0) return 0;
  size_t n = 1;
  for (uint32_t i = 0; i < node.child_count; ++i) n += count_inner(*inner(node).child[i]);
  return n;
}

// Copied depth first: the layout then does not depend on who allocated what.
template <class Node>
void copy_tree(const RawNode& root, std::vector<Node>& nodes, std::vector<uint32_t>& leaf_items) {
  nodes.reserve(count_inner(root));
  struct Open {
    const RawInner* raw;
    uint32_t parent, slot;
  };
  std::vector<Open> open{{&inner(root), 0, 8}};
  while (!open.empty()) {
    const Open o = open.back();
    open.pop_back();
    const auto index = uint32_t(nodes.size());
    if (o.slot < 8) nodes[o.parent].child[o.slot] = index;
    Node& node = nodes.emplace_back();
    for (uint32_t i = 0; i < 8; ++i) {
      copy_child(*o.raw, i, node);
      if (i >= o.raw->child_count) continue;
      const RawNode* child = o.raw->child[i];
      if (child->child_count == 0)
        node.child[i] = copy_leaf(leaf(*child), leaf_items);
      else
        open.push_back({&inner(*child), index, i});
    }
  }
}

}  // namespace

void Occluders::build_tree() {
  std::vector<RTCBuildPrimitive> boxes;
  boxes.reserve(facet_count() + others_.size());
  for (uint32_t i = 0; i < facet_count(); ++i)
    boxes.push_back(build_primitive(bounds_of(facet(i)), i));
  for (const Other& o : others_) boxes.push_back(build_primitive(o.bounds, uint32_t(boxes.size())));
  if (boxes.size() <= leaf_size) {
    for (uint32_t i = 0; i < boxes.size(); ++i) leaf_items_.push_back(i);
    root_leaf_count_ = uint32_t(boxes.size());
    return;
  }
  Device embree;
  const size_t items = boxes.size();
  const RawNode& root = build_raw_tree(embree, std::move(boxes));
  leaf_items_.reserve(items);
  if (root.child_count == 0) {
    copy_leaf(leaf(root), leaf_items_);
    root_leaf_count_ = root.item_count;
    return;
  }
  copy_tree(root, nodes_, leaf_items_);
}

void Occluders::gather(std::span<const Plane> planes, size_t most, Found& found) const {
  const PlaneSet set(planes);
  const auto facets = uint32_t(facet_count());
  // False when the list has become too long.
  const auto look_at_leaf = [&](uint32_t first, uint32_t count) {
    for (uint32_t i = first; i < first + count; ++i) {
      const uint32_t item = leaf_items_[i];
      if (item >= facets) {
        const Other& o = others_[item - facets];
        if (o.key == found.own && o.key != no_key) continue;
        if (o.is_flat ? is_outside(o.cover, set)
                      : is_outside(o.round.centre, o.bounds.upper.x - o.round.centre.x, set))
          continue;
        if (!(o.round.radius > 0)) {
          ++found.others;
          if (found.masked.size() < most_masked) found.masked.push_back(o.cover);
          continue;
        }
        if (found.rounds.size() >= most) return false;
        found.rounds.push_back(o.round);
      } else if (!is_outside(facet(item), set)) {
        if (found.facets.size() >= most) return false;
        found.facets.push_back(item);
      }
    }
    return true;
  };
  if (nodes_.empty()) {
    found.is_complete = look_at_leaf(0, root_leaf_count_) && found.is_complete;
    return;
  }
  std::array<uint32_t, 64 * 8> stack;  // depth × children: it cannot overflow
  size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[stack[--size]];
    ++found.visited_nodes;
    const uint32_t outside = kernels.boxes(&node.lower[0][0], &node.upper[0][0], set.x, set.y,
                                           set.z, set.distance, set.count);
    for (uint32_t i = 0; i < 8; ++i) {
      if ((outside >> i & 1u) != 0 || node.count[i] == 255) continue;
      if (node.count[i] == 0) {
        stack[size++] = node.child[i];
      } else if (!look_at_leaf(node.child[i], node.count[i])) {
        found.is_complete = false;
        return;
      }
    }
  }
}

bool Occluders::may_meet(uint32_t facet, std::span<const Plane> planes) const {
  return !is_outside(this->facet(facet), PlaneSet(planes));
}

uint32_t Occluders::facet_of(uint32_t geometry, uint32_t primitive) const {
  if (geometry >= facet_of_.size() || primitive >= facet_of_[geometry].size()) return no_facet;
  return facet_of_[geometry][primitive];
}

}  // namespace troffer
