#include "render/tile.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "base/random.h"
#include "integrate/purposes.h"

namespace troffer {

std::vector<PixelRect> tiles_of(const PixelRect& window, int side) {
  std::vector<PixelRect> tiles;
  for (int y = window.y0; y < window.y1; y += side)
    for (int x = window.x0; x < window.x1; x += side)
      tiles.push_back({x, y, std::min(x + side, window.x1), std::min(y + side, window.y1)});
  return tiles;
}

PixelRect whole_tiles(const PixelRect& window, int side, int rings, const PixelRect& image) {
  const auto first = [&](int v) { return (v / side - rings) * side; };
  const auto last = [&](int v) { return ((v + side - 1) / side + rings) * side; };
  return {std::max(first(window.x0), image.x0), std::max(first(window.y0), image.y0),
          std::min(last(window.x1), image.x1), std::min(last(window.y1), image.y1)};
}

PixelRect wanted_window(const RenderOptions& o, int width, int height) {
  if (!o.has_crop) return {0, 0, width, height};
  const PixelRect w{o.crop[0], o.crop[1], o.crop[2], o.crop[3]};
  if (w.x0 < 0 || w.y0 < 0 || w.x1 > width || w.y1 > height || w.x0 >= w.x1 || w.y0 >= w.y1)
    throw UsageError("--crop is empty or reaches outside the image of " + std::to_string(width) +
                     "x" + std::to_string(height) + " pixels");
  return w;
}

TilePlan plan_tiles(const PixelRect& image, const PixelRect& window, int side, bool has_whole_tiles,
                    bool is_refined) {
  TilePlan p{image, window, window, window, side, {}};
  if (has_whole_tiles) {
    p.region = whole_tiles(window, side, is_refined ? 1 : 0, image);
    p.inner = whole_tiles(window, side, 0, image);
  }
  p.tiles = tiles_of(p.region, side);
  return p;
}

Image part_of(const Image& image, const PixelRect& region, const PixelRect& window) {
  Image part(window.width(), window.height());
  for (int y = 0; y < part.height; ++y)
    for (int x = 0; x < part.width; ++x)
      part.at(x, y) = image.at(window.x0 - region.x0 + x, window.y0 - region.y0 + y);
  return part;
}

std::vector<Pixel2> pixels_in_order(const PixelRect& tile) {
  std::vector<Pixel2> pixels;
  for (int y = tile.y0; y < tile.y1; ++y)
    for (int i = 0; i < tile.width(); ++i)
      pixels.push_back({(y - tile.y0) % 2 == 0 ? tile.x0 + i : tile.x1 - 1 - i, y});
  return pixels;
}

void add_viewing_rays(const ViewingCamera& camera, const Pixel2& pixel, uint32_t first,
                      uint32_t count, uint64_t seed, ViewingRays& rays) {
  const uint64_t stream = hash_of(seed, uint64_t(pixel.x), uint64_t(pixel.y));
  for (uint32_t s = first; s < first + count; ++s) {
    const SobolGroup random(stream, purpose_camera, s);
    const Vec2 raster = Vec2{float(pixel.x), float(pixel.y)} + random.get2(0);
    rays.rays.push_back(camera.ray(raster, random.get2(2)));
    rays.streams.push_back(stream);
    rays.samples.push_back(s);
    rays.pixels.push_back({pixel.x, pixel.y});
  }
}

}  // namespace troffer
