// Binary data of a glTF file that is being written, with its buffer views and accessors. The glTF
// exporter adds vertex data and images to it. The add functions return the index of the new entry.
// Data are little endian.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace troffer {

class GltfBuffer {
 public:
  using Json = nlohmann::ordered_json;

  // Adds a buffer view with these bytes; returns its index.
  size_t add_view(std::span<const uint8_t> bytes);
  // Add an accessor of vectors or indices; return its index.
  size_t add(const std::vector<Vec3>& values, bool has_bounds);
  size_t add(const std::vector<Vec3>& colors, const std::vector<float>& alphas);
  size_t add(const std::vector<Vec2>& values);
  size_t add(const std::vector<Triangle>& triangles);

  const std::vector<uint8_t>& bytes() const { return bytes_; }
  const Json& views() const { return views_; }
  const Json& accessors() const { return accessors_; }

 private:
  std::vector<uint8_t> bytes_;
  Json views_ = Json::array(), accessors_ = Json::array();

  size_t add_accessor(std::span<const uint8_t> bytes, int component, const char* type,
                      size_t count);
};

}  // namespace troffer
