// Reads EXR files with all their layers, window and note, as write_image() wrote them. The `merge`
// command uses it. For single pictures of any format see read_image.h.
#pragma once

#include <string>
#include <vector>

#include "image/raster.h"
#include "image/write_image.h"

namespace troffer {

// Content of a file as write_image() writes it.
struct LayeredImage {
  std::vector<Layer> layers;  // picture first, others by name
  ImageWindow window;         // position in the whole picture
  std::string note;           // WriteOptions::note
};

// Reads all layers. Throws InputError, also for channels that write_image() does not write, such as
// half floats. max_pixels limits the sum over all layers.
LayeredImage read_layers(const std::string& path, size_t max_pixels = default_max_pixels);

}  // namespace troffer
