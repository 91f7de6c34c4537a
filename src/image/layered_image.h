// EXR files with all their layers.
#pragma once

#include <string>
#include <vector>

#include "image/raster.h"
#include "image/write_image.h"

namespace troffer {

// As write_image() writes it.
struct LayeredImage {
  std::vector<Layer> layers;  // the picture first, the others by name
  ImageWindow window;         // where it lies in the whole picture
  std::string note;           // WriteOptions::note
};

// Errors: InputError; also for channels that write_image() does not write, halves among them.
// max_pixels: of all layers together.
LayeredImage read_layers(const std::string& path, size_t max_pixels = default_max_pixels);

}  // namespace troffer
