#include "export/ply_writer.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>

namespace troffer {

namespace {

static_assert(std::endian::native == std::endian::little);

template <class T>
void append(std::vector<uint8_t>& to, const T& value) {
  const size_t at = to.size();
  to.resize(at + sizeof value);
  std::memcpy(to.data() + at, &value, sizeof value);
}

}  // namespace

std::vector<uint8_t> ply_of(const Mesh& mesh, const std::vector<Vec2>& uvs, const Vec3d& origin) {
  const bool is_far = origin != Vec3d{};
  const char* const real = is_far ? "double" : "float";
  std::string head = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty {} x\nproperty {} y\n"
      "property {} z\n",
      mesh.positions.size(), real, real, real);
  if (!mesh.normals.empty()) head += "property float nx\nproperty float ny\nproperty float nz\n";
  if (!uvs.empty()) head += "property float u\nproperty float v\n";
  head += fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n",
                      mesh.triangles.size());
  std::vector<uint8_t> out(head.begin(), head.end());
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    if (is_far)
      append(out, Vec3d(mesh.positions[i]) + origin);
    else
      append(out, mesh.positions[i]);
    if (!mesh.normals.empty()) append(out, mesh.normals[i]);
    if (!uvs.empty()) append(out, uvs[i]);
  }
  for (const Triangle& t : mesh.triangles) {
    append(out, uint8_t(3));
    append(out, t);
  }
  return out;
}

}  // namespace troffer
