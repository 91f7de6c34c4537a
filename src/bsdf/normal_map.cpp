#include "base/frame.h"
#include "bsdf/bsdf.h"

namespace troffer {

Frame perturbed_frame(const Frame& frame, Rgb texel, float scale) {
  const Vec3 n{(2 * texel.r - 1) * scale, (2 * texel.g - 1) * scale, 2 * texel.b - 1};
  const float len2 = length_squared(n);
  if (!(len2 > 1e-12f && len2 < 1e12f)) return frame;
  const Vec3 normal = normalize(frame.to_world(n));
  const Vec3 tangent = frame.tangent - normal * dot(normal, frame.tangent);
  if (!(length_squared(tangent) > 1e-12f) || !is_finite(normal)) return frame;
  const Vec3 t = normalize(tangent);
  const bool is_right_handed = dot(cross(frame.normal, frame.tangent), frame.bitangent) > 0;
  const Vec3 b = cross(normal, t);
  return {t, is_right_handed ? b : -b, normal};
}

}  // namespace troffer
