// Key of a picture: hashes of everything that its bytes depend on. Two renderings with the same key
// make the same picture, so one may continue a checkpoint of the other, and their shares may be
// joined.
#pragma once

#include <cstdint>
#include <string>

#include "render/render.h"
#include "scene/scene.h"
#include "transport/prepared_scene.h"

namespace troffer {

struct PictureKey {
  std::string program;       // program version, at most 15 characters
  uint64_t settings = 0;     // camera, size, window, method and its options
  uint64_t scene = 0;        // surfaces, materials, images, lights
  uint64_t preparation = 0;  // preparation that was read from a file; 0: none
  bool operator==(const PictureKey&) const = default;
};

// preparation: the bytes of its file, or empty. The key leaves out what does not change the
// picture, such as threads, shares and limits. The 64-bit hashes detect mistakes, not tampering.
PictureKey picture_key(const std::string& program, const Scene& scene, const Camera& camera,
                       const RenderOptions& options, const std::vector<uint8_t>& preparation);

}  // namespace troffer
