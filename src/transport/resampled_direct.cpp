#include "transport/resampled_direct.h"

#include <algorithm>
#include <cmath>

#include "base/ablation.h"
#include "base/random.h"
#include "base/simd.h"
#include "light/rectangle_receivers.h"
#include "transport/purposes.h"

namespace troffer {

namespace {

// With more lights, evaluating all of them costs more time than the lower noise saves: measured
// with 13 lights in a hall.
constexpr size_t fewest_lights = 2, most_lights = 8;

}  // namespace

bool ResampledDirect::suits(const PreparedScene& scene) {
  const std::vector<LightPrimitive>& all = scene.primitives.all();
  return !is_left_out<"resampled direct light">() && all.size() >= fewest_lights &&
         all.size() <= most_lights &&
         std::all_of(all.begin(), all.end(), [](const LightPrimitive& p) {
           return p.shape == PrimitiveShape::rectangle && !p.is_textured;
         });
}

void ResampledDirectScratch::resize(size_t n) {
  for (auto* a : {&x, &y, &z, &shading_x, &shading_y, &shading_z, &normal_x, &normal_y, &normal_z,
                  &both_sides, &own_pdf, &cosine, &inverse_pdf, &picked_u, &picked_v, &scales})
    a->resize(n);
  hits.resize(n);
  streams.resize(n);
  samples.resize(n);
  positions.resize(n);
  picked.resize(n);
  points.resize(n);
  is_valid.resize(n);
}

// Collects the hits that take part and their random numbers. All lights share two numbers per hit,
// so that points on each light are stratified over the samples of a pixel.
void ResampledDirect::begin(const WaveHits& wave, ResampledDirectScratch& s) const {
  s.resize(wave.size());
  size_t m = 0;
  for (uint32_t i = 0; i < wave.size(); ++i) {
    const Bsdf& bsdf = wave.bsdfs[i];
    if (is_purely_delta(bsdf) || (bsdf.is_lambertian && bsdf.diffuse.is_black())) continue;
    const Vertex& v = wave.vertices[i];
    s.hits[m] = i;
    s.streams[m] = wave.walks[i].stream;
    s.samples[m] = wave.walks[i].sample;
    s.positions[m] = v.surface.position;
    s.x[m] = v.surface.position.x;
    s.y[m] = v.surface.position.y;
    s.z[m] = v.surface.position.z;
    s.shading_x[m] = v.frame.normal.x;
    s.shading_y[m] = v.frame.normal.y;
    s.shading_z[m] = v.frame.normal.z;
    s.normal_x[m] = v.geometric_normal.x;
    s.normal_y[m] = v.geometric_normal.y;
    s.normal_z[m] = v.geometric_normal.z;
    s.both_sides[m] = bsdf.has_transmission ? 1.0f : 0.0f;
    s.own_pdf[m] = bsdf.is_lambertian ? inv_pi_f : 0;
    ++m;
  }
  s.resize(m);
  s.promises.resize(m * scene_.primitives.size());
  s.numbers.resize(3 * m);
  sobol_groups(s.streams.data(), s.samples.data(), m, purpose_light(wave.walks[0].vertex), 3,
               s.numbers.data());
}

namespace {

// Returns the unoccluded light of a point on a light, up to a factor that is common to all lights.
// It is exact for Lambertian surfaces, and others are treated as Lambertian. It is positive
// wherever light may arrive. own_pdf: density of the path's own direction / cosine.
TROFFER_ALWAYS_INLINE float promise(float radiance, float cosine, float both_sides,
                                    float inverse_pdf, float own_pdf) {
  const float c = std::max(cosine, -cosine * both_sides);
  const float ratio = own_pdf * c * inverse_pdf;  // ratio of the densities, for the power heuristic
  return radiance * c * inverse_pdf / (1 + ratio * ratio);
}

// The same for a point that sample() has chosen.
float promise(const Vertex& v, float both_sides, float own_pdf, const LightSample& light) {
  const float cosine = dot(light.wi, v.frame.normal);
  if (!(cosine * dot(light.wi, v.geometric_normal) > 0)) return 0;
  return promise(average(light.radiance), cosine, both_sides, 1 / light.pdf_solid_angle, own_pdf);
}

TROFFER_MULTIVERSION
void promises_of(size_t n, float radiance, const float* __restrict cosine,
                 const float* __restrict both_sides, const float* __restrict inverse_pdf,
                 const float* __restrict own_pdf, float* __restrict out) {
  for (size_t i = 0; i < n; ++i)
    out[i] =
        promise(radiance, cosine[i], both_sides[i], std::max(inverse_pdf[i], 0.0f), own_pdf[i]);
}

}  // namespace

// Computes the unoccluded light of one light's points at every hit.
void ResampledDirect::ask(const WaveHits& wave, uint32_t light, ResampledDirectScratch& s) const {
  const size_t m = s.hits.size();
  const LightPrimitive& p = scene_.primitives[light];
  const float *const u = s.numbers.data(), *const v = u + m;
  points_of_rectangle(
      p,
      {m, s.x.data(), s.y.data(), s.z.data(), s.shading_x.data(), s.shading_y.data(),
       s.shading_z.data(), s.normal_x.data(), s.normal_y.data(), s.normal_z.data()},
      u, v, s.cosine.data(), s.inverse_pdf.data());
  float* const out = s.promises.data() + light * m;
  promises_of(m, average(p.mean_radiance), s.cosine.data(), s.both_sides.data(),
              s.inverse_pdf.data(), s.own_pdf.data(), out);
  for (size_t k = 0; k < m; ++k) {
    if (s.inverse_pdf[k] >= 0) continue;
    LightSample point;
    if (sample(scene_.scene, p, s.positions[k], {u[k], v[k]}, point))
      out[k] = promise(wave.vertices[s.hits[k]], s.both_sides[k], s.own_pdf[k], point);
  }
}

// Picks one light for every hit, in proportion to the unoccluded light of its point. Drops hits
// that receive none.
void ResampledDirect::pick(ResampledDirectScratch& s) const {
  const size_t m = s.hits.size(), lights = scene_.primitives.size();
  size_t kept = 0;
  for (size_t k = 0; k < m; ++k) {
    float sum = 0;
    for (size_t i = 0; i < lights; ++i) sum += s.promises[i * m + k];
    if (!(sum > 0) || !std::isfinite(sum)) continue;
    float left = s.numbers[2 * m + k] * sum;
    size_t picked = 0;
    for (size_t i = 0; i < lights; ++i) {
      const float promised = s.promises[i * m + k];
      if (!(promised > 0)) continue;
      picked = i;
      if (left < promised) break;
      left -= promised;
    }
    s.hits[kept] = s.hits[k];
    s.positions[kept] = s.positions[k];
    s.picked[kept] = uint32_t(picked);
    s.picked_u[kept] = s.numbers[k];
    s.picked_v[kept] = s.numbers[m + k];
    s.scales[kept] = sum / s.promises[picked * m + k];
    ++kept;
  }
  s.hits.resize(kept);
}

void ResampledDirect::connect_picked(const WaveHits& wave, ResampledDirectScratch& s) const {
  const size_t m = s.hits.size();
  sample_many(scene_.scene, scene_.primitives, m, s.picked.data(), s.positions.data(),
              s.picked_u.data(), s.picked_v.data(), s.points.data(), s.is_valid.data(),
              s.light_samples);
  for (size_t k = 0; k < m; ++k) {
    if (s.is_valid[k] == 0) continue;
    const uint32_t i = s.hits[k];
    LightConnection c;
    if (!connect(wave.vertices[i], wave.bsdfs[i], s.points[k], c)) continue;
    const float scale = s.scales[k] * power_heuristic(c.pdf_light, c.pdf_bsdf) / c.pdf_light;
    const Walk& walk = wave.walks[i];
    s.shadows.add(c.shadow_ray, walk.throughput * c.value * scale, walk.index, is_direct_at(walk));
  }
}

void ResampledDirect::add(const WaveHits& wave, ResampledDirectScratch& s, RadianceBatch& out,
                          Counters& counters) const {
  if (wave.size() == 0) return;
  begin(wave, s);
  for (uint32_t i = 0; i < scene_.primitives.size(); ++i) ask(wave, i, s);
  pick(s);
  connect_picked(wave, s);
  s.shadows.resolve(scene_.tracer, Coherence::coherent, out, counters);
}

float ResampledDirect::weight_of(const Walk& walk, const Vertex& v) const {
  const int32_t primitive = primitive_at(scene_, v.surface);
  if (primitive < 0) return 1;
  return power_heuristic(walk.pdf, pdf_of_hit(scene_, scene_.primitives[size_t(primitive)],
                                              walk.last_position, walk.ray.direction, v));
}

}  // namespace troffer
