#include "api/values.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "base/error.h"
#include "image/exposure.h"
#include "image/image.h"
#include "image/tone_map.h"

namespace troffer::api {

Affine affine(const Transform& t) {
  Affine a;
  for (size_t column = 0; column < 3; ++column)
    a.columns[column] = {t[0][column], t[1][column], t[2][column]};
  a.translation = {t[0][3], t[1][3], t[2][3]};
  return a;
}

double in_range(double value, double least, double most, const std::string& what) {
  if (!(value >= least && value <= most))
    throw UsageError(fmt::format("{} lies between {} and {}", what, least, most));
  return value;
}

Rgb share(const Color& c, const std::string& what) {
  for (const float v : c) in_range(double(v), 0, 1, what);
  return rgb(c);
}

Rgb emitted(const Color& c, const std::string& what) {
  for (const float v : c)
    if (!(v >= 0) || !std::isfinite(v))
      throw UsageError(what + " is three finite numbers, at least 0");
  return rgb(c);
}

Vec3d place(const Point& p, const std::string& what) {
  constexpr double farthest = 1e9;
  for (const double v : p)
    if (!(std::abs(v) <= farthest))
      throw UsageError(what + " is three finite numbers, at most 1e9 m from 0");
  return vec(p);
}

Vec3d direction(const Point& p, const std::string& what) {
  const Vec3d v = vec(p);
  const double size = length(v);
  if (!(size > 0) || !std::isfinite(size))
    throw UsageError(what + " is three finite numbers that are not all 0");
  return v / size;
}

troffer::Image image_of(const Image& image) {
  constexpr int most = 1 << 20;
  if (image.width < 1 || image.height < 1 || image.width > most || image.height > most)
    throw UsageError("a picture has between 1 and 1048576 rows and columns");
  troffer::Image made(image.width, image.height);
  if (image.pixels.size() != 3 * made.pixels.size())
    throw UsageError(fmt::format("a picture of {} x {} has {} numbers, not {}", image.width,
                                 image.height, 3 * made.pixels.size(), image.pixels.size()));
  static_assert(sizeof(Rgb) == 3 * sizeof(float));
  std::memcpy(&made.pixels.data()->r, image.pixels.data(), image.pixels.size() * sizeof(float));
  return made;
}

Display display_of(const DisplayOptions& options, const troffer::Image& picture) {
  constexpr double most = 60;
  if (options.exposure && !(std::abs(*options.exposure) <= most))
    throw UsageError("exposure lies between -60 and 60 stops");
  const double stops = options.exposure ? *options.exposure : brightness(picture).auto_stops;
  return {stops, options.is_filmic ? ToneMap::filmic : ToneMap::none};
}

}  // namespace troffer::api
