// Images of linear float channels, in named layers. Renderers fill them, write_image() saves them
// and read_image() loads them. Each layer has its own unit.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/rgb.h"

namespace troffer {

// Row-major rgb, row 0 on top.
struct Image {
  int width = 0, height = 0;
  std::vector<Rgb> pixels;

  Image() = default;
  Image(int w, int h, Rgb fill = Rgb{0})
      : width(w), height(h), pixels(size_t(w) * size_t(h), fill) {}
  Rgb& at(int x, int y) { return pixels[size_t(y) * size_t(width) + size_t(x)]; }
  const Rgb& at(int x, int y) const { return pixels[size_t(y) * size_t(width) + size_t(x)]; }
};

// One layer (AOV): a name ("" for the picture, else for example "albedo") and 1 or 3 channels with
// EXR names `channels` ("R","G","B"; "X","Y","Z"; "Z"; "V"). Single-channel values are stored in r.
struct Layer {
  std::string name;
  std::vector<std::string> channels{"R", "G", "B"};
  Image image;
};

}  // namespace troffer
