// What the bytes of a picture depend on, as numbers: two renderings with the same key make the same
// picture, and can go on from each other, or be joined.
#pragma once

#include <cstdint>
#include <string>

#include "render/render.h"
#include "scene/scene.h"
#include "transport/prepared_scene.h"

namespace troffer {

struct PictureKey {
  std::string program;       // its version; at most 15 characters
  uint64_t settings = 0;     // camera, size, window, method and all that it is told
  uint64_t scene = 0;        // surfaces, materials, images, lights
  uint64_t preparation = 0;  // what was prepared beforehand and came from a file; 0: nothing
  bool operator==(const PictureKey&) const = default;
};

// preparation: as in the file, or empty. What does not change the picture is not in it: threads,
// shares, limits, who looks on. Hashes of 64 bits, which find mistakes, not intent.
PictureKey picture_key(const std::string& program, const Scene& scene, const Camera& camera,
                       const RenderOptions& options, const std::vector<uint8_t>& preparation);

}  // namespace troffer
