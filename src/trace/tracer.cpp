#include "trace/tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "trace/embree_scene.h"
#include "trace/surface.h"

namespace troffer {

namespace {

// Packets of N rays in Embree's types. Packets that fill the processor's registers are used as they
// are; Embree repacks others.
template <size_t N>
struct Packets;
template <>
struct Packets<8> {
  using Rays = RTCRay8;
  using RayHits = RTCRayHit8;
  static constexpr auto intersect = rtcIntersect8;
  static constexpr auto occluded = rtcOccluded8;
};
template <>
struct Packets<16> {
  using Rays = RTCRay16;
  using RayHits = RTCRayHit16;
  static constexpr auto intersect = rtcIntersect16;
  static constexpr auto occluded = rtcOccluded16;
};

}  // namespace

Tracer::Tracer(const Scene& scene, const PaneGlass* glass)
    : embree_(std::make_unique<Embree>(scene, glass)),
      glass_(embree_->panes != nullptr ? glass : nullptr) {}

Scene with_room_for_tracer(Scene scene) {
  for (std::vector<Mesh>* const meshes : {&scene.meshes, &scene.instanced_meshes})
    for (Mesh& mesh : *meshes) mesh.positions.reserve(mesh.positions.size() + 1);
  return scene;
}

Tracer::~Tracer() = default;
Tracer::Tracer(Tracer&&) noexcept = default;
Tracer& Tracer::operator=(Tracer&&) noexcept = default;

namespace {

void fill(RTCRay& r, const Ray& ray) {
  r.org_x = ray.origin.x;
  r.org_y = ray.origin.y;
  r.org_z = ray.origin.z;
  r.tnear = ray.t_min;
  r.dir_x = ray.direction.x;
  r.dir_y = ray.direction.y;
  r.dir_z = ray.direction.z;
  r.tfar = ray.t_max;
  r.time = 0;
  r.mask = 0xffffffffu;
  r.id = 0;
  r.flags = 0;
}

// True if Embree accepts the ray: finite and within some 1.8e18. False for NaN.
bool is_traceable(const Ray& ray) {
  const Vec3 reach = abs(ray.origin) + abs(ray.direction);
  return reach.x + reach.y + reach.z < 1e18f;
}

// Fills a packet. Lanes beyond n and untraceable rays are inactive, but get finite values.
template <size_t N>
void fill(typename Packets<N>::Rays& p, std::span<const Ray> rays, std::array<int, N>& valid) {
  static constexpr Ray harmless{{0, 0, 0}, 0, {0, 0, 1}, 0};
  for (size_t i = 0; i < N; ++i) {
    const bool is_used = i < rays.size() && is_traceable(rays[i]);
    const Ray& ray = is_used ? rays[i] : harmless;
    valid[i] = is_used ? -1 : 0;
    p.org_x[i] = ray.origin.x;
    p.org_y[i] = ray.origin.y;
    p.org_z[i] = ray.origin.z;
    p.tnear[i] = ray.t_min;
    p.dir_x[i] = ray.direction.x;
    p.dir_y[i] = ray.direction.y;
    p.dir_z[i] = ray.direction.z;
    p.tfar[i] = ray.t_max;
    p.time[i] = 0;
    p.mask[i] = 0xffffffffu;
    p.id[i] = 0;
    p.flags[i] = 0;
  }
}

template <size_t N>
void closest_packets(RTCScene scene, const InstanceNumbers& instances, Context& context,
                     std::span<const Ray> rays, std::span<Hit> hits) {
  alignas(64) std::array<int, N> valid{};
  for (size_t first = 0; first < rays.size(); first += N) {
    const size_t n = std::min(N, rays.size() - first);
    typename Packets<N>::RayHits p;
    fill<N>(p.ray, rays.subspan(first, n), valid);
    std::fill(std::begin(p.hit.geomID), std::end(p.hit.geomID), RTC_INVALID_GEOMETRY_ID);
    std::fill(std::begin(p.hit.instID[0]), std::end(p.hit.instID[0]), RTC_INVALID_GEOMETRY_ID);
    Packets<N>::intersect(valid.data(), scene, &context.embree, &p);
    for (size_t i = 0; i < n; ++i) {
      hits[first + i] = {p.ray.tfar[i], p.hit.u[i], p.hit.v[i], p.hit.geomID[i], p.hit.primID[i]};
      instances.apply(p.hit.instID[0][i], hits[first + i]);
    }
  }
}

// Shadow rays are not flagged as coherent: Embree's ray frusta are slow behind wires and leaves
// (docs/log/trace.md).
template <size_t N>
void occluded_packets(RTCScene scene, Context& context, std::span<const Ray> rays,
                      std::span<uint8_t> is_occluded) {
  alignas(64) std::array<int, N> valid{};
  for (size_t first = 0; first < rays.size(); first += N) {
    const size_t n = std::min(N, rays.size() - first);
    typename Packets<N>::Rays p;
    fill<N>(p, rays.subspan(first, n), valid);
    Packets<N>::occluded(valid.data(), scene, &context.embree, &p);
    for (size_t i = 0; i < n; ++i) is_occluded[first + i] = valid[i] == 0 || p.tfar[i] < 0 ? 1 : 0;
  }
}

// Fills a packet with N segments from `first` on. Other lanes are treated as above.
template <size_t N>
void fill(typename Packets<N>::Rays& p, const Segments& s, size_t first,
          std::array<int, N>& valid) {
  const size_t n = std::min(N, s.size() - first);
  const std::array<float*, Segments::coordinates> lanes{p.org_x, p.org_y, p.org_z,
                                                        p.dir_x, p.dir_y, p.dir_z};
  std::array<float, N> reach{};
  for (size_t c = 0; c < lanes.size(); ++c) {
    const float* from = s.coordinate(c) + first;
    for (size_t i = 0; i < n; ++i) lanes[c][i] = from[i];
    for (size_t i = n; i < N; ++i) lanes[c][i] = 1;
    for (size_t i = 0; i < N; ++i) reach[i] += std::abs(lanes[c][i]);
  }
  bool are_fine = true;
  for (size_t i = 0; i < N; ++i) {
    const bool is_fine = reach[i] < 1e18f;
    are_fine &= is_fine;
    valid[i] = is_fine && i < n ? -1 : 0;
    p.tnear[i] = 0;
    p.tfar[i] = 1;
    p.time[i] = 0;
    p.mask[i] = 0xffffffffu;
    p.id[i] = 0;
    p.flags[i] = 0;
  }
  if (are_fine) return;
  for (float* lane : lanes)
    for (size_t i = 0; i < N; ++i)
      if (!(reach[i] < 1e18f)) lane[i] = 1;
}

template <size_t N>
void occluded_packets(RTCScene scene, Context& context, const Segments& segments,
                      std::span<uint8_t> is_occluded) {
  alignas(64) std::array<int, N> valid{};
  typename Packets<N>::Rays p;
  for (size_t first = 0; first < segments.size(); first += N) {
    fill<N>(p, segments, first, valid);
    Packets<N>::occluded(valid.data(), scene, &context.embree, &p);
    const size_t n = std::min(N, segments.size() - first);
    for (size_t i = 0; i < n; ++i) is_occluded[first + i] = valid[i] == 0 || p.tfar[i] < 0 ? 1 : 0;
  }
}

Hit closest_of(RTCScene scene, const InstanceNumbers& instances, Context& context, const Ray& ray) {
  RTCRayHit r;
  fill(r.ray, ray);
  r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene, &context.embree, &r);
  Hit hit{r.ray.tfar, r.hit.u, r.hit.v, r.hit.geomID, r.hit.primID};
  instances.apply(r.hit.instID[0], hit);
  return hit;
}

Ray ray_of(const Segments& s, size_t i) {
  return {{s.coordinate(0)[i], s.coordinate(1)[i], s.coordinate(2)[i]},
          0,
          {s.coordinate(3)[i], s.coordinate(4)[i], s.coordinate(5)[i]},
          1};
}

// Calls act(N) with the packet size as a constant.
template <class Act>
void in_packets(size_t size, const Act& act) {
  if (size == 16)
    act(std::integral_constant<size_t, 16>());
  else
    act(std::integral_constant<size_t, 8>());
}

}  // namespace

void Tracer::closest(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence,
                     Meeting meeting) const {
  Context context(meeting);
  if (coherence == Coherence::coherent) {
    context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    in_packets(embree_->packet_size, [&](auto n) {
      closest_packets<n>(embree_->scene, embree_->instances, context, rays, hits);
    });
    return;
  }
  for (size_t i = 0; i < rays.size(); ++i) {
    hits[i] = {};
    if (is_traceable(rays[i]))
      hits[i] = closest_of(embree_->scene, embree_->instances, context, rays[i]);
  }
}

void Tracer::occluded(std::span<const Ray> rays, std::span<uint8_t> is_occluded,
                      Coherence coherence) const {
  Context context(Meeting::all);
  if (coherence == Coherence::coherent) {
    in_packets(embree_->packet_size,
               [&](auto n) { occluded_packets<n>(embree_->scene, context, rays, is_occluded); });
    return;
  }
  for (size_t i = 0; i < rays.size(); ++i) {
    is_occluded[i] = 1;
    if (!is_traceable(rays[i])) continue;
    RTCRay r;
    fill(r, rays[i]);
    rtcOccluded1(embree_->scene, &context.embree, &r);
    is_occluded[i] = r.tfar < 0 ? 1 : 0;
  }
}

void Tracer::occluded(const Segments& segments, std::span<uint8_t> is_occluded) const {
  Context context(Meeting::all);
  in_packets(embree_->packet_size,
             [&](auto n) { occluded_packets<n>(embree_->scene, context, segments, is_occluded); });
}

void Tracer::occluded(std::span<const Ray> rays, std::span<uint8_t> is_occluded,
                      Coherence coherence, PaneFactors& factors) const {
  occluded(rays, is_occluded, coherence);
  factors.values.clear();
  if (!has_panes()) return;
  factors.values.assign(rays.size(), Rgb{1});
  for (size_t i = 0; i < rays.size(); ++i)
    if (is_occluded[i] == 0) factors.values[i] = transmittance(rays[i]);
}

void Tracer::occluded(const Segments& segments, std::span<uint8_t> is_occluded,
                      PaneFactors& factors) const {
  occluded(segments, is_occluded);
  factors.values.clear();
  if (!has_panes()) return;
  factors.values.assign(segments.size(), Rgb{1});
  for (size_t i = 0; i < segments.size(); ++i)
    if (is_occluded[i] == 0) factors.values[i] = transmittance(ray_of(segments, i));
}

Rgb Tracer::transmittance(const Ray& ray) const {
  constexpr int most_panes = 256;
  Rgb left{1};
  if (!has_panes() || !is_traceable(ray)) return left;
  Context context(Meeting::all, true);
  const float per_metre = 1 / length(ray.direction);
  Ray rest = ray;
  for (int i = 0; i < most_panes; ++i) {
    const Hit hit = closest_of(embree_->panes, embree_->instances, context, rest);
    if (!hit.is_valid()) return left;
    left *= glass_->transmittance(ray, hit);
    // Steps clear of this pane, which counts once where two of its triangles meet. The ray's own
    // coordinates matter too: the pane may lie where all coordinates are zero.
    const Vec3 at = max(abs(ray.origin), abs(ray.origin + ray.direction * hit.t));
    rest.t_min = hit.t + per_metre * ray_offset(std::max({at.x, at.y, at.z}));
    if (left.is_black() || !(rest.t_min < rest.t_max)) return left;
  }
  return Rgb{0};
}

}  // namespace troffer
