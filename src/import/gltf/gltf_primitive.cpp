#include "import/gltf/gltf_primitive.h"

#include <string>

#include "import/limits.h"

namespace troffer {

namespace {

constexpr uint64_t mode_triangles = 4, mode_strip = 5, mode_fan = 6;

// Number of triangle corners, before strips and fans are unrolled: indices, or vertices if there
// are no indices.
uint64_t corner_count(const GltfPrimitive& p) {
  return p.indices ? p.indices->count : p.positions.count;
}

AccessorView index_accessor(const JsonNode& reference, GltfBuffers& buffers,
                            uint64_t vertex_count) {
  const AccessorView& view = buffers.accessor(reference);
  const bool is_integer = view.component_type == gltf_unsigned_byte ||
                          view.component_type == gltf_unsigned_short ||
                          view.component_type == gltf_unsigned_int;
  if (view.components != 1 || !is_integer || view.is_normalized)
    reference.fail("its accessor should be of unsigned integer scalars");
  const uint32_t largest =
      buffers.largest_index(reference, reference.as_index(~uint32_t(0), "accessors"));
  if (view.count > 0 && largest >= vertex_count)
    reference.fail("its accessor has index " + std::to_string(largest) + ", but there are only " +
                   std::to_string(vertex_count) + " vertices");
  return view;
}

// Attributes of one primitive, from accessors or from compressed data.
class Attributes {
 public:
  Attributes(const JsonNode& primitive, const JsonNode& list, const GltfBuffers& buffers)
      : list_(list), buffers_(buffers) {
    if (const auto draco = primitive.extension("KHR_draco_mesh_compression")) decode(*draco);
  }

  const std::shared_ptr<DracoMesh>& decoded() const { return decoded_; }

  // Returns the attribute if it exists. It must have `components` components, or `most_components`
  // if that is given. POSITION must be asked for first: it sets the vertex count.
  std::optional<AccessorView> find(const std::string& name, uint32_t components,
                                   uint32_t most_components = 0) {
    const auto node = reference(name);
    if (!node) return std::nullopt;
    const AccessorView view = decoded_ ? decoded_view(*node, name) : buffers_.accessor(*node);
    if (view.components != components && view.components != most_components)
      node->fail("its accessor should be of type VEC" + std::to_string(components));
    if (view.component_type == gltf_unsigned_int)
      node->fail("its accessor may not be of 32-bit integers");
    if (name == "POSITION") vertex_count_ = view.count;
    if (view.count != vertex_count_)
      node->fail("its accessor has " + std::to_string(view.count) + " elements, but POSITION " +
                 std::to_string(vertex_count_));
    return view;
  }

 private:
  std::optional<JsonNode> reference(const std::string& name) const {
    return decoded_ && ids_.count(name) == 0 ? std::nullopt : list_.find(name);
  }

  void decode(const JsonNode& extension) {
    const JsonNode attributes = extension.member("attributes");
    std::vector<uint32_t> ids;
    for (const std::string& name : attributes.keys()) {
      ids.push_back(uint32_t(attributes.member(name).as_integer(0xffffffffu)));
      ids_[name] = ids.back();
    }
    const std::span<const uint8_t> bytes = buffers_.buffer_view(extension.member("bufferView"));
    DracoMesh mesh = decode_draco(bytes, ids, max_scene_triangles);
    if (!mesh.problem.empty()) extension.fail(mesh.problem);
    decoded_ = std::make_shared<DracoMesh>(std::move(mesh));
  }

  AccessorView decoded_view(const JsonNode& node, const std::string& name) {
    DracoAttribute* found = nullptr;
    for (DracoAttribute& a : decoded_->attributes)
      if (a.id == ids_.at(name)) found = &a;
    if (found == nullptr)
      node.fail("the compressed data has no attribute " + std::to_string(ids_.at(name)));
    const bool is_normalized = buffers_.is_normalized(node);
    if (is_normalized && found->largest > 1) {
      for (float& v : found->values) v /= found->largest;
      found->largest = 1;
    }
    AccessorView view;
    view.data = reinterpret_cast<const uint8_t*>(found->values.data());
    view.count = decoded_->vertex_count;
    view.components = found->components;
    view.stride = sizeof(float) * view.components;
    view.component_type = gltf_float;
    return view;
  }

  const JsonNode& list_;
  const GltfBuffers& buffers_;
  std::shared_ptr<DracoMesh> decoded_;   // null: not compressed
  std::map<std::string, uint32_t> ids_;  // attribute ids in `decoded_`
  uint64_t vertex_count_ = 0;
};

void read_joints(Attributes& attributes, GltfPrimitive& p) {
  for (int set = 0; set < 4; ++set) {
    const std::string n = std::to_string(set);
    const auto joints = attributes.find("JOINTS_" + n, 4);
    const auto weights = attributes.find("WEIGHTS_" + n, 4);
    if (!joints || !weights) return;
    p.joints.push_back({*joints, *weights});
  }
}

void read_targets(const JsonNode& primitive, const GltfBuffers& buffers, GltfPrimitive& p) {
  const auto targets = primitive.find("targets");
  for (size_t i = 0; targets && i < targets->size(); ++i) {
    const JsonNode list = targets->element(i);
    const auto find = [&](const char* name) -> std::optional<AccessorView> {
      const auto node = list.find(name);
      if (!node) return std::nullopt;
      const AccessorView& view = buffers.accessor(*node);
      if (view.components != 3 || view.component_type == gltf_unsigned_int)
        node->fail("its accessor should be of type VEC3");
      if (view.count != p.positions.count)
        node->fail("its accessor has " + std::to_string(view.count) + " elements, but POSITION " +
                   std::to_string(p.positions.count));
      return view;
    };
    p.targets.push_back({find("POSITION"), find("NORMAL")});
  }
}

void read_indices(const JsonNode& primitive, GltfBuffers& buffers, GltfPrimitive& p) {
  const auto indices = primitive.find("indices");
  if (p.decoded) {
    AccessorView view;
    view.data = reinterpret_cast<const uint8_t*>(p.decoded->indices.data());
    view.count = p.decoded->indices.size();
    view.components = 1;
    view.stride = sizeof(uint32_t);
    view.component_type = gltf_unsigned_int;
    p.indices = view;
    p.topology = GltfTopology::triangles;  // Draco stores strips and fans as single triangles
  } else if (indices) {
    p.indices = index_accessor(*indices, buffers, p.positions.count);
  }
}

}  // namespace

uint64_t GltfPrimitive::triangle_count() const {
  const uint64_t n = corner_count(*this);
  if (topology == GltfTopology::triangles) return n / 3;
  return n < 3 ? 0 : n - 2;
}

std::array<uint32_t, 3> GltfPrimitive::triangle(uint64_t i) const {
  std::array<uint64_t, 3> corners{3 * i, 3 * i + 1, 3 * i + 2};
  if (topology == GltfTopology::strip) corners = {i, i + 1 + i % 2, i + 2 - i % 2};
  if (topology == GltfTopology::fan) corners = {i + 1, i + 2, 0};
  std::array<uint32_t, 3> vertices;
  for (size_t k = 0; k < 3; ++k)
    vertices[k] = indices ? indices->read_index(corners[k]) : uint32_t(corners[k]);
  return vertices;
}

std::optional<GltfPrimitive> read_gltf_primitive(const JsonNode& primitive, GltfBuffers& buffers,
                                                 WarningLog& warnings) {
  const uint64_t mode = primitive.integer_or("mode", mode_triangles, mode_fan);
  if (mode < mode_triangles) {
    warnings.add("points and lines are not shown");
    return std::nullopt;
  }
  const auto list = primitive.find("attributes");
  if (!list || !list->find("POSITION")) {
    warnings.add("mesh primitives without positions are not shown");
    return std::nullopt;
  }
  GltfPrimitive p;
  if (mode == mode_strip) p.topology = GltfTopology::strip;
  if (mode == mode_fan) p.topology = GltfTopology::fan;
  Attributes attributes(primitive, *list, buffers);
  p.decoded = attributes.decoded();
  const auto positions = attributes.find("POSITION", 3);
  if (!positions) primitive.fail("its compressed data has no positions");
  p.positions = *positions;
  p.normals = attributes.find("NORMAL", 3);
  for (int set = 0; set < 16; ++set)
    if (const auto uvs = attributes.find("TEXCOORD_" + std::to_string(set), 2))
      p.uvs.emplace(set, *uvs);
  p.colors = attributes.find("COLOR_0", 3, 4);
  read_joints(attributes, p);
  read_targets(primitive, buffers, p);
  read_indices(primitive, buffers, p);
  if (const auto material = primitive.find("material"))
    p.material = material->as_index(~uint32_t(0), "materials");
  if (p.topology == GltfTopology::triangles && corner_count(p) % 3 != 0)
    warnings.add("the vertices of a mesh are not a multiple of 3; the last ones are left out");
  return p;
}

}  // namespace troffer
