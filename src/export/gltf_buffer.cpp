#include "export/gltf_buffer.h"

#include <bit>

#include "base/box.h"

namespace troffer {

namespace {

static_assert(std::endian::native == std::endian::little);
constexpr int float_component = 5126, uint_component = 5125;

template <class T>
std::span<const uint8_t> bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const uint8_t*>(values.data()), values.size() * sizeof(T)};
}

}  // namespace

size_t GltfBuffer::add_view(std::span<const uint8_t> bytes) {
  while (bytes_.size() % 4 != 0) bytes_.push_back(0);
  views_.push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}});
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  return views_.size() - 1;
}

size_t GltfBuffer::add_accessor(std::span<const uint8_t> bytes, int component, const char* type,
                                size_t count) {
  const size_t view = add_view(bytes);
  accessors_.push_back(
      {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
  return accessors_.size() - 1;
}

size_t GltfBuffer::add(const std::vector<Vec3>& values, bool has_bounds) {
  const size_t index = add_accessor(bytes_of(values), float_component, "VEC3", values.size());
  if (!has_bounds) return index;
  Box box;
  for (const Vec3& v : values) box.grow(v);
  accessors_[index]["min"] = {box.lower.x, box.lower.y, box.lower.z};
  accessors_[index]["max"] = {box.upper.x, box.upper.y, box.upper.z};
  return index;
}

size_t GltfBuffer::add(const std::vector<Vec3>& colors, const std::vector<float>& alphas) {
  std::vector<float> values;
  values.reserve(4 * colors.size());
  for (size_t i = 0; i < colors.size(); ++i)
    values.insert(values.end(), {colors[i].x, colors[i].y, colors[i].z, alphas[i]});
  return add_accessor(bytes_of(values), float_component, "VEC4", colors.size());
}

size_t GltfBuffer::add(const std::vector<Vec2>& values) {
  return add_accessor(bytes_of(values), float_component, "VEC2", values.size());
}

size_t GltfBuffer::add(const std::vector<Triangle>& triangles) {
  return add_accessor(bytes_of(triangles), uint_component, "SCALAR", triangles.size() * 3);
}

}  // namespace troffer
