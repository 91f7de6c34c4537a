#include "transport/source_sampler.h"

#include <algorithm>
#include <numeric>

#include "base/random.h"
#include "transport/purposes.h"

namespace troffer {

namespace {

// Numbers of shadow rays that are traced together.
constexpr size_t shadow_batch = 8192;
constexpr size_t matte_batch = 2048;  // fits the second-level cache

// Sorts the numbers of a Sobol block. A block of 2^k numbers has one number in each of its 2^k
// equal intervals, so a bucket per interval suffices.
void sort_numbers(const float* numbers, uint32_t n, std::vector<uint32_t>& order) {
  order.resize(n);
  if (std::has_single_bit(n)) {
    for (uint32_t i = 0; i < n; ++i) order[uint32_t(numbers[i] * float(n))] = i;
    return;
  }
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return numbers[a] < numbers[b] || (numbers[a] == numbers[b] && a < b);
  });
}

}  // namespace

void SourceSamplerScratch::resize(size_t n) {
  primitives.resize(n);
  numbers.resize(3 * n);
  pmfs.resize(n);
  u.resize(n);
  v.resize(n);
  points.resize(n);
  is_valid.resize(n);
  choices.resize(n);
}

const SobolBlocks& SourceSamplerScratch::blocks_of(uint32_t n) {
  if (n == 1) return single;
  if (blocks.size() != n) blocks = SobolBlocks(n);
  return blocks;
}

SourceSampler::SourceSampler(const PreparedScene& scene) : scene_(scene) {
  for (uint32_t e = 0; e < scene.scene.lights.size(); ++e) {
    trees_.emplace_back(scene.primitives, scene.primitives.of_light(e));
    is_delta_.push_back(is_delta(scene.scene.lights[e].kind));
    const LightPrimitives::Range pieces = scene.primitives.of_light(e);
    bool is_even = pieces.first < pieces.last;
    for (uint32_t p = pieces.first; p < pieces.last; ++p)
      is_even &= scene.primitives[p].has_surface() && !scene.primitives[p].is_textured;
    is_even_.push_back(is_even);
  }
}

// Chooses a piece of the light for each of the next n samples of the pixel, and the random numbers
// of a point on it. Sets s.primitives, s.pmfs, s.u and s.v. Leaves out samples without a piece and
// returns the number of the others. Neighbouring entries have neighbouring pieces.
uint32_t SourceSampler::choose_pieces(const SampledVertex& at, uint32_t light, uint32_t n,
                                      SourceSamplerScratch& s) const {
  const LightPrimitives::Range pieces = scene_.primitives.of_light(light);
  const bool is_one = pieces.last - pieces.first == 1;
  s.resize(n);
  // The stream depends on n, so that pictures with different numbers of rays err independently.
  const uint64_t stream = hash_combine(hash_combine(at.walk.stream, light + 1), n);
  s.blocks_of(n).draw(stream, purpose_light(at.walk.vertex), at.walk.sample, is_one ? 2 : 3,
                      s.numbers.data());
  if (is_one) {
    std::fill_n(s.primitives.begin(), n, pieces.first);
    std::fill_n(s.pmfs.begin(), n, 1.0f);
    std::copy_n(s.numbers.begin(), n, s.u.begin());
    std::copy_n(s.numbers.begin() + n, n, s.v.begin());
    return n;
  }
  const float* pick = s.numbers.data() + 2 * size_t(n);
  sort_numbers(pick, n, s.order);
  for (uint32_t i = 0; i < n; ++i) s.u[i] = pick[s.order[i]];
  trees_[light].choose_sorted(at.vertex.surface.position, at.vertex.geometric_normal,
                              at.has_transmission, s.u.data(), n, s.choices.data());
  uint32_t chosen = 0;
  for (uint32_t i = 0; i < n; ++i) {
    const LightChoice& choice = s.choices[i];
    if (choice.pmf == 0) continue;  // none of these primitives can send light here
    s.primitives[chosen] = choice.primitive;
    s.pmfs[chosen] = choice.pmf;
    s.u[chosen] = s.numbers[s.order[i]];
    s.v[chosen] = s.numbers[n + s.order[i]];
    ++chosen;
  }
  return chosen;
}

// Samples points on the light and returns their number.
uint32_t SourceSampler::choose_points(const SampledVertex& at, uint32_t light, uint32_t n,
                                      SourceSamplerScratch& s) const {
  const uint32_t chosen = choose_pieces(at, light, n, s);
  s.receivers.assign(chosen, at.vertex.surface.position);
  sample_many(scene_.scene, scene_.primitives, chosen, s.primitives.data(), s.receivers.data(),
              s.u.data(), s.v.data(), s.points.data(), s.is_valid.data(), s.lights);
  return chosen;
}

// True if a ray's light is a constant times a cosine over a density. The light must have uniform
// radiance, the surface must be Lambertian, and no BSDF sample may compete.
bool SourceSampler::is_matte(const SampledVertex& at, uint32_t light) const {
  return is_even_[light] && at.competing == nullptr && at.alone != nullptr &&
         is_lambertian(*at.alone, nullptr);
}

// The same as choose_points() for is_matte(): sets s.matte_points. Returns false if no point can
// send light.
bool SourceSampler::choose_matte_points(const SampledVertex& at, uint32_t light, uint32_t n,
                                        SourceSamplerScratch& s) const {
  const Vec3& x = at.vertex.surface.position;
  const LightPrimitives::Range pieces = scene_.primitives.of_light(light);
  const LightPrimitive& first = scene_.primitives[pieces.first];
  const bool is_one = pieces.last - pieces.first == 1;
  if (is_one && is_below_horizon(first, x, at.vertex.geometric_normal)) return false;
  const uint32_t chosen = choose_pieces(at, light, n, s);
  if (is_one) return sample_points(first, x, chosen, s.u.data(), s.v.data(), s.matte_points);
  s.matte_points.resize(chosen);
  for (uint32_t i = 0; i < chosen; ++i) {
    sample_point(scene_.primitives[s.primitives[i]], x, s.u[i], s.v[i], i, s.matte_points);
    s.matte_points.inverse_pdf[i] /= s.pmfs[i];
  }
  return chosen > 0;
}

void SourceSampler::sample_matte(const SampledVertex& at, uint32_t light, uint32_t n,
                                 SourceSamplerScratch& s) const {
  const Vertex& v = at.vertex;
  if (!(v.wo.z > 0)) return;
  if (!choose_matte_points(at, light, n, s)) return;
  const Rgb radiance = scene_.primitives[scene_.primitives.of_light(light).first].mean_radiance;
  const MatteReceiver receiver{v.surface.position, v.geometric_normal, v.frame.to_world({0, 0, 1}),
                               offset_origin(v.surface, v.geometric_normal)};
  s.matte.add(receiver, s.matte_points,
              {at.walk.index, n, at.walk.throughput * at.alone->diffuse * inv_pi_f * radiance,
               at.is_direct});
}

void SourceSampler::sample(const SampledVertex& at, uint32_t light, uint32_t n,
                           SourceSamplerScratch& s, RadianceBatch& out, Counters& counters) const {
  if (is_matte(at, light)) {
    sample_matte(at, light, n, s);
    if (s.matte.size() >= matte_batch) s.matte.resolve(scene_.tracer, out, counters);
    return;
  }
  if (is_delta_[light]) n = 1;  // a delta light has only one point
  const uint32_t chosen = choose_points(at, light, n, s);
  for (uint32_t j = 0; j < chosen; ++j) {
    if (s.is_valid[j] == 0) continue;
    LightConnection c;
    Rgb carried;
    bool is_connected = false;
    if (at.alone != nullptr && connect(at.vertex, *at.alone, s.points[j], c)) {
      const float pdf_light = c.pdf_light * s.pmfs[j] * float(n);
      carried += at.walk.throughput * c.value * (1 / pdf_light);
      is_connected = true;
    }
    if (at.competing != nullptr && connect(at.vertex, *at.competing, s.points[j], c)) {
      const float pdf_light = c.pdf_light * s.pmfs[j] * float(n);
      const float weight = power_heuristic(pdf_light, c.pdf_bsdf);
      carried += at.walk.throughput * c.value * (weight / pdf_light);
      is_connected = true;
    }
    if (is_connected) s.shadows.add(c.shadow_ray, carried, at.walk.index, at.is_direct);
  }
  s.shadows.end_group(n);
  // Rays from one vertex to one source are adjacent, so ray packets pay off.
  if (s.shadows.rays.size() >= shadow_batch) resolve(s, out, counters);
}

void SourceSampler::resolve(SourceSamplerScratch& s, RadianceBatch& out, Counters& counters) const {
  s.shadows.resolve(scene_.tracer, Coherence::coherent, out, counters);
  s.matte.resolve(scene_.tracer, out, counters);
}

float SourceSampler::emission_weight(const Walk& walk, const Vertex& v, uint32_t n) const {
  const int32_t primitive = walk.pdf > 0 ? primitive_at(scene_, v.surface) : no_primitive;
  if (primitive < 0) return 1;
  return troffer::emission_weight(scene_, trees_[size_t(v.surface.light)], walk, v,
                                  uint32_t(primitive), float(n));
}

}  // namespace troffer
