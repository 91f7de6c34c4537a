#include "gather/cells_indirect.h"

#include <algorithm>

#include "base/error.h"
#include "base/random.h"
#include "base/streams.h"
#include "gather/gather_lobe.h"
#include "gather/sensor_distributions.h"

namespace troffer {

namespace {

// Limits of gather rays at a hit; the last holds for further viewing rays of a pixel.
constexpr uint32_t least_rays = 4, most_rays = 64, most_further_rays = 16;
// Viewing rays that every pixel has.
constexpr uint32_t first_samples = 4;

// Returns the number of gather rays of a hit, a power of two. The first samples of a pixel share
// what it wants equally. Sample s of further ones gets wanted / (2 s + 1). The sum of 1 / rays is
// then n² / wanted for every final number n, so the mean over samples has the noise of `wanted`
// rays. A hit costs as much as many rays, so the number has a lower limit, unless the pixel asks
// for an effort divisor above 1.
uint32_t rays_of_hit(float wanted, uint32_t sample, uint32_t effort_divisor) {
  const auto as_wanted = [&](float hits, uint32_t most) {
    uint32_t n = least_rays;
    while (n < most && float(n) * hits < wanted) n *= 2;
    return n;
  };
  if (sample < first_samples) return as_wanted(first_samples, most_rays);
  if (effort_divisor > 1) return std::max(most_further_rays / effort_divisor, 1u);
  return std::max(as_wanted(first_samples, most_further_rays),
                  as_wanted(float(2 * sample + 1), most_rays));
}

// Number of gather rays of a hit, and their random numbers.
struct GatherNumbers {
  uint32_t rays, first;
  uint64_t stream;
};

// Returns the gather rays of a hit. The first samples of a pixel continue one Sobol sequence from
// sample to sample; so do samples with an effort divisor above 1, in a stream of their own.
GatherNumbers numbers_of_hit(float wanted, const Walk& at, uint32_t effort_divisor) {
  const bool is_first = at.sample < first_samples;
  if (is_first) effort_divisor = 1;
  const uint32_t rays = rays_of_hit(wanted, at.sample, effort_divisor);
  return {rays, at.sample * (is_first || effort_divisor > 1 ? rays : most_rays),
          effort_divisor > 1 ? hash_combine(at.stream, stream::reduced_gather_rays + effort_divisor)
                             : at.stream};
}

}  // namespace

struct CellsIndirect::Scratch final : IndirectLightScratch {
  SampleRequest request;  // request of the current batch
  CellsScratch cells;
  // Per hit whose rays are in cells.walks: index of its viewing ray, and end of its rays.
  std::vector<uint32_t> indices, ends;
  // Per gather ray: factor from its irradiance to the radiance of the viewing ray.
  std::vector<Rgb> weights;
  SensorDistributions aims;
  GatherRecords::CachedDistribution aim;
  void clear() {
    cells.walks.clear();
    indices.clear();
    ends.clear();
    weights.clear();
  }
};

std::unique_ptr<IndirectLightScratch> CellsIndirect::make_scratch() const {
  return std::make_unique<Scratch>();
}

namespace {

// Factors of light that a hit sends on: of irradiance, and of the mean radiance that its gloss
// shows.
struct Weights {
  Rgb matte, gloss;
};

Weights weights_of(const Walk& at, const Vertex& v, const SurfaceScattering& scattering) {
  if (!scattering.is_gathered)
    return {at.throughput * albedo(scattering.diffuse, v.wo.z) * inv_pi_f, {}};
  const Rgb gloss = albedo(scattering.specular, v.wo.z);
  const Rgb rest = albedo(scattering.whole, v.wo.z) - gloss;
  const Rgb matte{std::max(rest.r, 0.0f), std::max(rest.g, 0.0f), std::max(rest.b, 0.0f)};
  return {at.throughput * matte * inv_pi_f, at.throughput * gloss};
}

uint32_t gloss_of(const Vertex& v, const SurfaceScattering& scattering) {
  return scattering.is_gathered ? v.surface.material : GlossPlace::no_material;
}

}  // namespace

void CellsIndirect::begin(const SampleRequest& request, IndirectLightScratch& scratch) const {
  static_cast<Scratch&>(scratch).request = request;
}

void CellsIndirect::queue(WaveHits& wave, IndirectLightScratch& scratch, RadianceBatch& out,
                          Counters&) const {
  auto& s = static_cast<Scratch&>(scratch);
  out.enable_shared_error();
  static const GatherDistribution by_cosine;
  CheckItems items;
  for (size_t i = 0; i < wave.size(); ++i) {
    const SurfaceScattering& scattering = wave.scatterings[i];
    if (!scattering.has_diffuse) continue;
    const Walk& at = wave.walks[i];
    items.at(at.index);
    const Vertex& v = wave.vertices[i];
    const Weights weights = weights_of(at, v, scattering);
    const CellHit hit = cell_hit_of(v, scattering.diffuse);
    Rgb irradiance;
    float half_difference = 0;
    if (at.scatterings > 0 && cells_->indirect_at(hit, wave.hits[i].t * length(at.ray.direction),
                                                  irradiance, half_difference)) {
      out.indirect[at.index] += weights.matte * irradiance;
      out.drawn_error[at.index] += luminance(weights.matte) * half_difference;
      continue;
    }
    FittedRecord fitted;
    const GatherDistribution* aim = &by_cosine;
    if (at.scatterings == 0 && records_ && !wave.viewing->pixels.empty()) {
      const PixelAt& pixel = wave.viewing->pixels[at.index];
      if (records_->irradiance_at(pixel.x, pixel.y, hit, gloss_of(v, scattering), false, fitted)) {
        const Rgb light = weights.matte * fitted.irradiance + weights.gloss * fitted.gloss;
        out.indirect[at.index] += light;
        out.luminance_with_error[at.index] += luminance(light);
        out.shared_error[at.index] +=
            luminance(weights.matte) * fitted.error + luminance(weights.gloss) * fitted.gloss_error;
        continue;
      }
      records_->irradiance_at(pixel.x, pixel.y, hit, gloss_of(v, scattering), true, fitted);
      aim = &records_->aim_at(pixel.x, pixel.y, hit, cells_->lit_regions(), s.aim);
    }
    const Bsdf& all = scattering.is_gathered ? scattering.whole : scattering.diffuse;
    GatherLobe lobe;
    if (scattering.is_gathered)
      lobe = {scattering.specular, v.frame.normal, v.wo, luminance(weights.matte) * pi_f,
              luminance(weights.gloss)};
    const GatherNumbers numbers = numbers_of_hit(fitted.rays, at, s.request.effort_divisor);
    for (uint32_t k = 0; k < numbers.rays; ++k) {
      Walk walk = at;
      walk.throughput = Rgb{1};
      walk.index = uint32_t(s.weights.size());
      walk.stream = numbers.stream;
      walk.sample = numbers.first + k;
      set_out(hit, *aim, lobe, walk);
      const Vec3 wi = v.frame.to_local(walk.ray.direction);
      s.weights.push_back(wi.z > 0 ? at.throughput * evaluate(all, v.wo, wi) * (1 / wi.z) : Rgb{0});
      if (!walk.throughput.is_black()) s.cells.walks.push_back(walk);
    }
    s.indices.push_back(at.index);
    s.ends.push_back(uint32_t(s.weights.size()));
  }
}

// Adds what first hits reflect according to the pixel's records and to cells.
void CellsIndirect::know(const WaveHits& wave, RadianceBatch& out) const {
  if (!records_) return;
  CheckItems items;
  for (size_t i = 0; i < wave.size(); ++i) {
    const SurfaceScattering& scattering = wave.scatterings[i];
    const Walk& at = wave.walks[i];
    if (!scattering.has_diffuse || at.vertex > 0) continue;
    items.at(at.index);
    const Vertex& v = wave.vertices[i];
    const Weights weights = weights_of(at, v, scattering);
    const CellHit hit = cell_hit_of(v, scattering.diffuse);
    const CellLightAt cell = cells_->light_at(hit);
    const PixelAt& pixel = wave.viewing->pixels[at.index];
    FittedRecord fitted;
    const bool is_fitted =
        records_->irradiance_at(pixel.x, pixel.y, hit, gloss_of(v, scattering), true, fitted);
    // Gloss is taken to show as much as a matte surface of its reflectance would.
    const Rgb evenly = weights.matte + weights.gloss * inv_pi_f;
    out.known[at.index].direct += evenly * cell.direct;
    out.known[at.index].indirect +=
        is_fitted ? weights.matte * fitted.irradiance + weights.gloss * fitted.gloss
                  : evenly * cell.indirect;
  }
}

void CellsIndirect::flush(IndirectLightScratch& scratch, RadianceBatch& out,
                          Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  cells_->gather(s.weights.size(), s.cells, counters);
  size_t first = 0;
  for (size_t i = 0; i < s.indices.size(); ++i) {
    Rgb sum;
    float squares = 0, halves = 0;
    for (size_t k = first; k < s.ends[i]; ++k) {
      const Rgb light = s.weights[k] * s.cells.light.irradiance[k];
      sum += light;
      squares += sqr(luminance(light));
      halves += luminance(s.weights[k]) * s.cells.light.half_difference[k];
    }
    const auto n = float(s.ends[i] - first);
    first = s.ends[i];
    out.indirect[s.indices[i]] += sum * (1 / n);
    out.luminance_with_error[s.indices[i]] += luminance(sum) / n;
    out.drawn_error[s.indices[i]] += halves / n;
    if (out.direct_variance.empty()) continue;
    // A single ray has no spread: its variance is taken to be half of its square.
    const float mean = luminance(sum) / n;
    const float variance =
        n > 1 ? std::max(squares / n - sqr(mean), 0.0f) / (n - 1) : 0.5f * squares;
    out.direct_variance[s.indices[i]] += variance;
  }
  s.clear();
}

void CellsIndirect::gather(const SensorBatch& sensors, IndirectLightScratch& scratch,
                           RadianceBatch& out, Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  s.clear();
  s.aims.begin(cells_->lit_regions(), sensors);
  for (uint32_t i = 0; i < sensors.size(); ++i) {
    Walk walk = sensor_walk(sensors, i);
    const CellHit at = hit_of(sensors, i);
    float counts = 1;
    set_out(at, s.aims.at(i).direction(at, direction_number(walk), counts), walk);
    walk.throughput *= counts;
    if (!walk.throughput.is_black()) s.cells.walks.push_back(walk);
  }
  cells_->gather(sensors.size(), s.cells, counters);
  for (uint32_t i = 0; i < sensors.size(); ++i) out.indirect[i] += s.cells.light.irradiance[i];
  out.noise = s.cells.light.noise;
}

}  // namespace troffer
