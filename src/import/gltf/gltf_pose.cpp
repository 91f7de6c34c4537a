#include "import/gltf/gltf_pose.h"

#include <cmath>
#include <optional>

namespace troffer {

namespace {

constexpr uint64_t max_instances = 10'000'000;

Affine inverse_bind(const AccessorView& matrices, uint64_t i) {
  const auto m = matrices.read_matrix(i);
  const auto column = [&](size_t c) {
    return Vec3d{double(m[4 * c]), double(m[4 * c + 1]), double(m[4 * c + 2])};
  };
  Affine a;
  a.columns = {column(0), column(1), column(2)};
  a.translation = column(3);
  return a;
}

}  // namespace

std::vector<Affine> gltf_joints(const JsonNode& skin, const GltfBuffers& buffers,
                                const std::vector<Affine>& world_of_nodes) {
  const JsonNode list = skin.member("joints");
  const auto reference = skin.find("inverseBindMatrices");
  const AccessorView* matrices = nullptr;
  if (reference) {
    matrices = &buffers.accessor(*reference);
    if (matrices->components != 16 || matrices->component_type != gltf_float)
      reference->fail("its accessor should be of type MAT4, of floats");
    if (matrices->count < list.size())
      reference->fail("its accessor has fewer elements than the skin has joints");
  }
  std::vector<Affine> joints;
  for (size_t i = 0; i < list.size(); ++i) {
    const Affine& world = world_of_nodes[list.element(i).as_index(world_of_nodes.size(), "nodes")];
    joints.push_back(matrices ? world * inverse_bind(*matrices, i) : world);
  }
  return joints;
}

std::vector<double> gltf_target_weights(const JsonNode& node, const JsonNode& mesh) {
  auto weights = node.find("weights");
  if (!weights) weights = mesh.find("weights");
  std::vector<double> out;
  for (size_t i = 0; weights && i < weights->size(); ++i)
    out.push_back(weights->element(i).as_number());
  return out;
}

std::vector<Affine> gltf_instances(const JsonNode& node, const GltfBuffers& buffers) {
  const auto extension = node.extension("EXT_mesh_gpu_instancing");
  if (!extension) return {Affine{}};
  const JsonNode attributes = extension->member("attributes");
  uint64_t count = 0;
  bool is_known = false;
  const auto find = [&](const char* name, uint32_t components) -> const AccessorView* {
    const auto reference = attributes.find(name);
    if (!reference) return nullptr;
    const AccessorView& view = buffers.accessor(*reference);
    if (view.components != components || view.component_type == gltf_unsigned_int)
      reference->fail("its accessor should be of type VEC" + std::to_string(components));
    if ((is_known && view.count != count) || view.count > max_instances)
      reference->fail(
          "its accessor's count differs from that of the other attributes, or is too large");
    count = view.count;
    is_known = true;
    return &view;
  };
  const AccessorView* const translations = find("TRANSLATION", 3);
  const AccessorView* const rotations = find("ROTATION", 4);
  const AccessorView* const scales = find("SCALE", 3);
  std::vector<Affine> out;
  for (uint64_t i = 0; i < count; ++i) {
    const auto vector = [&](const AccessorView& view) {
      const auto v = view.read(i);
      return Vec3d{double(v[0]), double(v[1]), double(v[2])};
    };
    Affine a;
    if (translations) a = Affine::translate(vector(*translations));
    if (rotations) {
      const auto q = rotations->read(i);
      a = a * gltf_rotation(*extension, double(q[0]), double(q[1]), double(q[2]), double(q[3]));
    }
    if (scales) a = a * Affine::scale(vector(*scales));
    out.push_back(a);
  }
  return out;
}

Affine gltf_rotation(const JsonNode& where, double qx, double qy, double qz, double qw) {
  const double length = std::sqrt(qx * qx + qy * qy + qz * qz + qw * qw);
  if (!(length > 1e-6) || !std::isfinite(length)) where.fail("is not a rotation");
  const double x = qx / length, y = qy / length, z = qz / length, w = qw / length;
  Affine a;
  a.columns = {Vec3d{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
               Vec3d{2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
               Vec3d{2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}};
  return a;
}

}  // namespace troffer
