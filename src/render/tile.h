// Tiles of the picture and the viewing rays through them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/camera.h"
#include "render/film.h"
#include "transport/batch.h"

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
  PixelRect asked;   // what is wanted of it, all shares together
  PixelRect window;  // what is wanted here
  PixelRect region;  // what is rendered: the window, and what it takes for it to be as it should
  PixelRect inner;   // where refinement is decided: the window in whole tiles, or the window itself
  int side = 0;      // of tiles, pixels
  std::vector<PixelRect> tiles;  // of the region
};

struct TileRules {
  int side = 0;
  // Tiles are those of the whole picture, with a ring of tiles around them where neighbours decide
  // about refinement, so that the pixels of a crop, or a share, can be those of the picture.
  bool has_whole_tiles = false;
  bool is_refined = false;
  // Refinement looks at all that is asked for.
  bool looks_at_all = false;
};

// The part-th of `parts` shares of what is asked for, both counted from 1: a rectangle of whole
// tiles, all of them about as large. Together they are all of it, each pixel once. UsageError where
// there are more shares than tiles.
PixelRect share_of(const PixelRect& asked, const TileRules& rules, int part, int parts);

// window: what is asked for, or a share of it.
TilePlan plan_tiles(const PixelRect& image, const PixelRect& asked, const PixelRect& window,
                    const TileRules& rules);

// How many pixels two rectangles have in common.
size_t common_pixels(const PixelRect& a, const PixelRect& b);

struct Pixel2 {
  int x = 0, y = 0;
};

// The pixels of a tile in boustrophedon order: each is a neighbour of the one before.
std::vector<Pixel2> pixels_in_order(const PixelRect& tile);

// Appends viewing rays `first` … first + count - 1 of a pixel, spread over its square (box filter).
void add_viewing_rays(const ViewingCamera& camera, const Pixel2& pixel, uint32_t first,
                      uint32_t count, uint64_t seed, ViewingRays& rays);

}  // namespace troffer
