#include "annual/eye_glare.h"

#include <algorithm>
#include <cmath>

#include "annual/open_rays.h"
#include "annual/sun_disc.h"
#include "base/random.h"
#include "base/streams.h"
#include "base/units.h"
#include "daylight/sky_model.h"
#include "report/daylight_glare.h"
#include "report/glare.h"

namespace troffer {

namespace {

constexpr double source_luminance = 2000;  // cd/m², as `troffer glare`
constexpr size_t eye_rays = 8;             // to a patch
// Strata of the view: Reinhart's subdivision around the line of sight.
constexpr int view_subdivision = 3;

double disc_solid_angle() {
  return pi * sqr(std::sin(rad_from_deg(sun_angular_radius_deg)));
}

// Share of rays that find an opening, and their mean transmittance.
struct OpenShare {
  double share = 0, transmittance = 0;
};

class EyeCalculation {
 public:
  EyeCalculation(const YearOfLight& light, size_t eye, const CellHit& place)
      : light_(light),
        eye_(eye),
        place_(place),
        rays_(light.scene.tracer),
        strengths_(light.outside.skies.hours(), 0.0f) {
    ahead_ = place.normal;
    const Vec3 up(light.outside.compass.up);
    // An eye that looks straight up or down has north at the top.
    const Vec3 top = std::abs(dot(ahead_, up)) > 0.999f ? Vec3(light.outside.compass.north) : up;
    above_ = normalize(top - ahead_ * dot(top, ahead_));
    right_ = cross(ahead_, above_);
  }

  std::vector<float> compute() {
    add_sky();
    add_sun();
    add_surfaces();
    return std::move(strengths_);
  }

 private:
  Vec3 world(const Vec3d& d) const {
    const Compass& c = light_.outside.compass;
    return Vec3(c.east * d.x + c.north * d.y + c.up * d.z);
  }
  Random random_of(uint64_t purpose) const {
    return Random(hash_of(light_.outside.seed, uint64_t(eye_), purpose));
  }
  // 1 / P²; 0 behind the eye.
  double weight_of(const Vec3& d) const {
    const double z = double(dot(d, ahead_));
    if (!(z > 0)) return 0;
    const double p = wide_position_index({double(dot(d, right_)), double(dot(d, above_)), z});
    return 1 / sqr(p);
  }
  OpenShare trace() {
    rays_.trace();
    OpenShare open;
    for (size_t i = 0; i < rays_.size(); ++i) {
      const auto t = double(luminance(rays_[i]));
      if (!(t > 0)) continue;
      open.share += 1;
      open.transmittance += t;
    }
    if (open.share > 0) open.transmittance /= open.share;
    open.share /= double(std::max<size_t>(rays_.size(), 1));
    return open;
  }
  void add(size_t hour, double luminance, double solid_angle, double weight) {
    if (luminance > source_luminance)
      strengths_[hour] += float(sqr(luminance) * solid_angle * weight);
  }

  void add_sky() {
    Random random = random_of(stream::annual_eye_sky);
    const PatchHours& fine = light_.outside.skies.fine;
    for (size_t p = 0; p < fine.sky.size(); ++p) {
      const ReinhartPatch& patch = fine.sky.patches()[p];
      const double weight = weight_of(world(patch.centre()));
      if (weight == 0) continue;
      rays_.clear();
      for (size_t i = 0; i < eye_rays; ++i) {
        const double u = random.next_double();
        rays_.add(place_, world(patch.direction(u, random.next_double())));
      }
      const OpenShare open = trace();
      if (open.share == 0) continue;
      const std::span<const float> hours = fine.of(p, strengths_.size());
      for (size_t h = 0; h < strengths_.size(); ++h)
        add(h, double(hours[h]) * open.transmittance, patch.solid_angle * open.share, weight);
    }
  }
  void add_sun() {
    Random random = random_of(stream::annual_eye_sun);
    for (size_t h = 0; h < strengths_.size(); ++h) {
      const auto lx = double(light_.outside.skies.sun_lx[h]);
      if (lx == 0) continue;
      const Vec3 to_sun =
          world(direction_of(light_.outside.year.steps[light_.outside.skies.steps[h]].sun));
      const double weight = weight_of(to_sun);
      if (weight == 0) continue;
      rays_.clear();
      for (const Vec3& d : over_sun(to_sun, random)) rays_.add(place_, d);
      const OpenShare open = trace();
      const double disc = disc_solid_angle();
      if (open.share > 0) add(h, lx * open.transmittance / disc, disc * open.share, weight);
    }
  }
  // Surfaces that a ray per stratum sees, also by way of glass and mirrors, lit straight by the
  // sun.
  void add_surfaces() {
    const ReinhartSky strata(view_subdivision);
    const GatherWalks walks(light_.scene, nullptr);
    GatherScratch scratch;
    Random random = random_of(stream::annual_eye_view);
    std::vector<double> weights;
    for (const ReinhartPatch& p : strata.patches()) {
      const double u = random.next_double();
      const Vec3d d = p.direction(u, random.next_double());
      const Vec3 way = right_ * float(d.x) + above_ * float(d.y) + ahead_ * float(d.z);
      Walk walk;
      walk.index = uint32_t(weights.size());
      walk.sample = walk.index;
      walk.stream = hash_of(light_.outside.seed, uint64_t(eye_), stream::annual_eye_walks);
      set_out(place_, way, walk);
      weights.push_back(weight_of(way) * p.solid_angle);
      if (!walk.throughput.is_black()) scratch.walks.push_back(walk);
    }
    Counters counters;
    walks.follow(weights.size(), Coherence::none, scratch, counters);
    add_arrivals(scratch.arrivals, weights, random);
  }
  // weights: solid angle / P² of each stratum.
  void add_arrivals(const std::vector<GatherArrival>& arrivals, const std::vector<double>& weights,
                    Random& random) {
    for (size_t h = 0; h < strengths_.size(); ++h) {
      const auto lx = double(light_.outside.skies.sun_lx[h]);
      if (lx == 0) continue;
      const Vec3 to_sun =
          world(direction_of(light_.outside.year.steps[light_.outside.skies.steps[h]].sun));
      rays_.clear();
      sent_.clear();
      for (size_t i = 0; i < arrivals.size(); ++i) {
        const CellHit& hit = arrivals[i].hit;
        const Vec3 way = within_sun(to_sun, random.next_vec2());
        const double lit = double(luminance(arrivals[i].walk.throughput)) * lx *
                           std::max(0.0, double(dot(way, hit.normal))) / pi;
        if (!(lit > source_luminance) || !(dot(way, hit.horizon) > 0)) continue;
        rays_.add(hit, way);
        sent_.push_back({i, lit});
      }
      if (sent_.empty()) continue;
      rays_.trace();
      for (size_t k = 0; k < sent_.size(); ++k)
        add(h, sent_[k].luminance * double(luminance(rays_[k])), 1,
            weights[arrivals[sent_[k].arrival].walk.index]);
    }
  }

  // A shadow ray under way, and the luminance it brings if it is free.
  struct Sent {
    size_t arrival = 0;
    double luminance = 0;
  };

  const YearOfLight& light_;
  size_t eye_;
  const CellHit& place_;
  OpenRays rays_;
  Vec3 ahead_, above_, right_;
  std::vector<float> strengths_;
  std::vector<Sent> sent_;
};

}  // namespace

std::vector<float> glare_strengths(const YearOfLight& light, size_t eye, const CellHit& place) {
  return EyeCalculation(light, eye, place).compute();
}

double hourly_dgp(double vertical_lx, double strength) {
  const double contrast =
      vertical_lx > 0 ? 0.092 * std::log10(1 + strength / std::pow(vertical_lx, 1.87)) : 0;
  const double dgp = std::min(5.87e-5 * vertical_lx + contrast + 0.159, 1.0);
  return dgp * low_light_factor(vertical_lx);
}

std::array<double, glare_limits.size()> shares_of_glare(std::span<const float> dgp,
                                                        const YearTimes& times) {
  std::array<double, glare_limits.size()> shares{};
  for (size_t h = 0; h < dgp.size(); ++h)
    for (size_t k = 0; k < shares.size(); ++k)
      if (times.is_occupied[h] != 0 && double(dgp[h]) > glare_limits[k].dgp)
        shares[k] += 1 / double(times.occupied);
  return shares;
}

}  // namespace troffer
