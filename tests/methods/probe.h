// Traces single rays through an integrator many times, and returns the spread of the results.
#pragma once

#include <cstdint>

#include "base/random.h"
#include "certified/certified_direct.h"
#include "methods/path.h"
#include "support/chi_square.h"
#include "support/light_scenes.h"
#include "support/scenes.h"
#include "support/statistics.h"
#include "transport/fixed_direct.h"
#include "transport/wave_integrator.h"

namespace troffer::test {

inline WaveIntegrator fixed_integrator(const PreparedScene& scene, int shadow_rays) {
  return {scene, std::make_unique<FixedDirect>(scene, shadow_rays), nullptr};
}

inline WaveIntegrator certified_integrator(const PreparedScene& scene, double error = 0.01) {
  const CertifiedSettings settings = certified_settings(error, scene.scene.lights.size());
  const auto occluders = std::make_shared<const Occluders>(scene.scene);
  return {scene, std::make_unique<CertifiedDirect>(scene, occluders, settings), nullptr};
}

struct Probed {
  Moments direct, indirect, total;  // of the green channel
  uint64_t shadow_rays = 0;
};

inline Ray ray_towards(const Vec3& from, const Vec3& to) {
  Ray r;
  r.origin = from;
  r.direction = normalize(to - from);
  return r;
}

inline ViewingRays repeated(const Ray& ray, uint64_t stream, uint32_t samples) {
  ViewingRays rays;
  rays.rays.assign(samples, ray);
  rays.streams.assign(samples, stream);
  for (uint32_t s = 0; s < samples; ++s) rays.samples.push_back(s);
  return rays;
}

// Traces `sets` independently scrambled sets of `samples` rays each. The mean of a set is one
// value.
inline Probed probe(const Integrator& integrator, const Ray& ray, uint32_t samples, int sets,
                    uint64_t seed = 0, uint32_t effort_divisor = 1, float typical = 0) {
  Probed out;
  const auto scratch = integrator.make_scratch();
  RadianceBatch batch;
  Counters counters;
  for (int s = 0; s < sets; ++s) {
    ViewingRays rays = repeated(ray, hash_of(seed, uint64_t(s)), samples);
    rays.request.effort_divisor = effort_divisor;
    rays.request.typical_luminance = typical;
    rays.request.is_picture = typical > 0;
    batch.reset(rays.size());
    integrator.radiance(rays, *scratch, batch, counters);
    double direct = 0, indirect = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      direct += double(batch.direct[i].g) / samples;
      indirect += double(batch.indirect[i].g) / samples;
    }
    out.direct.add(direct);
    out.indirect.add(indirect);
    out.total.add(direct + indirect);
  }
  out.shadow_rays = counters.shadow_rays;
  return out;
}

inline uint32_t add_metal(Scene& s, float roughness) {
  Material m;
  m.kind = MaterialKind::conductor;
  m.is_reflectance = true;
  m.base_color.value = Rgb{1};
  m.roughness.value = roughness;
  return add_material(s, m);
}
inline uint32_t add_mirror(Scene& s) {
  return add_metal(s, 0);
}

inline uint32_t add_glass(Scene& s, bool is_thin, float roughness = 0) {
  Material m;
  m.kind = MaterialKind::dielectric;
  m.base_color.value = Rgb{1};
  m.ior = 1.5f;
  m.is_thin = is_thin;
  m.roughness.value = roughness;
  return add_material(s, m);
}

// Adds a closed box with its front outside.
inline void add_block(Scene& s, uint32_t material, const Vec3& a, const Vec3& b) {
  for (const uint32_t quad : add_box_inside(s, material, a, b))
    for (Triangle& t : s.meshes[quad].triangles) std::swap(t[1], t[2]);
}

}  // namespace troffer::test
