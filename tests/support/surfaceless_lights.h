// Functions that add lights without a surface to a scene.
#pragma once

#include <string>
#include <utility>

#include "scene/scene.h"

namespace troffer::test {

inline Light& add_light(Scene& s, LightKind kind, Rgb radiance) {
  Light e;
  e.name = "emitter" + std::to_string(s.lights.size());
  e.kind = kind;
  e.radiance = radiance;
  s.lights.push_back(std::move(e));
  return s.lights.back();
}
inline void add_point(Scene& s, const Vec3& position, Rgb intensity) {
  add_light(s, LightKind::point, intensity).position = position;
}
inline void add_spot(Scene& s, const Vec3& position, const Vec3& direction, float cos_inner,
                     float cos_outer, Rgb intensity) {
  Light& e = add_light(s, LightKind::spot, intensity);
  e.position = position;
  e.direction = normalize(direction);
  e.cos_inner = cos_inner;
  e.cos_outer = cos_outer;
}
inline void add_distant(Scene& s, const Vec3& direction, Rgb irradiance) {
  add_light(s, LightKind::distant, irradiance).direction = normalize(direction);
}
inline void add_environment(Scene& s, Rgb radiance) {
  add_light(s, LightKind::environment, radiance);
}

}  // namespace troffer::test
