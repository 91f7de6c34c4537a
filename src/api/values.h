// Conversions between plain types of the public interface and types of the renderer, with checks of
// the values that callers pass. All files of api/ use them. Lengths are in metres.
#pragma once

#include <string>

#include "base/rgb.h"
#include "base/transform.h"
#include "base/vec.h"
#include "troffer/image.h"
#include "troffer/types.h"

namespace troffer {
struct Image;
struct Display;
}  // namespace troffer

namespace troffer::api {

inline Vec3d vec(const Point& p) {
  return {p[0], p[1], p[2]};
}
inline Point point(const Vec3d& v) {
  return {v.x, v.y, v.z};
}
inline Rgb rgb(const Color& c) {
  return {c[0], c[1], c[2]};
}
inline Color color(const Rgb& c) {
  return {c.r, c.g, c.b};
}
Affine affine(const Transform& t);

// The functions below throw UsageError for invalid values; `what` names the value in the message.

// Returns a value that lies between `least` and `most`.
double in_range(double value, double least, double most, const std::string& what);
// Returns a reflectance, with channels from 0 to 1.
Rgb share(const Color& c, const std::string& what);
// Returns an emission, with finite channels of at least 0.
Rgb emitted(const Color& c, const std::string& what);
// Returns a position, with coordinates of at most 1e9 m.
Vec3d place(const Point& p, const std::string& what);
// Returns the unit vector of a finite direction of length above 0.
Vec3d direction(const Point& p, const std::string& what);

// Returns a public image as the renderer's. Throws if its array does not have its size.
troffer::Image image_of(const Image& image);
// Without a given exposure, the brightness of `picture` decides.
Display display_of(const DisplayOptions& options, const troffer::Image& picture);

}  // namespace troffer::api
