#include "shadow/pilot_rays.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/random.h"
#include "base/streams.h"
#include "shadow/cell_points.h"

namespace troffer {

namespace {

constexpr size_t most_rays = 128, most_far_rays = 64, rays_of_receiver = 4;

// True if the ray from x along d hits a convex quadrilateral.
bool meets(const Quad& q, const Vec3d& x, const Vec3d& d) {
  int left = 0, right = 0;
  for (size_t i = 0; i < 4; ++i) {
    const double side = dot(d, cross(Vec3d(q[i]) - x, Vec3d(q[(i + 1) % 4]) - x));
    left += side > 0;
    right += side < 0;
  }
  if (left > 0 && right > 0) return false;
  const Vec3d n = cross(Vec3d(q[1]) - Vec3d(q[0]), Vec3d(q[2]) - Vec3d(q[0]));
  return dot(n, d) * dot(n, Vec3d(q[0]) - x) > 0;
}

// Rays to points of sources, weighted by the unoccluded light of these points.
class Pilots {
 public:
  // Adds a ray to the point y of a source with normal n. inverse_density: of the choice of source
  // and point. frame: see LightRequest.
  void add(const ShadowReceiver& r, const Vec3d& y, const Vec3d& n, double inverse_density,
           std::span<const FacetToAdd> frame = {}) {
    const Vec3d d = y - Vec3d(r.position);
    const double cosine = std::max(dot(Vec3d(r.normal), d), 0.0), height = -dot(n, d);
    if (!(dot(Vec3d(r.horizon), d) > 0) || count_ == most_rays) return;
    const double weight = height * cosine * inverse_density / sqr(length_squared(d));
    if (!(weight > 0)) return;
    const auto is_met = [&](const FacetToAdd& f) { return meets(f.quad, Vec3d(r.origin), d); };
    if (std::any_of(frame.begin(), frame.end(), is_met)) {
      dark_ += weight;
      ++dark_count_;
      return;
    }
    segments_.add({r.origin, Vec3(y), no_round_source}, 0.999f);
    weights_[count_++] = weight;
  }

  // Traces the rays and returns the open share, as if two more rays had given one answer each.
  double share(ShadowScene& scene) {
    std::array<uint8_t, most_rays> is_hidden{};
    scene.occluded(segments_, {is_hidden.data(), count_});
    double sum = dark_, free = 0;
    for (size_t k = 0; k < count_; ++k) {
      sum += weights_[k];
      if (is_hidden[k] == 0) free += weights_[k];
    }
    const double share = sum > 0 ? free / sum : 0.5;
    const auto rays = double(count_ + dark_count_);
    return (share * rays + 1) / (rays + 2);
  }

 private:
  SegmentArrays segments_;
  std::array<double, most_rays> weights_{};
  size_t count_ = 0, dark_count_ = 0;
  double dark_ = 0;
};

double unit_double(uint64_t random) {
  return double(unit_float(uint32_t(random >> 32)));
}

}  // namespace

double sky_open_share(const ShadowCluster& cluster, std::span<const LightRequest> requests,
                      std::span<const float> unoccluded, ShadowScene& scene) {
  const size_t n = cluster.size(), rays = std::min(rays_of_receiver * n, most_far_rays);
  Pilots pilots;
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
    const uint64_t random = hash_of(receiver.stream, k, stream::source_pilot);
    double target = unit_double(random) * all;
    size_t chosen = requests.size();
    for (size_t r = 0; r < requests.size() && (chosen == requests.size() || target >= 0); ++r) {
      if (!(light_of(r) > 0)) continue;
      chosen = r;
      target -= light_of(r);
    }
    const Parallelogram& p = requests[chosen].flat->plane;
    const uint64_t place = mix64(random);
    const Vec3d y = p.origin + p.u * unit_double(place << 32) + p.v * unit_double(place);
    // light that the choice represents
    const auto light = double(unoccluded[chosen * n + i]);
    if (!(light > 0)) continue;
    const double inverse_density = length(cross(p.u, p.v)) / light;
    pilots.add(receiver, y, p.normal, inverse_density, requests[chosen].frame);
  }
  return pilots.share(scene);
}

double open_share(const LightRequest& request, std::span<const ShadowReceiver> receivers,
                  ShadowScene& scene) {
  const FlatCell cell = visible_part(*request.flat, ReceiverHull());
  const CellPoints points(cell);
  const size_t n = receivers.size(), rays = std::min(most_rays, rays_of_receiver * n);
  Pilots pilots;
  for (size_t k = 0; k < rays; ++k) {
    const ShadowReceiver& r = receivers[(2 * k + 1) * n / (2 * rays)];
    const uint64_t random = mix64(hash_of(r.stream, k, stream::source_pilot) + request.stream);
    const Vec3d y = points.at(float(unit_double(random << 32)), float(unit_double(random)));
    pilots.add(r, y, cell.plane.normal, points.area());
  }
  return pilots.share(scene);
}

double rays_for_error(double p, double error) {
  return std::pow(std::sqrt((1 - p) / p) / error, 4.0 / 3);
}

}  // namespace troffer
