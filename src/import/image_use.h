// Choice of whether an importer reads the images of a scene.
#pragma once

#include <cstdint>

namespace troffer {

// left_out: missing images' stand-in colours replace all images, lights made of images are omitted,
// and Scene::skipped_image_bytes counts the bytes not read. For callers that need only the
// geometry, quickly.
enum class ImageUse : uint8_t { read, left_out };

}  // namespace troffer
