#include "render/tile.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "base/random.h"
#include "transport/purposes.h"

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

PixelRect share_of(const PixelRect& asked, const TileRules& rules, int part, int parts) {
  if (parts <= 1) return asked;
  const int side = rules.side;
  // Origin of the tiling.
  const int x = rules.has_whole_tiles ? asked.x0 / side * side : asked.x0,
            y = rules.has_whole_tiles ? asked.y0 / side * side : asked.y0;
  PixelRect tiles{0, 0, (asked.x1 - x + side - 1) / side, (asked.y1 - y + side - 1) / side};
  const int64_t count = int64_t(tiles.width()) * tiles.height();
  if (parts > count)
    throw UsageError("--part: the picture has only " + std::to_string(count) + " tiles of " +
                     std::to_string(side) + "x" + std::to_string(side) + " pixels to divide");
  // Cut in two across the longer side until one share is left.
  int64_t first = part - 1, left = parts;
  while (left > 1) {
    const bool is_wide = tiles.width() >= tiles.height();
    const int64_t length = is_wide ? tiles.width() : tiles.height(),
                  across = is_wide ? tiles.height() : tiles.width();
    const int64_t cut =
        std::clamp<int64_t>((length * (left / 2) * 2 + left) / (2 * left), 1, length - 1);
    const int64_t before =
        std::clamp<int64_t>(left / 2, std::max<int64_t>(1, left - (length - cut) * across),
                            std::min(left - 1, cut * across));
    const bool is_before = first < before;
    (is_wide ? (is_before ? tiles.x1 : tiles.x0) : (is_before ? tiles.y1 : tiles.y0)) =
        (is_wide ? tiles.x0 : tiles.y0) + int(cut);
    first -= is_before ? 0 : before;
    left = is_before ? before : left - before;
  }
  return {std::max(x + tiles.x0 * side, asked.x0), std::max(y + tiles.y0 * side, asked.y0),
          std::min(x + tiles.x1 * side, asked.x1), std::min(y + tiles.y1 * side, asked.y1)};
}

TilePlan plan_tiles(const PixelRect& image, const PixelRect& asked, const PixelRect& window,
                    const TileRules& rules) {
  TilePlan p{image, asked, window, window, window, rules.side, {}};
  if (rules.has_whole_tiles) {
    p.region = whole_tiles(window, rules.side, rules.is_refined ? 1 : 0, image);
    p.inner = whole_tiles(window, rules.side, 0, image);
  } else if (rules.is_refined && rules.looks_at_all) {
    p.region = asked;
  }
  p.tiles = tiles_of(p.region, rules.side);
  return p;
}

size_t common_pixels(const PixelRect& a, const PixelRect& b) {
  const int width = std::min(a.x1, b.x1) - std::max(a.x0, b.x0),
            height = std::min(a.y1, b.y1) - std::max(a.y0, b.y0);
  return width > 0 && height > 0 ? size_t(width) * size_t(height) : 0;
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
    const Vec2 place = random.get2(0), raster = Vec2{float(pixel.x), float(pixel.y)} + place;
    rays.rays.push_back(camera.ray(raster, random.get2(2)));
    rays.streams.push_back(stream);
    rays.samples.push_back(s);
    rays.pixels.push_back({pixel.x, pixel.y});
    rays.places.push_back(place);
  }
}

}  // namespace troffer
