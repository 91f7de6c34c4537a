#include "annual/sensor_hours.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/simd.h"
#include "base/units.h"

namespace troffer {

namespace {

constexpr int cosine_points = 4;  // per side of a patch, for the mean cosine on a tilted sensor

// Hours added up together: floats of one cache line. Sums of all replicates stay in registers.
constexpr size_t lanes = 16;
using HourLanes [[gnu::vector_size(lanes * sizeof(float))]] = float;

// out[r × stride + i] = Σ of all terms: coefficients[r] × luminance[first + i]
TROFFER_MULTIVERSION
void sum_terms(const LightTerm* terms, size_t n, size_t first, size_t count, float* out,
               size_t stride) {
  size_t done = 0;
  for (; done + lanes <= count; done += lanes) {
    HourLanes sums[replicate_count] = {};
    for (size_t t = 0; t < n; ++t) {
      HourLanes v;
      std::memcpy(&v, terms[t].luminance + first + done, sizeof v);
      for (size_t r = 0; r < replicate_count; ++r) sums[r] += terms[t].coefficients[r] * v;
    }
    for (size_t r = 0; r < replicate_count; ++r)
      std::memcpy(out + r * stride + done, &sums[r], sizeof sums[r]);
  }
  for (; done < count; ++done)
    for (size_t r = 0; r < replicate_count; ++r) {
      float sum = 0;
      for (size_t t = 0; t < n; ++t)
        sum += terms[t].coefficients[r] * terms[t].luminance[first + done];
      out[r * stride + done] = sum;
    }
}

}  // namespace

SensorHours::SensorHours(const YearOfLight& light, size_t sensor, const CellHit& place,
                         const DirectRays& rays, std::span<const float> open)
    : light_(light), sensor_(sensor), place_(place) {
  add_sky(rays, open);
  add_ground(rays, open);
  add_sun(rays, open);
  add_reflected_sky(sensor);
}

void SensorHours::add(const float* luminance,
                      const std::array<float, replicate_count>& coefficients) {
  const auto is_zero = [](float c) { return c == 0; };
  if (!std::all_of(coefficients.begin(), coefficients.end(), is_zero))
    terms_.push_back({luminance, coefficients});
}

// Integral of the cosine over a patch.
double SensorHours::cosine_over(const ReinhartPatch& p) const {
  const Vec3 up(light_.outside.compass.up);
  if (length_squared(place_.normal - up) < 1e-10f) return p.cosine;
  double sum = 0;
  for (int y = 0; y < cosine_points; ++y)
    for (int x = 0; x < cosine_points; ++x) {
      const Vec3d d = p.direction((x + 0.5) / cosine_points, (y + 0.5) / cosine_points);
      sum += std::max(0.0, double(dot(light_.outside.world(d), place_.normal)));
    }
  return sum * p.solid_angle / (cosine_points * cosine_points);
}

// A patch that all rays see unhindered brings its exact share.
void SensorHours::add_sky(const DirectRays& rays, std::span<const float> open) {
  const PatchHours& fine = light_.outside.skies.fine;
  const size_t n = rays.strata() * replicate_count;
  for (size_t p = 0; p < fine.sky.size(); ++p) {
    const std::span<const float> of_patch = open.subspan(p * n, n);
    if (std::all_of(of_patch.begin(), of_patch.end(), [](float o) { return o == 0; })) continue;
    const ReinhartPatch& patch = fine.sky.patches()[p];
    std::array<float, replicate_count> c{};
    if (std::all_of(of_patch.begin(), of_patch.end(), [](float o) { return o > 0.99999f; }))
      c.fill(float(cosine_over(patch)));
    else
      for (size_t i = 0; i < n; ++i)
        c[i % replicate_count] +=
            of_patch[i] * rays.cosine(p * n + i) * float(patch.solid_angle / double(rays.strata()));
    add(fine.of(p, light_.outside.skies.hours()).data(), c);
  }
}

void SensorHours::add_ground(const DirectRays& rays, std::span<const float> open) {
  const YearSkies& skies = light_.outside.skies;
  std::array<float, replicate_count> sum{};
  size_t ray = rays.first_of_ground();
  for (const ReinhartPatch& p : skies.coarse.sky.patches())
    for (size_t r = 0; r < replicate_count; ++r, ++ray)
      if (open[ray] != 0) sum[r] += open[ray] * rays.cosine(ray) * float(p.solid_angle);
  add(skies.ground.data(), sum);
}

void SensorHours::add_sun(const DirectRays& rays, std::span<const float> open) {
  size_t at = rays.first_of_sun();
  for (size_t i = 0; i < rays.sun_hours().size(); ++i) {
    const uint32_t h = rays.sun_hours()[i];
    SunTerm sun{h, {}};
    const float lx = light_.outside.skies.sun_lx[h] * rays.sun_cosine(i);
    bool is_lit = false;
    for (size_t r = 0; r < replicate_count; ++r, ++at) {
      sun.lx[r] = lx * open[at];
      is_lit = is_lit || sun.lx[r] != 0;
    }
    if (is_lit) suns_.push_back(sun);
  }
}

void SensorHours::add_reflected_sky(size_t sensor) {
  const YearSkies& skies = light_.outside.skies;
  const size_t patches = skies.coarse.sky.size();
  for (size_t p = 0; p <= patches; ++p) {
    std::array<float, replicate_count> c{};
    for (size_t r = 0; r < replicate_count; ++r) c[r] = light_.reflected[r].of(sensor)[p];
    add(p < patches ? skies.coarse.of(p, skies.hours()).data() : skies.ground.data(), c);
  }
}

void SensorHours::compute(RunOfHours& out) {
  sum_terms(terms_.data(), terms_.size(), out.first, out.count, out.total[0].data(),
            RunOfHours::most);
  add_reflected_sun(out);
  for (auto& of_replicate : out.sun) of_replicate.fill(0);
  for (; next_sun_ < suns_.size() && suns_[next_sun_].hour < out.first + out.count; ++next_sun_) {
    const SunTerm& sun = suns_[next_sun_];
    for (size_t r = 0; r < replicate_count; ++r) {
      out.sun[r][sun.hour - out.first] = sun.lx[r];
      out.total[r][sun.hour - out.first] += sun.lx[r];
    }
  }
}

void SensorHours::add_reflected_sun(RunOfHours& out) const {
  const YearSkies& skies = light_.outside.skies;
  const size_t first_sun = skies.coarse.sky.size() + 1;
  for (size_t r = 0; r < replicate_count; ++r) {
    const ReflectedReplicate& replicate = light_.reflected[r];
    const float* c = replicate.of(sensor_).data() + first_sun;
    for (size_t i = 0; i < out.count; ++i) {
      const size_t h = out.first + i;
      const float lx = skies.sun_lx[h];
      if (lx == 0) continue;
      float of_sun = 0;
      for (const SunGrid::Share& s : replicate.suns->shares()[skies.steps[h]])
        of_sun += s.weight * c[s.node];
      out.total[r][i] += lx * of_sun;
    }
  }
}

}  // namespace troffer
