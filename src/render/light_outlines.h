// Outlines of lights in the picture, found by geometry before any sample is drawn. They tell in
// which pixels a small bright light meets its surroundings, and mostly how much of the pixel it
// covers. Used by refinement (EdgeMap) and as a control variate for visible lamps.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/camera.h"
#include "render/tile.h"
#include "transport/prepared_scene.h"

namespace troffer {

// Exact coverage of visible lamps in pixels. The area of a lamp's flat pieces within a pixel is
// exact, so it can replace the part that rays meet. This is a control variate that depends only on
// ray positions. It is unbiased even if something hides the lamp, apart from rounding along a
// hidden outline. If nothing does, it removes the noise of the lamp's edge.
class LightOutlines {
 public:
  // knows_covers: if false, is_known() is false for all pixels.
  LightOutlines(const PreparedScene& scene, const ViewingCamera& camera, const PixelRect& region,
                bool knows_covers, int threads);

  // True if a directly visible outline passes through the pixel. Disks and spheres count as
  // polygons. With a lens, the view is from its centre.
  bool has_outline(int x, int y) const { return pixels_[index(x, y)] != nothing; }
  // True if moreover nothing hides a part of these outlines and the coverage is known. The lights
  // must have uniform radiance, and the camera no lens.
  bool is_known(int x, int y) const { return pixels_[index(x, y)] >= first_known; }

  // True if something hides a lamp in a neighbouring pixel where it should be visible, and so may
  // hide it here.
  bool is_doubtful(int x, int y) const { return is_doubtful_[index(x, y)] != 0; }

  // A corner of a lamp's piece, relative to its pixel. is_outline: the side from here to the next
  // corner belongs to the outline.
  struct Corner {
    Vec2d at;
    bool is_outline = true;
  };

  // Returns the correction for a ray at `place` in the pixel, [0,1)²: the mean unoccluded light of
  // lamps over the pixel, minus their light at this place. Its mean over the pixel is 0, and it is
  // 0 where coverage is not known. `seen` is the emission that the ray has met. It decides for rays
  // within rounding error of an outline.
  Rgb edge_correction(int x, int y, const Vec2& place, Rgb seen) const;

 private:
  static constexpr uint32_t nothing = 0, unknown = 1, first_known = 2;
  static constexpr size_t most_corners = 512;  // per pixel: each ray tests all
  // A convex piece within the pixel, of positive area.
  struct Piece {
    Rgb radiance;
    uint32_t first = 0, count = 0;  // range in corners_
  };
  struct Cover {
    Rgb mean;
    uint32_t first = 0, count = 0;  // range in pieces_
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
  double blur_;                   // rounding error of positions, pixels
  std::vector<uint32_t> pixels_;  // nothing, unknown, or first_known + index in covers_
  std::vector<Cover> covers_;
  std::vector<Piece> pieces_;
  std::vector<Corner> corners_;
  std::vector<uint8_t> is_doubtful_;  // per pixel
};

}  // namespace troffer
