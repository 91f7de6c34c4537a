#include "annual/sensor_hours.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "annual/open_rays.h"
#include "base/random.h"
#include "base/simd.h"
#include "base/streams.h"
#include "base/units.h"

namespace troffer {

namespace {

constexpr size_t replicates = replicate_count;
constexpr size_t hours_at_a_time = 512;
constexpr int cosine_points = 4;  // per side of a patch, for the mean cosine on a tilted sensor

// out += w v
TROFFER_MULTIVERSION
void add_scaled(float w, const float* v, float* out, size_t n) {
  for (size_t i = 0; i < n; ++i) out[i] += w * v[i];
}

class SensorCalculation {
 public:
  SensorCalculation(const YearOfLight& light, size_t sensor, const CellHit& place)
      : light_(light), sensor_(sensor), place_(place), rays_(light.scene.tracer) {
    out_.hours = light.skies.hours();
    out_.total.assign(replicates * out_.hours, 0);
    out_.sun.assign(replicates * out_.hours, 0);
  }

  SensorHours compute() {
    add_sky();
    add_ground();
    add_sun();
    add_reflected_sky();
    for (size_t r = 0; r < replicates; ++r) add_reflected_sun(r);
    return std::move(out_);
  }
  std::vector<SunHour> compute_sun() {
    add_sun();
    std::vector<SunHour> hours;
    for (size_t h = 0; h < out_.hours; ++h) {
      float sum = 0;
      for (size_t r = 0; r < replicates; ++r) sum += out_.sun[r * out_.hours + h];
      if (sum > 0) hours.push_back({uint32_t(h), sum / float(replicates)});
    }
    return hours;
  }

 private:
  Vec3 world(const Vec3d& d) const {
    const Compass& c = light_.compass;
    return Vec3(c.east * d.x + c.north * d.y + c.up * d.z);
  }
  float* total(size_t replicate) { return &out_.total[replicate * out_.hours]; }
  Random random_of(uint64_t purpose) const {
    return Random(hash_of(light_.seed, uint64_t(sensor_), purpose));
  }
  // Integral of the cosine over a patch.
  double cosine_over(const ReinhartPatch& p) const {
    if (length_squared(place_.normal - Vec3(light_.compass.up)) < 1e-10f) return p.cosine;
    double sum = 0;
    for (int y = 0; y < cosine_points; ++y)
      for (int x = 0; x < cosine_points; ++x) {
        const Vec3d d = p.direction((x + 0.5) / cosine_points, (y + 0.5) / cosine_points);
        sum += std::max(0.0, double(dot(world(d), place_.normal)));
      }
    return sum * p.solid_angle / (cosine_points * cosine_points);
  }

  // One ray per patch and replicate. A patch that all rays see unhindered brings its exact share.
  void add_sky() {
    Random random = random_of(stream::annual_direct_sky);
    const PatchHours& fine = light_.skies.fine;
    std::vector<float> same(out_.hours, 0.0f);  // light that all replicates agree on
    for (size_t p = 0; p < fine.sky.size(); ++p) {
      const ReinhartPatch& patch = fine.sky.patches()[p];
      std::array<float, replicates> c{};
      if (!look(patch, 1, random, c)) continue;
      const float* hours = fine.of(p, out_.hours).data();
      const bool is_open = c[0] > 0 && is_clear_;
      if (is_open) {
        add_scaled(float(cosine_over(patch)), hours, same.data(), out_.hours);
        continue;
      }
      for (size_t r = 0; r < replicates; ++r)
        if (c[r] > 0) add_scaled(c[r], hours, total(r), out_.hours);
    }
    for (size_t r = 0; r < replicates; ++r) add_scaled(1, same.data(), total(r), out_.hours);
  }
  // The ground has uniform luminance: the mirrored coarse patches only stratify it.
  void add_ground() {
    Random random = random_of(stream::annual_direct_ground);
    std::array<float, replicates> sum{};
    for (const ReinhartPatch& p : light_.skies.coarse.sky.patches()) {
      std::array<float, replicates> c{};
      if (look(p, -1, random, c))
        for (size_t r = 0; r < replicates; ++r) sum[r] += c[r];
    }
    for (size_t r = 0; r < replicates; ++r)
      add_scaled(sum[r], light_.skies.ground.data(), total(r), out_.hours);
  }
  // Sets c to the illuminance per luminance of a patch, and is_clear_ if nothing hides any of it.
  // sign: -1 for its mirror image below the horizon. False if the sensor sees nothing.
  bool look(const ReinhartPatch& patch, int sign, Random& random,
            std::array<float, replicates>& c) {
    rays_.clear();
    std::array<float, replicates> cosines{};
    std::array<bool, replicates> is_sent{};
    for (size_t r = 0; r < replicates; ++r) {
      const double u = random.next_double();
      Vec3d d = patch.direction(u, random.next_double());
      d.z *= sign;
      const Vec3 w = world(d);
      cosines[r] = dot(w, place_.normal);
      is_sent[r] = cosines[r] > 0;
      if (is_sent[r]) rays_.add(place_, w);
    }
    if (rays_.size() == 0) return false;
    rays_.trace();
    is_clear_ = rays_.size() == replicates;
    bool sees = false;
    for (size_t r = 0, k = 0; r < replicates; ++r) {
      if (!is_sent[r]) continue;
      const float open = luminance(rays_[k++]);
      is_clear_ = is_clear_ && open > 0.99999f;
      sees = sees || open > 0;
      c[r] = open * cosines[r] * float(patch.solid_angle);
    }
    return sees;
  }
  // One ray per hour and replicate, to a point of the sun's disc.
  void add_sun() {
    Random random = random_of(stream::annual_direct_sun);
    for (size_t h = 0; h < out_.hours; ++h) {
      const float lx = light_.skies.sun_lx[h];
      if (lx == 0) continue;
      const WeatherStep& step = light_.year.steps[light_.skies.steps[h]];
      const Vec3 to_sun = world(direction_of(step.sun));
      rays_.clear();
      const float cosine = dot(to_sun, place_.normal);
      if (cosine <= 0) continue;
      for (size_t r = 0; r < replicates; ++r)
        rays_.add(place_, within_sun(to_sun, random.next_vec2()));
      rays_.trace();
      for (size_t r = 0; r < replicates; ++r) {
        const float sunlight = lx * cosine * luminance(rays_[r]);
        out_.sun[r * out_.hours + h] = sunlight;
        out_.total[r * out_.hours + h] += sunlight;
      }
    }
  }
  // In runs of hours, so that luminances and sums stay in the cache.
  void add_reflected_sky() {
    const PatchHours& coarse = light_.skies.coarse;
    const size_t patches = coarse.sky.size();
    for (size_t first = 0; first < out_.hours; first += hours_at_a_time) {
      const size_t n = std::min(hours_at_a_time, out_.hours - first);
      for (size_t p = 0; p <= patches; ++p) {
        const float* sky =
            p < patches ? coarse.of(p, out_.hours).data() : light_.skies.ground.data();
        for (size_t r = 0; r < replicates; ++r) {
          const float c = light_.reflected[r].of(sensor_)[p];
          if (c > 0) add_scaled(c, sky + first, total(r) + first, n);
        }
      }
    }
  }
  void add_reflected_sun(size_t r) {
    const ReflectedReplicate& replicate = light_.reflected[r];
    const std::span<const float> c = replicate.of(sensor_);
    const size_t patches = light_.skies.coarse.sky.size();
    for (size_t h = 0; h < out_.hours; ++h) {
      const float lx = light_.skies.sun_lx[h];
      if (lx == 0) continue;
      float of_sun = 0;
      for (const SunGrid::Share& s : replicate.suns.shares()[light_.skies.steps[h]])
        of_sun += s.weight * c[patches + 1 + s.node];
      total(r)[h] += lx * of_sun;
    }
  }

  const YearOfLight& light_;
  size_t sensor_;
  const CellHit& place_;
  OpenRays rays_;
  bool is_clear_ = false;
  SensorHours out_;
};

}  // namespace

SensorHours sensor_hours(const YearOfLight& light, size_t sensor, const CellHit& place) {
  return SensorCalculation(light, sensor, place).compute();
}

std::vector<SunHour> sun_of_sensor(const YearOfLight& light, size_t sensor, const CellHit& place) {
  return SensorCalculation(light, sensor, place).compute_sun();
}

}  // namespace troffer
