// Loading of images into the textures of a scene, with caching, decoding in advance and a memory
// limit. Importers load the images of materials through it.
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

// Returns the value that replaces a missing image: middle grey for colours, since white would flood
// a room with light; 1 for data, which are factors.
inline Rgb stand_in_for_missing(bool is_color) {
  return Rgb{is_color ? 0.5f : 1.0f};
}

// Returns the bytes that an omitted image adds to Scene::skipped_image_bytes; at least 1, even if
// the file is missing.
uint64_t size_of_left_out(const std::string& path);

// Appends textures to a scene. Equal requests share a texture, and each image is decoded once.
// A missing or broken image never throws: it gives a warning in Scene::warnings and a constant
// texture of stand_in_for_missing(). If Scene::skipped_image_bytes is set, all images become such
// constants, without warnings.
class TextureLoader {
 public:
  // The scene must outlive the loader. `max_texel_bytes` limits all texels of a scene together: an
  // image that does not fit is halved until it does, with a warning.
  explicit TextureLoader(Scene& scene, uint64_t max_texel_bytes = uint64_t(4) << 30)
      : scene_(scene), max_texel_bytes_(max_texel_bytes) {}

  // Makes the loader respect gamma and colour profiles of images. Call it for formats that leave
  // colours to the images. By default 8- and 16-bit images are sRGB, as in glTF, pbrt and Mitsuba.
  void convert_to_srgb() { obeys_own_colours_ = true; }

  // True if announcing images in advance has an effect.
  bool decodes_ahead() const;
  // Announce that an image will be requested, so that another thread may decode it. `bytes` must
  // outlive the loader. The image need not be requested in the end.
  void expect_file(const std::string& path);
  void expect_memory(std::span<const uint8_t> bytes, const std::string& key);

  // Returns the index in Scene::textures of the image at `path`. Takes name, value, is_srgb (for
  // 8-bit images), is_inverted, is_filtered, mapping, wrap and uv fields from `look`, and fills in
  // kind, size and texels. An empty name becomes the path.
  int32_t from_file(const std::string& path, const Texture& look);

  // Returns the same for an encoded image (PNG, JPEG, …) in memory. `key` identifies the image in
  // warnings; it must differ from other keys and from all paths.
  int32_t from_memory(std::span<const uint8_t> bytes, const std::string& key, const Texture& look);

  // Returns the constant stand-in texture, with the warning "KEY: PROBLEM; grey replaces it".
  int32_t missing(const std::string& key, const std::string& problem, const Texture& look);

  // True if an image of that path or key has been requested.
  bool was_asked_for(const std::string& image) const;

 private:
  // Access to an encoded image.
  struct Source {
    std::function<std::span<const uint8_t>()> bytes;
    std::function<uint64_t()> size;  // bytes, if images are left out
    std::string file;                // path of the image; empty if it is in memory
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
  std::unique_ptr<ImagesAhead> ahead_;  // created when the first image is expected
};

}  // namespace troffer
