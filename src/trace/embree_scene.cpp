#include "trace/embree_scene.h"

#include <algorithm>
#include <array>
#include <bit>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "scene/mesh_in_world.h"
#include "trace/coincident_fronts.h"

namespace troffer {

namespace {

float coverage_at(const HitTest& test, uint32_t primitive, float u, float v) {
  const Triangle& t = test.mesh->triangles[primitive];
  Vec2 uv{0, 0};
  if (!test.mesh->uvs.empty()) {
    const auto& c = test.mesh->uvs;
    uv = c[t[0]] * (1 - u - v) + c[t[1]] * u + c[t[2]] * v;
  }
  return coverage(test.scene->textures, test.scene->materials[test.mesh->material], uv);
}

// Returns a number in [0,1) that is a hash of ray and triangle, so it does not depend on how often
// or in which packet Embree asks. Rays must differ from sample to sample. The ray is in the space
// of the instance, so a ray along an axis of symmetry is the same in two instances of one mesh:
// their numbers differ by the instance.
float draw_of(const RTCFilterFunctionNArguments* args, unsigned i) {
  const auto bits = [](float f) { return uint64_t(std::bit_cast<uint32_t>(f)); };
  const auto pair = [&](float f, float g) { return bits(f) << 32 | bits(g); };
  RTCRayN* const ray = args->ray;
  const unsigned n = args->N;
  uint64_t hash =
      hash_of(pair(RTCRayN_org_x(ray, n, i), RTCRayN_org_y(ray, n, i)),
              pair(RTCRayN_org_z(ray, n, i), RTCRayN_dir_x(ray, n, i)),
              pair(RTCRayN_dir_y(ray, n, i), RTCRayN_dir_z(ray, n, i)),
              uint64_t(RTCHitN_geomID(args->hit, n, i)) << 32 | RTCHitN_primID(args->hit, n, i));
  const unsigned instance = RTCHitN_instID(args->hit, n, i, 0);
  if (instance != RTC_INVALID_GEOMETRY_ID) hash = hash_combine(hash, instance);
  return unit_float(uint32_t(hash >> 32));
}

float coverage_at(const HitTest& test, const RTCFilterFunctionNArguments* args, unsigned i) {
  return coverage_at(test, RTCHitN_primID(args->hit, args->N, i), RTCHitN_u(args->hit, args->N, i),
                     RTCHitN_v(args->hit, args->N, i));
}

// True if the ray passes through the hit: it is in a hole, or partly covered and drawn to pass.
bool is_in_hole(const HitTest& test, const RTCFilterFunctionNArguments* args, unsigned i) {
  if (!test.has_holes) return false;
  const float share = coverage_at(test, args, i);
  return share <= 0 || (share < 1 && draw_of(args, i) >= share);
}

// True if the hit lies on a pane that transmits light there.
bool is_passed(const HitTest& test, const RTCFilterFunctionNArguments* args, unsigned i) {
  return test.is_pane_at(RTCHitN_primID(args->hit, args->N, i)) &&
         (!test.hides_in_places || coverage_at(test, args, i) < 1);
}

bool is_from_behind(const RTCFilterFunctionNArguments* args, unsigned i) {
  const unsigned n = args->N;
  return RTCHitN_Ng_x(args->hit, n, i) * RTCRayN_dir_x(args->ray, n, i) +
             RTCHitN_Ng_y(args->hit, n, i) * RTCRayN_dir_y(args->ray, n, i) +
             RTCHitN_Ng_z(args->hit, n, i) * RTCRayN_dir_z(args->ray, n, i) >
         0;
}

bool is_skipped(const HitTest& test, const Context& context,
                const RTCFilterFunctionNArguments* args, unsigned i) {
  if (!test.has_coincident_front.empty() &&
      test.has_coincident_front[RTCHitN_primID(args->hit, args->N, i)] != 0 &&
      is_from_behind(args, i))
    return true;
  if (context.is_through) return test.has_holes && coverage_at(test, args, i) <= 0;
  switch (context.meeting) {
    case Meeting::all:
      break;
    case Meeting::no_panes:
      if (is_passed(test, args, i)) return true;
      break;
    case Meeting::as_seen:
      if (test.hides_backs && is_from_behind(args, i)) return true;
      break;
  }
  return is_in_hole(test, args, i);
}

void closest_filter(const RTCFilterFunctionNArguments* args) {
  const auto& test = *static_cast<const HitTest*>(args->geometryUserPtr);
  const Context& context = *reinterpret_cast<const Context*>(args->context);
  for (unsigned i = 0; i < args->N; ++i)
    if (args->valid[i] == -1 && is_skipped(test, context, args, i)) args->valid[i] = 0;
}

void occluded_filter(const RTCFilterFunctionNArguments* args) {
  const auto& test = *static_cast<const HitTest*>(args->geometryUserPtr);
  for (unsigned i = 0; i < args->N; ++i)
    if (args->valid[i] == -1 && (is_passed(test, args, i) || is_in_hole(test, args, i)))
      args->valid[i] = 0;
}

void on_error(void* user, RTCError code, const char* text) {
  auto& status = *static_cast<EmbreeStatus*>(user);
  if (status.code != RTC_ERROR_NONE) return;
  status.code = code;
  status.text = text != nullptr ? text : "";
}

}  // namespace

void Tracer::Embree::throw_if_failed() const {
  if (status.code == RTC_ERROR_NONE) return;
  throw EnvironmentError(
      "cannot build the ray tracing structure: " +
      (status.code == RTC_ERROR_OUT_OF_MEMORY ? std::string("out of memory") : status.text));
}

void* Tracer::Embree::buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format,
                             size_t stride, size_t count) {
  void* data =
      rtcSetNewGeometryBuffer(geometry, type, 0, format, stride, std::max<size_t>(count, 1));
  throw_if_failed();
  return data;
}

void Tracer::Embree::attach(RTCGeometry geometry, uint32_t id) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  if (tests[id].has_panes) attach_pane(geometry, id);
  rtcReleaseGeometry(geometry);
}

void Tracer::Embree::attach_pane(RTCGeometry geometry, uint32_t id) {
  if (panes == nullptr) panes = rtcNewScene(device);
  rtcSetSceneFlags(panes, RTC_SCENE_FLAG_ROBUST);
  rtcAttachGeometryByID(panes, geometry, id);
}

// Commits a scene. The order of primitives in the tree's leaves decides between coincident
// surfaces, and it is reproducible only if one thread builds the tree. Large scenes would take too
// long and are built on all cores.
void Tracer::Embree::commit(RTCScene to_build, size_t triangles) const {
  constexpr size_t large = 400'000;
  if (triangles > large)
    rtcCommitScene(to_build);
  else
    run_on_one_thread([&] { rtcJoinCommitScene(to_build); });
  throw_if_failed();
}

RTCScene Tracer::Embree::new_scene() const {
  RTCScene made = rtcNewScene(device);
  rtcSetSceneFlags(made, RTC_SCENE_FLAG_ROBUST);  // no light leaks through shared edges
  rtcSetSceneBuildQuality(made, RTC_BUILD_QUALITY_HIGH);
  return made;
}

void Tracer::Embree::set_filters(RTCGeometry g, uint32_t id) {
  const HitTest& test = tests[id];
  rtcSetGeometryUserData(g, &tests[id]);
  if (test.has_holes || test.hides_backs || test.has_panes)
    rtcSetGeometryIntersectFilterFunction(g, closest_filter);
  if (test.has_holes || test.has_panes) rtcSetGeometryOccludedFilterFunction(g, occluded_filter);
}

// Shares the mesh's own vertices if memory follows them (with_room_for_tracer), because Embree
// reads them in 16-byte loads. Otherwise copies them.
void Tracer::Embree::set_vertices(RTCGeometry g, const std::vector<Vec3>& positions) {
  static_assert(sizeof(Vec3) == 3 * sizeof(float));
  if (positions.capacity() > positions.size()) {
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions.data(), 0,
                               sizeof(Vec3), positions.size());
    throw_if_failed();
    return;
  }
  auto* p = static_cast<float*>(
      buffer(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 3 * sizeof(float), positions.size()));
  for (size_t i = 0; i < positions.size(); ++i)
    for (size_t a = 0; a < 3; ++a) p[3 * i + a] = positions[i][a];
}

RTCGeometry Tracer::Embree::make_mesh(const Scene& s, const Mesh& mesh, uint32_t id,
                                      const PaneGlass* glass) {
  RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  set_vertices(g, mesh.positions);
  static_assert(sizeof(Triangle) == 3 * sizeof(uint32_t));
  rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(),
                             0, sizeof(Triangle), mesh.triangles.size());
  throw_if_failed();
  HitTest& test = tests[id];
  test.scene = &s;
  test.mesh = &mesh;
  const Material& m = s.materials[mesh.material];
  test.has_holes = m.is_alpha_masked;
  test.hides_backs = m.back_faces == BackFaces::unseen;
  test.has_panes = glass != nullptr && glass->is_pane(mesh.material);
  test.hides_in_places = test.has_panes && m.is_alpha_masked && m.alpha.texture >= 0;
  if (test.has_panes) pane_triangles += mesh.triangles.size();
  set_filters(g, id);
  return g;
}

void Tracer::Embree::add_mesh(const Scene& s, uint32_t id, const PaneGlass* glass) {
  if (!s.meshes[id].triangles.empty()) attach(make_mesh(s, s.meshes[id], id, glass), id);
}

// Adds the instances. Filters of an instanced mesh see rays in the mesh's space, where front and
// back are the same. Under a mirroring transform the vertices run the other way.
void Tracer::Embree::add_instances(const Scene& s, const PaneGlass* glass) {
  const uint32_t first_test = instances.first;
  std::vector<RTCScene> spaces;
  for (uint32_t i = 0; i < s.instanced_meshes.size(); ++i) {
    const Mesh& mesh = s.instanced_meshes[i];
    spaces.push_back(new_scene());
    RTCGeometry g = make_mesh(s, mesh, first_test + i, glass);
    rtcCommitGeometry(g);
    rtcAttachGeometryByID(spaces.back(), g, 0);
    rtcReleaseGeometry(g);
    commit(spaces.back(), mesh.triangles.size());
  }
  instances.is_mirrored.reserve(s.instances.size());
  for (const Instance& instance : s.instances) {
    const uint32_t id = instances.first + uint32_t(instances.is_mirrored.size());
    instances.is_mirrored.push_back(instance.is_mirrored ? 1 : 0);
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(g, spaces[instance.mesh]);
    const Affine& m = instance.world_from_mesh;
    std::array<float, 12> columns{};
    for (size_t a = 0; a < 3; ++a) {
      for (size_t c = 0; c < 3; ++c) columns[3 * c + a] = float(m.columns[c][a]);
      columns[9 + a] = float(m.translation[a]);
    }
    rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
    rtcCommitGeometry(g);
    rtcAttachGeometryByID(scene, g, id);
    if (tests[first_test + instance.mesh].has_panes) attach_pane(g, id);
    rtcReleaseGeometry(g);
    throw_if_failed();
  }
  for (RTCScene space : spaces) rtcReleaseScene(space);  // instances keep them
}

// Marks the panes among the shapes of one geometry.
template <class Shapes>
void Tracer::Embree::mark_panes(RTCGeometry g, uint32_t id, const Shapes& shapes,
                                const PaneGlass* glass) {
  if (glass == nullptr) return;
  std::vector<uint8_t> is_pane;
  for (const auto& shape : shapes) is_pane.push_back(glass->is_pane(shape.material) ? 1 : 0);
  if (std::find(is_pane.begin(), is_pane.end(), 1) == is_pane.end()) return;
  tests[id].has_panes = true;
  tests[id].is_pane = std::move(is_pane);
  set_filters(g, id);
}

void Tracer::Embree::add_spheres(const Scene& s, const PaneGlass* glass) {
  if (s.spheres.empty()) return;
  RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  auto* p = static_cast<float*>(
      buffer(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 4 * sizeof(float), s.spheres.size()));
  for (const Sphere& sphere : s.spheres) {
    for (size_t a = 0; a < 3; ++a) *p++ = sphere.centre[a];
    *p++ = sphere.radius;
  }
  const auto id = uint32_t(s.meshes.size());
  mark_panes(g, id, s.spheres, glass);
  attach(g, id);
}

void Tracer::Embree::add_disks(const Scene& s, const PaneGlass* glass) {
  if (s.disks.empty()) return;
  RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT);
  auto* p = static_cast<float*>(
      buffer(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 4 * sizeof(float), s.disks.size()));
  auto* n = static_cast<float*>(
      buffer(g, RTC_BUFFER_TYPE_NORMAL, RTC_FORMAT_FLOAT3, 3 * sizeof(float), s.disks.size()));
  for (const Disk& disk : s.disks) {
    for (size_t a = 0; a < 3; ++a) {
      *p++ = disk.centre[a];
      *n++ = disk.normal[a];
    }
    *p++ = disk.radius;
  }
  const auto id = uint32_t(s.meshes.size()) + 1;
  mark_panes(g, id, s.disks, glass);
  attach(g, id);
}

Tracer::Embree::Embree(const Scene& s, const PaneGlass* glass) {
  device = rtcNewDevice(nullptr);
  if (device == nullptr) throw EnvironmentError("cannot start Embree");
  rtcSetDeviceErrorFunction(device, on_error, &status);
  if (rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0)
    packet_size = 16;
  scene = new_scene();
  instances.first = first_instance(s);
  tests.resize(instances.first + s.instanced_meshes.size());
  std::vector<std::vector<uint8_t>> fronts = coincident_fronts(s);
  for (uint32_t i = 0; i < s.meshes.size(); ++i) {
    tests[i].has_coincident_front = std::move(fronts[i]);
    add_mesh(s, i, glass);
  }
  add_spheres(s, glass);
  add_disks(s, glass);
  add_instances(s, glass);
  size_t items = s.instances.size();
  for (const Mesh& mesh : s.meshes) items += mesh.triangles.size();
  commit(scene, items);
  if (panes != nullptr) commit(panes, pane_triangles);
}

Tracer::Embree::~Embree() {
  if (panes != nullptr) rtcReleaseScene(panes);
  if (scene != nullptr) rtcReleaseScene(scene);
  if (device != nullptr) rtcReleaseDevice(device);
}

}  // namespace troffer
