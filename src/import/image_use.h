// Whether an importer reads the images that a scene shows.
#pragma once

#include <cstdint>

namespace troffer {

// left_out: colours that stand for missing images are there instead, lights of images are not, and
// Scene::left_out_image_bytes says how much was not read. For whoever wants the shapes at once.
enum class ImageUse : uint8_t { read, left_out };

}  // namespace troffer
