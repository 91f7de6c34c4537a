#include "shadow/shadow_cluster.h"

#include <algorithm>

#include "base/box.h"
#include "light/irradiance.h"
#include "light/polygon.h"

namespace troffer {

void ShadowCluster::set(std::span<const ShadowReceiver> of) {
  receivers = of;
  arrays.assign(of.size());
  has_own_horizons = false;
  std::vector<Vec3> origins, horizons;
  origins.reserve(of.size());
  horizons.reserve(of.size());
  for (size_t i = 0; i < of.size(); ++i) {
    const ShadowReceiver& r = of[i];
    arrays.set(i, r.position, r.normal);
    has_own_horizons = has_own_horizons || length_squared(r.normal - r.horizon) > 1e-12f;
    origins.push_back(r.origin);
    horizons.push_back(r.horizon);
  }
  if (!of.empty()) hull = bound_receivers(origins, horizons);
  if (has_own_horizons) arrays.horizons = std::move(horizons);
}

ReceiverHull hull_of(const ShadowCluster& cluster, std::span<const uint32_t> members) {
  if (members.size() == cluster.size()) return cluster.hull;
  std::vector<Vec3> origins, horizons;
  origins.reserve(members.size());
  horizons.reserve(members.size());
  for (const uint32_t m : members) {
    origins.push_back(cluster.receivers[m].origin);
    horizons.push_back(cluster.receivers[m].horizon);
  }
  return bound_receivers(origins, horizons);
}

size_t halve_members(const ShadowCluster& cluster, std::span<uint32_t> members) {
  Box box;
  for (const uint32_t m : members) box.grow(cluster.receivers[m].origin);
  const Vec3 e = box.extent();
  const size_t axis = e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2;
  const size_t half = members.size() / 2;
  std::nth_element(members.begin(), members.begin() + std::ptrdiff_t(half), members.end(),
                   [&](uint32_t a, uint32_t b) {
                     const float p = cluster.receivers[a].origin[axis];
                     const float q = cluster.receivers[b].origin[axis];
                     return p != q ? p < q : a < b;
                   });
  return half;
}

void unoccluded_light(const ShadowCluster& cluster, const FlatSource& source,
                      std::span<const Vec3d> outline, std::vector<float>& values) {
  values.resize(cluster.size());
  const Vec3d& normal = source.plane.normal;
  if (!source.is_disk || cluster.arrays.horizons.empty())
    return unoccluded_irradiance(outline, normal, cluster.arrays, values.data());
  ReceiverArrays without = cluster.arrays;
  without.horizons.clear();
  unoccluded_irradiance(outline, normal, without, values.data());
}

void unoccluded_light(const ShadowCluster& cluster, const FlatSource& source,
                      std::vector<float>& values) {
  if (!source.is_disk) return unoccluded_light(cluster, source, source.corners(), values);
  values.resize(cluster.size());
  const Parallelogram& p = source.plane;
  const Vec3d centre = p.origin + (p.u + p.v) * 0.5;
  const double radius = 0.5 * length(p.u);
  for (size_t i = 0; i < cluster.size(); ++i) {
    const Vec3d x = cluster.arrays.position_at(i);
    const bool is_before = dot(p.normal, x - centre) > plane_rounding(x, centre);
    values[i] =
        is_before ? float(disk_irradiance(centre, p.normal, radius, x, cluster.arrays.normal_at(i)))
                  : 0;
  }
}

void unoccluded_light(const ShadowCluster& cluster, const SphereSource& source,
                      std::vector<float>& values) {
  values.resize(cluster.size());
  for (size_t i = 0; i < cluster.size(); ++i)
    values[i] = float(sphere_irradiance(source.centre, source.radius, cluster.arrays.position_at(i),
                                        cluster.arrays.normal_at(i)));
}

}  // namespace troffer
