#include "annual/outside_sources.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "annual/sun_disc.h"
#include "base/units.h"
#include "daylight/sky_model.h"

namespace troffer {

namespace {

// Radius of the disc that stands for the sun behind mirrors, glass and gloss. Convention: a
// Tregenza patch is about as wide.
constexpr double blurred_radius = rad_from_deg(5);

}  // namespace

OutsideSources::OutsideSources(const Compass& compass, std::span<const Vec3d> suns, int subdivision)
    : compass_(compass), sky_(subdivision) {
  for (const Vec3d& s : suns) suns_.push_back(world(s));
}

void OutsideSources::draw(size_t source, int count, Random& random,
                          std::vector<OutsideSample>& out) const {
  if (source < ground()) {
    const ReinhartPatch& p = sky_.patches()[source];
    for (int i = 0; i < count; ++i) {
      const double u = (i + random.next_double()) / count;
      out.push_back({world(p.direction(u, random.next_double())), float(p.solid_angle / count)});
    }
  } else if (source == ground()) {
    for (const ReinhartPatch& p : sky_.patches()) {
      const double u = random.next_double();
      Vec3d d = p.direction(u, random.next_double());
      d.z = -d.z;
      out.push_back({world(d), float(p.solid_angle)});
    }
  } else {
    for (int i = 0; i < count; ++i)
      out.push_back(
          {within_sun(suns_[source - first_sun()], random.next_vec2()), 1.0f / float(count)});
  }
}

float OutsideSources::radiance(size_t source, const Vec3& direction) const {
  const Vec3d w(direction);
  const Vec3d d{dot(w, compass_.east), dot(w, compass_.north), dot(w, compass_.up)};
  if (source < ground()) return d.z > 0 && sky_.at(d) == source ? 1.0f : 0.0f;
  if (source == ground()) return d.z <= 0 ? 1.0f : 0.0f;
  const double cosine = dot(w, Vec3d(suns_[source - first_sun()]));
  if (cosine < std::cos(blurred_radius)) return 0;
  return float(1 / (pi * sqr(std::sin(blurred_radius))));
}

std::vector<uint32_t> OutsideSources::by_azimuth() const {
  std::vector<double> azimuths;
  for (const ReinhartPatch& p : sky_.patches())
    azimuths.push_back(std::atan2(p.centre().x, p.centre().y));
  azimuths.push_back(std::numeric_limits<double>::infinity());
  for (const Vec3& s : suns_)
    azimuths.push_back(std::atan2(dot(Vec3d(s), compass_.east), dot(Vec3d(s), compass_.north)));
  std::vector<uint32_t> order(size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return azimuths[a] < azimuths[b]; });
  return order;
}

DrawnSources::DrawnSources(const OutsideSources& sources, std::span<const uint32_t> numbers,
                           int samples, uint64_t seed) {
  Random random(seed);
  for (const uint32_t number : numbers) {
    for (size_t k = 0; k < drawings; ++k) sources.draw(number, samples, random, samples_);
    begin_.push_back(samples_.size());
  }
}

}  // namespace troffer
