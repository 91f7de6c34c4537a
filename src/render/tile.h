// Tiles of the picture and the viewing rays through them.
#pragma once

#include <cstdint>
#include <vector>

#include "integrate/batch.h"
#include "render/camera.h"
#include "render/film.h"

namespace troffer {

// The window cut into squares, row by row; those at its right and lower border may be smaller.
std::vector<PixelRect> tiles_of(const PixelRect& window, int side);

// The window grown to whole tiles of the image's own tiling (from its top left corner), and by
// `rings` of tiles around them, as far as the image reaches.
PixelRect whole_tiles(const PixelRect& window, int side, int rings, const PixelRect& image);

// The part `window` of an image whose pixels are those of `region`.
Image part_of(const Image& image, const PixelRect& region, const PixelRect& window);

struct Pixel2 {
  int x = 0, y = 0;
};

// The pixels of a tile in boustrophedon order: each is a neighbour of the one before.
std::vector<Pixel2> pixels_in_order(const PixelRect& tile);

// Appends viewing rays `first` … first + count - 1 of a pixel, spread over its square (box filter).
void add_viewing_rays(const ViewingCamera& camera, const Pixel2& pixel, uint32_t first,
                      uint32_t count, uint64_t seed, ViewingRays& rays);

}  // namespace troffer
