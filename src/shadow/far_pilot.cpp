#include "shadow/far_pilot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/random.h"

namespace troffer {

namespace {

constexpr size_t most_rays = 64, rays_of_receiver = 4;
constexpr uint64_t purpose_pilot = 0x7069'6c6f'7400;

// A ray from a receiver to a point of a source, and what the point would send.
struct Pilot {
  ShadowSegment segment;
  double weight = 0;
};

Pilot pilot_of(const ShadowReceiver& r, const FlatSource& source, double light, uint64_t random) {
  const double u = double(unit_float(uint32_t(random)));
  const double v = double(unit_float(uint32_t(random >> 32)));
  const Parallelogram& p = source.plane;
  const Vec3d y = p.origin + p.u * u + p.v * v, d = y - Vec3d(r.position);
  const double square = length_squared(d), area = length(cross(p.u, p.v));
  const double cosine = std::max(dot(Vec3d(r.normal), d), 0.0);
  const double height = -dot(p.normal, d);
  // of the light that the choice stands for
  const double term = dot(Vec3d(r.horizon), d) > 0 ? height * cosine * area / sqr(square) : 0;
  return {{r.origin, Vec3(y), no_round_source}, light > 0 ? term / light : 0};
}

}  // namespace

double far_open_share(const ShadowCluster& cluster, std::span<const LightRequest> requests,
                      std::span<const float> unoccluded, ShadowScene& scene) {
  const size_t n = cluster.size(), rays = std::min(rays_of_receiver * n, most_rays);
  std::array<ShadowSegment, most_rays> segments;
  std::array<float, most_rays> before;
  std::array<uint8_t, most_rays> is_hidden{};
  std::array<double, most_rays> weights{};
  size_t count = 0;
  for (size_t k = 0; k < rays; ++k) {
    const size_t i = (2 * k + 1) * n / (2 * rays);
    const auto light_of = [&](size_t r) {
      return requests[r].far == nullptr
                 ? 0.0
                 : double(requests[r].brightness) * double(unoccluded[r * n + i]);
    };
    double all = 0;
    for (size_t r = 0; r < requests.size(); ++r) all += light_of(r);
    if (!(all > 0)) continue;
    const ShadowReceiver& receiver = cluster.receivers[i];
    const uint64_t random = hash_of(receiver.stream, k, purpose_pilot);
    double target = double(unit_float(uint32_t(random >> 32))) * all;
    size_t chosen = requests.size();
    for (size_t r = 0; r < requests.size() && (chosen == requests.size() || target >= 0); ++r) {
      if (!(light_of(r) > 0)) continue;
      chosen = r;
      target -= light_of(r);
    }
    const Pilot p = pilot_of(receiver, *requests[chosen].flat, double(unoccluded[chosen * n + i]),
                             mix64(random));
    if (!(p.weight > 0)) continue;
    segments[count] = p.segment;
    weights[count] = p.weight;
    before[count++] = 0.999f;
  }
  scene.occluded({segments.data(), count}, {before.data(), count}, {is_hidden.data(), count});
  double sum = 0, free = 0;
  for (size_t k = 0; k < count; ++k) {
    sum += weights[k];
    if (is_hidden[k] == 0) free += weights[k];
  }
  // as if two rays more had met one of each
  const double share = sum > 0 ? free / sum : 0.5;
  return (share * double(count) + 1) / (double(count) + 2);
}

double rays_for_error(double p, double error) {
  return std::pow(std::sqrt((1 - p) / p) / error, 4.0 / 3);
}

}  // namespace troffer
