// The façade's plain types as those of the rooms, and checks of what programs hand over.
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

// All of these throw UsageError; `what` names the value in the message.

// The value, which must lie between two others.
double in_range(double value, double least, double most, const std::string& what);
// A colour of reflectance: channels from 0 to 1.
Rgb share(const Color& c, const std::string& what);
// Emission: channels of at least 0, finite.
Rgb emitted(const Color& c, const std::string& what);
// A place whose coordinates are finite and below 1e9 m.
Vec3d place(const Point& p, const std::string& what);
// A unit vector along a direction, which must have a length.
Vec3d direction(const Point& p, const std::string& what);

// Pixels in the rooms' form.
troffer::Image image_of(const Image& image);
// `picture` decides about the exposure where none is given.
Display display_of(const DisplayOptions& options, const troffer::Image& picture);

}  // namespace troffer::api
