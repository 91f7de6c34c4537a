#include "trace/tracer.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"

namespace troffer {

namespace {

constexpr size_t packet_size = 16;

// What an alpha test needs to know of its mesh.
struct AlphaTest {
  const Scene* scene;
  const Mesh* mesh;
};

bool is_transparent(const AlphaTest& test, uint32_t primitive, float u, float v) {
  const Triangle& t = test.mesh->triangles[primitive];
  Vec2 uv{0, 0};
  if (!test.mesh->uvs.empty()) {
    const auto& c = test.mesh->uvs;
    uv = c[t[0]] * (1 - u - v) + c[t[1]] * u + c[t[2]] * v;
  }
  const Material& m = test.scene->materials[test.mesh->material];
  return evaluate(test.scene->textures, m.alpha, uv) < m.alpha_cutoff;
}

void alpha_filter(const RTCFilterFunctionNArguments* args) {
  const auto& test = *static_cast<const AlphaTest*>(args->geometryUserPtr);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] != -1) continue;
    if (is_transparent(test, RTCHitN_primID(args->hit, args->N, i),
                       RTCHitN_u(args->hit, args->N, i), RTCHitN_v(args->hit, args->N, i)))
      args->valid[i] = 0;
  }
}

struct EmbreeStatus {
  RTCError code = RTC_ERROR_NONE;
  std::string text;
};

void on_error(void* user, RTCError code, const char* text) {
  auto& status = *static_cast<EmbreeStatus*>(user);
  if (status.code != RTC_ERROR_NONE) return;
  status.code = code;
  status.text = text != nullptr ? text : "";
}

}  // namespace

struct Tracer::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  EmbreeStatus status;
  std::vector<AlphaTest> alpha_tests;

  Embree() = default;
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;
  ~Embree() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  void throw_if_failed() const {
    if (status.code == RTC_ERROR_NONE) return;
    throw EnvironmentError(
        "cannot build the ray tracing structure: " +
        (status.code == RTC_ERROR_OUT_OF_MEMORY ? std::string("out of memory") : status.text));
  }

  template <class T>
  T* buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, size_t stride,
            size_t count) {
    auto* data = static_cast<T*>(
        rtcSetNewGeometryBuffer(geometry, type, 0, format, stride, std::max<size_t>(count, 1)));
    throw_if_failed();
    return data;
  }

  void attach(RTCGeometry geometry, uint32_t id) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
  }

  void add_mesh(const Scene& s, uint32_t id) {
    const Mesh& mesh = s.meshes[id];
    if (mesh.triangles.empty()) return;
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    // Embree owns the copies: it reads vertices in 16-byte loads, past the end of ours.
    auto* p = buffer<float>(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                            mesh.positions.size());
    for (size_t i = 0; i < mesh.positions.size(); ++i)
      for (size_t a = 0; a < 3; ++a) p[3 * i + a] = mesh.positions[i][a];
    auto* t = buffer<uint32_t>(g, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t),
                               mesh.triangles.size());
    for (size_t i = 0; i < mesh.triangles.size(); ++i)
      for (size_t a = 0; a < 3; ++a) t[3 * i + a] = mesh.triangles[i][a];
    if (s.materials[mesh.material].is_alpha_masked) {
      alpha_tests[id] = {&s, &mesh};
      rtcSetGeometryUserData(g, &alpha_tests[id]);
      rtcSetGeometryIntersectFilterFunction(g, alpha_filter);
      rtcSetGeometryOccludedFilterFunction(g, alpha_filter);
    }
    attach(g, id);
  }

  void add_spheres(const Scene& s) {
    if (s.spheres.empty()) return;
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    auto* p = buffer<float>(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 4 * sizeof(float),
                            s.spheres.size());
    for (const Sphere& sphere : s.spheres) {
      for (size_t a = 0; a < 3; ++a) *p++ = sphere.centre[a];
      *p++ = sphere.radius;
    }
    attach(g, uint32_t(s.meshes.size()));
  }

  void add_disks(const Scene& s) {
    if (s.disks.empty()) return;
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT);
    auto* p = buffer<float>(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 4 * sizeof(float),
                            s.disks.size());
    auto* n = buffer<float>(g, RTC_BUFFER_TYPE_NORMAL, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                            s.disks.size());
    for (const Disk& disk : s.disks) {
      for (size_t a = 0; a < 3; ++a) {
        *p++ = disk.centre[a];
        *n++ = disk.normal[a];
      }
      *p++ = disk.radius;
    }
    attach(g, uint32_t(s.meshes.size()) + 1);
  }
};

Tracer::Tracer(const Scene& scene) : embree_(std::make_unique<Embree>()) {
  Embree& e = *embree_;
  e.device = rtcNewDevice(nullptr);
  if (e.device == nullptr) throw EnvironmentError("cannot start Embree");
  rtcSetDeviceErrorFunction(e.device, on_error, &e.status);
  e.scene = rtcNewScene(e.device);
  rtcSetSceneFlags(e.scene, RTC_SCENE_FLAG_ROBUST);  // no light leaks through shared edges
  rtcSetSceneBuildQuality(e.scene, RTC_BUILD_QUALITY_HIGH);
  e.alpha_tests.resize(scene.meshes.size());
  for (uint32_t i = 0; i < scene.meshes.size(); ++i) e.add_mesh(scene, i);
  e.add_spheres(scene);
  e.add_disks(scene);
  // Coincident surfaces are told apart by the order of primitives in the tree's leaves, which is
  // the same for any number of threads only when the tree is built on one. Large scenes, where
  // that would take long, are built on all cores.
  constexpr size_t large = 400'000;
  if (triangle_count(scene) > large)
    rtcCommitScene(e.scene);
  else
    run_on_one_thread([&] { rtcJoinCommitScene(e.scene); });
  e.throw_if_failed();
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

// Embree asserts that rays are finite and within some 1.8e18; false for NaN.
bool is_traceable(const Ray& ray) {
  const Vec3 reach = abs(ray.origin) + abs(ray.direction);
  return reach.x + reach.y + reach.z < 1e18f;
}

// Lanes beyond n and untraceable ones stay inactive through `valid`, but are given finite values.
void fill(RTCRay16& p, std::span<const Ray> rays, std::array<int, packet_size>& valid) {
  static constexpr Ray harmless{{0, 0, 0}, 0, {0, 0, 1}, 0};
  for (size_t i = 0; i < packet_size; ++i) {
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

void closest_packets(RTCScene scene, RTCIntersectContext& context, std::span<const Ray> rays,
                     std::span<Hit> hits) {
  alignas(64) std::array<int, packet_size> valid{};
  for (size_t first = 0; first < rays.size(); first += packet_size) {
    const size_t n = std::min(packet_size, rays.size() - first);
    RTCRayHit16 p;
    fill(p.ray, rays.subspan(first, n), valid);
    std::fill(std::begin(p.hit.geomID), std::end(p.hit.geomID), RTC_INVALID_GEOMETRY_ID);
    rtcIntersect16(valid.data(), scene, &context, &p);
    for (size_t i = 0; i < n; ++i)
      hits[first + i] = {p.ray.tfar[i], p.hit.u[i], p.hit.v[i], p.hit.geomID[i], p.hit.primID[i]};
  }
}

// Not told that they are coherent: Embree's frusta of rays pay in scenes of few large triangles (a
// tenth), and cost up to twice the time behind wires and leaves.
void occluded_packets(RTCScene scene, RTCIntersectContext& context, std::span<const Ray> rays,
                      std::span<uint8_t> is_occluded) {
  alignas(64) std::array<int, packet_size> valid{};
  for (size_t first = 0; first < rays.size(); first += packet_size) {
    const size_t n = std::min(packet_size, rays.size() - first);
    RTCRay16 p;
    fill(p, rays.subspan(first, n), valid);
    rtcOccluded16(valid.data(), scene, &context, &p);
    for (size_t i = 0; i < n; ++i) is_occluded[first + i] = valid[i] == 0 || p.tfar[i] < 0 ? 1 : 0;
  }
}

// 16 segments from `first` on; lanes without one, and untraceable ones, as in the fill above.
void fill(RTCRay16& p, const Segments& s, size_t first, std::array<int, packet_size>& valid) {
  const size_t n = std::min(packet_size, s.size() - first);
  const std::array<float*, Segments::coordinates> lanes{p.org_x, p.org_y, p.org_z,
                                                        p.dir_x, p.dir_y, p.dir_z};
  std::array<float, packet_size> reach{};
  for (size_t c = 0; c < lanes.size(); ++c) {
    const float* from = s.coordinate(c) + first;
    for (size_t i = 0; i < n; ++i) lanes[c][i] = from[i];
    for (size_t i = n; i < packet_size; ++i) lanes[c][i] = 1;
    for (size_t i = 0; i < packet_size; ++i) reach[i] += std::abs(lanes[c][i]);
  }
  bool are_fine = true;
  for (size_t i = 0; i < packet_size; ++i) {
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
    for (size_t i = 0; i < packet_size; ++i)
      if (!(reach[i] < 1e18f)) lane[i] = 1;
}

void append(RayLog& log, const Segments& s) {
  log.batches.push_back({log.rays.size(), s.size(), Coherence::coherent, true});
  for (size_t i = 0; i < s.size(); ++i)
    log.rays.push_back({{s.coordinate(0)[i], s.coordinate(1)[i], s.coordinate(2)[i]},
                        0,
                        {s.coordinate(3)[i], s.coordinate(4)[i], s.coordinate(5)[i]},
                        1});
}

}  // namespace

namespace {

void append(RayLog& log, std::span<const Ray> rays, Coherence coherence, bool is_occlusion) {
  log.batches.push_back({log.rays.size(), rays.size(), coherence, is_occlusion});
  log.rays.insert(log.rays.end(), rays.begin(), rays.end());
}

}  // namespace

void Tracer::closest(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence) const {
  if (log_ != nullptr) append(*log_, rays, coherence, false);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (coherence == Coherence::coherent) {
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    closest_packets(embree_->scene, context, rays, hits);
    return;
  }
  for (size_t i = 0; i < rays.size(); ++i) {
    hits[i] = {};
    if (!is_traceable(rays[i])) continue;
    RTCRayHit r;
    fill(r.ray, rays[i]);
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(embree_->scene, &context, &r);
    hits[i] = {r.ray.tfar, r.hit.u, r.hit.v, r.hit.geomID, r.hit.primID};
  }
}

void Tracer::occluded(std::span<const Ray> rays, std::span<uint8_t> is_occluded,
                      Coherence coherence) const {
  if (log_ != nullptr) append(*log_, rays, coherence, true);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (coherence == Coherence::coherent) {
    occluded_packets(embree_->scene, context, rays, is_occluded);
    return;
  }
  for (size_t i = 0; i < rays.size(); ++i) {
    is_occluded[i] = 1;
    if (!is_traceable(rays[i])) continue;
    RTCRay r;
    fill(r, rays[i]);
    rtcOccluded1(embree_->scene, &context, &r);
    is_occluded[i] = r.tfar < 0 ? 1 : 0;
  }
}

void Tracer::occluded(const Segments& segments, std::span<uint8_t> is_occluded) const {
  if (log_ != nullptr) append(*log_, segments);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  alignas(64) std::array<int, packet_size> valid{};
  RTCRay16 p;
  for (size_t first = 0; first < segments.size(); first += packet_size) {
    fill(p, segments, first, valid);
    rtcOccluded16(valid.data(), embree_->scene, &context, &p);
    const size_t n = std::min(packet_size, segments.size() - first);
    for (size_t i = 0; i < n; ++i) is_occluded[first + i] = valid[i] == 0 || p.tfar[i] < 0 ? 1 : 0;
  }
}

}  // namespace troffer
