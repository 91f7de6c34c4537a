#include "light/light.h"

#include <limits>

#include "light/distant_light.h"
#include "light/environment_light.h"
#include "light/point_light.h"
#include "light/portal.h"
#include "light/sky_light.h"
#include "light/spot_light.h"
#include "light/sun_light.h"
#include "light/surface_light.h"

namespace troffer {

namespace {

// Calls `ask` with the struct that implements a kind. No other function depends on the list of
// kinds.
template <class Ask>
decltype(auto) ask_kind(LightKind kind, const Ask& ask) {
  switch (kind) {
    case LightKind::point:
      return ask(PointEmitter());
    case LightKind::spot:
      return ask(SpotLight());
    case LightKind::distant:
      return ask(DistantLight());
    case LightKind::environment:
      return ask(EnvironmentLight());
    case LightKind::sky:
      return ask(SkyLight());
    case LightKind::sun:
      return ask(SunLight());
    case LightKind::polygon:
    case LightKind::disk:
    case LightKind::sphere:
    case LightKind::mesh:
      break;
  }
  return ask(SurfaceLight());
}

// A sun's disc is too small for the portal's table, so the sun is sampled by its own method.
bool is_drawn_through_portal(const Scene& scene, const LightPrimitive& p) {
  return p.portal != nullptr && scene.lights[p.light].kind != LightKind::sun;
}

bool sample_through_portal(const Scene& scene, const LightPrimitive& p, const Vec3& x,
                           const Vec2& u, LightSample& out) {
  out = {};
  if (!p.portal->sample(x, u, out.wi, out.pdf_solid_angle)) return false;
  out.distance = std::numeric_limits<float>::infinity();
  out.radiance = radiance_beyond(scene, scene.lights[p.light], out.wi);
  return true;
}

}  // namespace

Rgb radiance_beyond(const Scene& scene, const Light& light, const Vec3& wi) {
  return ask_kind(light.kind,
                  [&](auto kind) { return kind.radiance_at_infinity(scene, light, wi); });
}

bool sample(const Scene& scene, const LightPrimitive& p, const Vec3& x, const Vec2& u,
            LightSample& out) {
  if (is_drawn_through_portal(scene, p)) return sample_through_portal(scene, p, x, u, out);
  return ask_kind(scene.lights[p.light].kind,
                  [&](auto kind) { return kind.sample(scene, p, x, u, out); }) &&
         (p.portal == nullptr || p.portal->shows(x, out.wi));
}

void sample_many(const Scene& scene, const LightPrimitives& all, size_t n,
                 const uint32_t* primitives, const Vec3* receivers, const float* u, const float* v,
                 LightSample* out, uint8_t* is_valid, LightSampleScratch& scratch) {
  sample_many(all, n, primitives, receivers, u, v, out, is_valid, scratch);
  for (size_t i = 0; i < n; ++i) {
    const LightPrimitive& p = all[primitives[i]];
    if (!p.has_surface())
      is_valid[i] = sample(scene, p, receivers[i], {u[i], v[i]}, out[i]);
    else if (is_valid[i] != 0)
      SurfaceLight::finish(scene, p, out[i]);
  }
}

float pdf_solid_angle(const Scene& scene, const LightPrimitive& p, const Vec3& x, const Vec3& wi,
                      float distance) {
  if (is_drawn_through_portal(scene, p)) return p.portal->pdf(x, wi);
  return ask_kind(scene.lights[p.light].kind,
                  [&](auto kind) { return kind.pdf_solid_angle(scene, p, x, wi, distance); });
}

bool has_square_of_direction(const Scene& scene, const LightPrimitive& p) {
  const LightKind kind = scene.lights[p.light].kind;
  return p.portal == nullptr && (kind == LightKind::environment || kind == LightKind::sky);
}

Vec2 square_of_direction(const Scene& scene, const LightPrimitive& p, const Vec3& wi) {
  return ask_kind(scene.lights[p.light].kind,
                  [&](auto kind) { return kind.square_of_direction(scene, p, wi); });
}

Rgb emitted_radiance(const Scene& scene, const Light& light, bool is_front, const TexturePlace& uv,
                     const Vec3& towards) {
  return ask_kind(light.kind,
                  [&](auto kind) { return kind.emitted(scene, light, is_front, uv, towards); });
}

Rgb radiance_at_infinity(const Scene& scene, const LightPrimitive& p, const Vec3& x,
                         const Vec3& wi) {
  if (p.portal != nullptr && !p.portal->shows(x, wi)) return Rgb{0};
  return radiance_beyond(scene, scene.lights[p.light], wi);
}

std::unique_ptr<const DirectionTable> make_directions(const Scene& scene, const Light& light) {
  return ask_kind(light.kind, [&](auto kind) { return kind.directions(scene, light); });
}

LightPrimitive make_piece(const Scene& scene, const Light& light, const Box& scene_bounds,
                          const DirectionTable* directions) {
  LightPrimitive p;
  p.directions = directions;
  ask_kind(light.kind, [&](auto kind) { kind.bound(scene, light, scene_bounds, p); });
  return p;
}

CertificateShape certificate_shape(const Scene& scene, const Light& light) {
  return ask_kind(light.kind, [&](auto kind) { return kind.certificate(scene, light); });
}

// The table has several cells per texel, since the image is bilinear between texel centres. Skies
// and uniform lights are smooth, so the least size does.
std::unique_ptr<const Portal> make_portal(const Scene& scene, const Light& light,
                                          const LightPrimitive& p) {
  constexpr int least = 64, most = 1024;
  if (light.portal.size() != 4 || !p.is_infinite() || is_delta(light.kind)) return nullptr;
  int n = least;
  if (light.environment != no_environment) {
    const int height = scene.environments[size_t(light.environment)].height;
    while (n < std::min(4 * height, most)) n *= 2;
  }
  return std::make_unique<const Portal>(light.portal, n, [&](const Vec3& wi) {
    return luminance(radiance_beyond(scene, light, wi));
  });
}

}  // namespace troffer
