#include "trace/occluders.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/parallel.h"

namespace troffer {

namespace {

constexpr uint32_t leaf_size = 4;

// Nodes of the tree as rtcBuildBVH makes it. Leaves are the majority, so they take little memory.
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

// Builds Embree's tree over the boxes. It lives as long as `embree`.
const RawNode& build_raw_tree(Device& embree, std::vector<RTCBuildPrimitive> boxes) {
  if (embree.device == nullptr) throw EnvironmentError("cannot start Embree");
  embree.bvh = rtcNewBVH(embree.device);
  RTCBuildArguments args = rtcDefaultBuildArguments();
  args.buildQuality = RTC_BUILD_QUALITY_MEDIUM;
  args.maxBranchingFactor = 8;
  args.maxDepth = 64;
  args.minLeafSize = 1;
  args.maxLeafSize = leaf_size;
  // With many facets, full leaves save nodes and time (docs/log/trace.md). A few large facets are
  // separated better one by one.
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
  // One thread builds the tree: Embree would use all cores, and lists that are cut short depend on
  // the tree's order.
  const RawNode* root = nullptr;
  run_on_one_thread([&] { root = static_cast<const RawNode*>(rtcBuildBVH(&args)); });
  if (root == nullptr || rtcGetDeviceError(embree.device) != RTC_ERROR_NONE)
    throw EnvironmentError("cannot build the hierarchy of occluders: out of memory");
  return *root;
}

// Copies bounds and count of child i. A slot without a child is marked as empty.
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

// Appends the leaf's items and returns the index of the first.
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

// Copies the tree depth first, so that the layout does not depend on Embree's allocations.
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
  boxes.reserve(facet_count() + others_.size() + instanced_.stands.size());
  for (uint32_t i = 0; i < facet_count(); ++i)
    boxes.push_back(build_primitive(bounds_of(facet(i)), i));
  for (const Other& o : others_) boxes.push_back(build_primitive(o.bounds, uint32_t(boxes.size())));
  for (uint32_t i = 0; i < instanced_.stands.size(); ++i)
    if (const Stand& stand = instanced_.stands[i]; stand.space != no_space)
      boxes.push_back(build_primitive(stand.bounds, uint32_t(facet_count() + others_.size()) + i));
  if (boxes.size() <= leaf_size) {
    for (const RTCBuildPrimitive& box : boxes) leaf_items_.push_back(box.primID);
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

uint32_t Occluders::facet_of(uint32_t geometry, uint32_t primitive) const {
  if (geometry < facet_of_.size())
    return primitive < facet_of_[geometry].size() ? facet_of_[geometry][primitive] : no_facet;
  const size_t first = facet_of_.size() + 2;  // after spheres and disks
  if (geometry < first || geometry - first >= instanced_.stands.size()) return no_facet;
  const Stand& stand = instanced_.stands[geometry - first];
  if (stand.space == no_space) return no_facet;
  const uint32_t own = instanced_.spaces[stand.space]->facet_of(0, primitive);
  return own == no_facet ? no_facet : stand.first_facet + own;
}

}  // namespace troffer
