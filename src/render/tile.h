// Tiles of the picture and the viewing rays through them.
#pragma once

#include <cstdint>
#include <vector>

#include "integrate/batch.h"
#include "render/camera.h"
#include "render/film.h"

namespace troffer {

// The pixels that are asked for: UsageError where they are none, or not all in the picture.
PixelRect wanted_window(const RenderOptions& options, int width, int height);

// The window cut into squares, row by row; those at its right and lower border may be smaller.
std::vector<PixelRect> tiles_of(const PixelRect& window, int side);

// The window grown to whole tiles of the image's own tiling (from its top left corner), and by
// `rings` of tiles around them, as far as the image reaches.
PixelRect whole_tiles(const PixelRect& window, int side, int rings, const PixelRect& image);

// The part `window` of an image whose pixels are those of `region`.
Image part_of(const Image& image, const PixelRect& region, const PixelRect& window);

// Which pixels are rendered, and in which tiles.
struct TilePlan {
  PixelRect image;   // the whole picture
  PixelRect window;  // what is wanted of it
  PixelRect region;  // what is rendered: the window, and what it takes for it to be as it should
  PixelRect inner;   // where refinement is decided: the window in whole tiles, or the window itself
  int side = 0;      // of tiles, pixels
  std::vector<PixelRect> tiles;  // of the region
};

// has_whole_tiles: tiles are those of the whole picture, with a ring of tiles around them where
// neighbours decide about refinement, so that the pixels of a crop can be those of the picture.
TilePlan plan_tiles(const PixelRect& image, const PixelRect& window, int side, bool has_whole_tiles,
                    bool is_refined);

struct Pixel2 {
  int x = 0, y = 0;
};

// The pixels of a tile in boustrophedon order: each is a neighbour of the one before.
std::vector<Pixel2> pixels_in_order(const PixelRect& tile);

// Appends viewing rays `first` … first + count - 1 of a pixel, spread over its square (box filter).
void add_viewing_rays(const ViewingCamera& camera, const Pixel2& pixel, uint32_t first,
                      uint32_t count, uint64_t seed, ViewingRays& rays);

}  // namespace troffer
