// What a user may choose among what one file holds.
#pragma once

#include <optional>
#include <string>

#include "import/image_use.h"
#include "import/read_progress.h"

namespace troffer {

struct ImportOptions {
  std::optional<std::string> variant;    // of the materials: KHR_materials_variants
  std::optional<double> time;            // seconds into an animation; none: at rest
  std::optional<std::string> animation;  // by name; none: the first
  bool shows_baked = false;              // glTF: light that was baked into the file, and no other
  TellProgress progress;                 // of the file; for .obj .ply .stl
  ImageUse images = ImageUse::read;
  // Factor on what surfaces emit, but for measured luminaires (import/surface_emission.h).
  double emission_scale = 1;

  bool is_any() const { return variant || time || animation || shows_baked; }
};

}  // namespace troffer
