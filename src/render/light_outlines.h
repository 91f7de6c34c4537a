// Outlines of the scene's lights as a camera sees them: where something small and bright meets its
// surroundings is known before any sample is drawn, and mostly how much of a pixel it covers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/camera.h"
#include "render/tile.h"
#include "transport/prepared_scene.h"

namespace troffer {

// Of a lamp's flat pieces as the camera sees them the area within a pixel is exact. So what rays of
// the pixel meet of them may be left out of their mean and the area be put in its place: a control
// variate, by the places of rays alone. Whatever hides a lamp, or lies before it, the mean over the
// pixel stays (but for what floats round places by along a hidden outline); the noise of the lamp's
// outline is gone where nothing does.
class LightOutlines {
 public:
  // knows_covers: else nothing is_known().
  LightOutlines(const PreparedScene& scene, const ViewingCamera& camera, const PixelRect& region,
                bool knows_covers, int threads);

  // Whether an outline goes through the pixel that the camera sees directly. Disks and spheres are
  // taken as polygons. With a lens: as seen from its middle.
  bool has_outline(int x, int y) const { return pixels_[index(x, y)] != nothing; }
  // … and of all that do, nothing is found to hide a part there, and what they cover is known:
  // lights of one radiance all over, through no lens.
  bool is_known(int x, int y) const { return pixels_[index(x, y)] >= first_known; }

  // … but in a pixel beside it something hides what should be seen, and may do so here.
  bool is_doubtful(int x, int y) const { return is_doubtful_[index(x, y)] != 0; }

  // A corner of a lamp, in its pixel, and whether the side from it to the next is of the outline.
  struct Corner {
    Vec2d at;
    bool is_outline = true;
  };

  // To be added to what a ray at `place` in the pixel, in [0,1)², brings: its mean over the pixel
  // is 0. What lamps would send on average over the pixel, less what they send along this ray, if
  // nothing hid them; 0 where that is not known. `seen`: what the ray has found to shine: where it
  // runs along an outline, closer than places are rounded, that tells.
  Rgb evened(int x, int y, const Vec2& place, Rgb seen) const;

 private:
  static constexpr uint32_t nothing = 0, unknown = 1, first_known = 2;
  static constexpr size_t most_corners = 512;  // of a pixel: each ray looks at all
  // Convex, within the pixel, of positive area.
  struct Piece {
    Rgb radiance;
    uint32_t first = 0, count = 0;  // of corners_
  };
  struct Cover {
    Rgb mean;
    uint32_t first = 0, count = 0;  // of pieces_
  };
  struct Visit;
  struct Shapes;
  size_t index(int x, int y) const {
    return size_t(y - region_.y0) * size_t(region_.width()) + size_t(x - region_.x0);
  }
  void take(const PreparedScene& scene, const ViewingCamera& camera, std::span<const Visit> visits,
            std::vector<Shapes>& shapes);
  void add_pieces(const Shapes& shapes, const Pixel2& pixel, Cover& cover);
  void check_covers(const PreparedScene& scene, const ViewingCamera& camera, int threads);
  double depth_in_lamp(int x, int y, const Vec2& place) const;
  std::span<const Corner> corners_of(const Piece& piece) const;
  std::span<const Piece> pieces_of(const Cover& cover) const;

  PixelRect region_;
  bool knows_covers_;
  double blur_;                   // pixels by which places may be rounded
  std::vector<uint32_t> pixels_;  // from first_known on: covers_[…]
  std::vector<Cover> covers_;
  std::vector<Piece> pieces_;
  std::vector<Corner> corners_;
  std::vector<uint8_t> is_doubtful_;  // per pixel
};

}  // namespace troffer
