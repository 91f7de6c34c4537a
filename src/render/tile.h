// Division of a picture into tiles and shares, and the viewing rays of pixels. Used by render(),
// Rendering and the viewer. Coordinates are pixels of the whole image, from its top left corner.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/camera.h"
#include "render/film.h"
#include "transport/batch.h"

namespace troffer {

// Returns the pixels asked for. Throws UsageError if there are none, or if some lie outside the
// picture.
PixelRect wanted_window(const RenderOptions& options, int width, int height);

// Cuts the window into squares, row by row; those at its right and lower border may be smaller.
std::vector<PixelRect> tiles_of(const PixelRect& window, int side);

// Returns the window grown to whole tiles of the image's tiling, which starts at its top left
// corner. `rings` rings of tiles around it are added, as far as the image reaches.
PixelRect whole_tiles(const PixelRect& window, int side, int rings, const PixelRect& image);

// Returns the part `window` of an image whose pixels are those of `region`.
Image part_of(const Image& image, const PixelRect& region, const PixelRect& window);

// The pixels to render, and their tiles.
struct TilePlan {
  PixelRect image;   // whole picture
  PixelRect asked;   // pixels asked for, over all shares
  PixelRect window;  // pixels asked for in this share
  PixelRect region;  // pixels rendered: the window, plus neighbours that it depends on
  // where refinement is decided: the window, grown to whole tiles if tiles are whole
  PixelRect inner;
  int side = 0;                  // side of tiles, pixels
  std::vector<PixelRect> tiles;  // tiles of the region
};

// Properties of the method that determine the tiles.
struct TileRules {
  int side = 0;
  // Tiles are those of the whole picture, with a ring of tiles around them if refinement depends on
  // neighbours. The pixels of a crop or share then equal those of the picture.
  bool has_whole_tiles = false;
  bool is_refined = false;
  // Refinement depends on all pixels asked for.
  bool looks_at_all = false;
};

// Returns share `part` of `parts`, counted from 1: a rectangle of whole tiles. Shares are about
// equally large, and every pixel belongs to exactly one. Throws UsageError if there are more shares
// than tiles.
PixelRect share_of(const PixelRect& asked, const TileRules& rules, int part, int parts);

// Plans the tiles. window: the pixels asked for, or a share of them.
TilePlan plan_tiles(const PixelRect& image, const PixelRect& asked, const PixelRect& window,
                    const TileRules& rules);

// Returns the number of pixels that two rectangles have in common.
size_t common_pixels(const PixelRect& a, const PixelRect& b);

struct Pixel2 {
  int x = 0, y = 0;
};

// Returns the pixels of a tile in boustrophedon order: each is a neighbour of the one before.
std::vector<Pixel2> pixels_in_order(const PixelRect& tile);

// Appends viewing rays `first` … first + count - 1 of a pixel, spread over its square (box filter).
void add_viewing_rays(const ViewingCamera& camera, const Pixel2& pixel, uint32_t first,
                      uint32_t count, uint64_t seed, ViewingRays& rays);

}  // namespace troffer
