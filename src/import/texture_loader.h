// Images -> textures of a scene.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "scene/scene.h"

namespace troffer {

// Appends textures to a scene. Equal requests share one texture, and an image is decoded once
// however many textures show it. An image that is missing or cannot be decoded becomes a warning
// in Scene::warnings and a constant texture of value 1: never an exception.
class TextureLoader {
 public:
  // The scene must outlive the loader.
  explicit TextureLoader(Scene& scene) : scene_(scene) {}

  // Index in Scene::textures of the image at `path`, looked up as `look` says: its name, value,
  // is_srgb (of 8-bit images), is_inverted, is_filtered, wrap and uv fields are kept; kind, size
  // and texels are filled in. An empty name becomes the path.
  int32_t from_file(const std::string& path, const Texture& look);

  // The same for an encoded image (PNG, JPEG …) in memory. `key` stands for the image in warnings
  // and must differ between images, and from all paths.
  int32_t from_memory(std::span<const uint8_t> bytes, const std::string& key, const Texture& look);

  // A constant texture of value 1 and the warning "KEY: PROBLEM; a white texture stands for it".
  int32_t missing(const std::string& key, const std::string& problem, const Texture& look);

 private:
  // Index of the first texture made for (image, look), and of any texture that holds the image.
  std::map<std::string, int32_t> by_request_, by_image_;
  uint64_t texel_bytes_ = 0;
  Scene& scene_;

  int32_t find(const std::string& key, const Texture& look);
  int32_t decode(std::span<const uint8_t> bytes, const std::string& key, const Texture& look);
  int32_t remember(const std::string& key, Texture texture);
};

}  // namespace troffer
