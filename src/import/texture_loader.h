// Images -> textures of a scene.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "image/raster.h"
#include "import/images_ahead.h"
#include "scene/scene.h"

namespace troffer {

// Middle grey for colours, so that nothing becomes a white that blinds the room; 1 for data, which
// is a factor.
inline Rgb stand_in_for_missing(bool is_color) {
  return Rgb{is_color ? 0.5f : 1.0f};
}

// What an image that is left out adds to Scene::left_out_image_bytes: 1 at least, for one that is
// not there too.
uint64_t size_of_left_out(const std::string& path);

// Appends textures to a scene. Equal requests share one texture, and an image is decoded once
// however many textures show it. An image that is missing or cannot be decoded becomes a warning
// in Scene::warnings and a constant texture, of stand_in_for_missing(): never an exception. Where
// Scene::left_out_image_bytes is set, all are such constants, without a warning.
class TextureLoader {
 public:
  // The scene must outlive the loader. All texels of a scene together take `max_texel_bytes` at
  // most: an image that does not fit any more is halved until it does, with a warning.
  explicit TextureLoader(Scene& scene, uint64_t max_texel_bytes = uint64_t(4) << 30)
      : scene_(scene), max_texel_bytes_(max_texel_bytes) {}

  // Of formats that leave it to images what their colours are: gamma and profiles are obeyed. Else
  // 8- and 16-bit images are in sRGB, as glTF demands and pbrt and Mitsuba do.
  void obey_own_colours() { obeys_own_colours_ = true; }

  // Whether there is any use in telling what will be asked for.
  bool decodes_ahead() const;
  // That one of these will be asked for: it is decoded meanwhile where there are cores for it. The
  // bytes must outlive the loader. Changes nothing else, whether it will be or not.
  void expect_file(const std::string& path);
  void expect_memory(std::span<const uint8_t> bytes, const std::string& key);

  // Index in Scene::textures of the image at `path`, looked up as `look` says: its name, value,
  // is_srgb (of 8-bit images), is_inverted, is_filtered, mapping, wrap and uv fields are kept;
  // kind, size and texels are filled in. An empty name becomes the path.
  int32_t from_file(const std::string& path, const Texture& look);

  // The same for an encoded image (PNG, JPEG …) in memory. `key` stands for the image in warnings
  // and must differ between images, and from all paths.
  int32_t from_memory(std::span<const uint8_t> bytes, const std::string& key, const Texture& look);

  // That constant texture and the warning "KEY: PROBLEM; grey stands for it".
  int32_t missing(const std::string& key, const std::string& problem, const Texture& look);

  // Whether an image of that path or key was.
  bool was_asked_for(const std::string& image) const;

 private:
  // An encoded image.
  struct Source {
    std::function<std::span<const uint8_t>()> bytes;
    std::function<uint64_t()> size;  // where it is left out
    std::string file;                // that it is; or none
  };

  int32_t add(const std::string& key, const Texture& look, const Source& source);
  int32_t constant(const std::string& key, const Texture& look);
  void expect(const std::string& key, ImagesAhead::Decode decode);
  Raster color_raster(const std::string& key, Raster raster);
  const Texture* decoded(const std::string& key, const Texture& look) const;
  Texture reduced(Texture texture);
  int32_t remember(const std::string& key, const Texture& look, Texture texture);

  Scene& scene_;
  std::map<std::string, int32_t> by_request_;                 // image and look -> texture
  std::map<std::pair<std::string, bool>, int32_t> by_image_;  // image, read as sRGB -> texture
  uint64_t texel_bytes_ = 0, max_texel_bytes_;
  bool obeys_own_colours_ = false;
  std::unique_ptr<ImagesAhead> ahead_;  // once an image is expected
};

}  // namespace troffer
