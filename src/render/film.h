// Sums of samples per pixel, from which every layer is made.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "image/image.h"
#include "render/render.h"

namespace troffer {

// A rectangle of pixels, x1 and y1 exclusive.
struct PixelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
};

// What is known of a pixel.
struct PixelEstimate {
  uint32_t samples = 0;
  double luminance = 0, standard_error = 0;
};

class Film {
 public:
  // Bytes that a film of this many pixels takes.
  static double bytes(double pixels, const std::vector<Aov>& aovs);

  // `window`: the pixels kept, in coordinates of the whole image. `origin`: the scene's, added to
  // positions that are shown.
  Film(const PixelRect& window, const std::vector<Aov>& aovs, const Vec3d& origin = {});

  // Adds sample i of a batch to pixel (x, y). Different pixels may be added to concurrently; one
  // pixel's samples must come in a fixed order for the sums to be reproducible. Samples that are
  // not finite count as black; returns whether it was finite.
  bool add(int x, int y, const RadianceBatch& batch, size_t i, float depth);

  // (x, y) as in add().
  PixelEstimate estimate(int x, int y) const;

  // The picture, then the AOVs in the order given.
  std::vector<Layer> layers() const;

 private:
  struct Pixel {
    Vec3d direct, indirect;
    double sum_luminance = 0, sum_luminance_squared = 0;
    double source_variance = 0;  // of the samples' direct light, as far as the method tells it
    double shared_error = 0;     // … of their indirect light, likewise
    uint32_t samples = 0;
    bool has_source_variance = false;
  };
  struct FirstHit {  // sums over samples that hit something
    Vec3d albedo, normal, position, sources;
    double depth = 0, shadow_rays = 0;
    uint32_t hits = 0;
  };
  static double standard_error(const Pixel& p);
  static double told_error(const Pixel& p);
  Layer make_layer(Aov aov) const;

  PixelRect window_;
  std::vector<Aov> aovs_;
  Vec3d origin_;
  std::vector<Pixel> pixels_;
  std::vector<FirstHit> first_hits_;  // empty if no AOV needs it
};

}  // namespace troffer
