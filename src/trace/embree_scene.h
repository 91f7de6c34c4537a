// The scene in Embree. Only tracer.cpp and embree_scene.cpp include this header.
#pragma once

#include <embree3/rtcore.h>

#include <string>
#include <utility>
#include <vector>

#include "trace/tracer.h"

namespace troffer {

// Context of a query. Embree passes it to the filters with each hit.
struct Context {
  RTCIntersectContext embree;  // must be the first member: Embree gets its address
  Meeting meeting;
  bool is_through = false;  // every pane is hit, except in its holes: for transmittance

  explicit Context(Meeting what, bool goes_through = false)
      : meeting(what), is_through(goes_through) {
    rtcInitIntersectContext(&embree);
  }
};

// Data of the filters of one geometry: holes, invisible back faces and panes.
struct HitTest {
  const Scene* scene = nullptr;
  const Mesh* mesh = nullptr;  // null: spheres or disks
  bool has_holes = false, hides_backs = false, has_panes = false;
  bool hides_in_places = false;               // panes are opaque where alpha is 1
  std::vector<uint8_t> is_pane;               // per primitive; empty: all are panes, if any is
  std::vector<uint8_t> has_coincident_front;  // per triangle (coincident_fronts); empty: none has

  bool is_pane_at(uint32_t primitive) const {
    return has_panes && (is_pane.empty() || is_pane[primitive] != 0);
  }
};

// Translates Embree's instance numbers to those of Hit.
struct InstanceNumbers {
  uint32_t first = 0;  // geometry number of the first instance
  std::vector<uint8_t> is_mirrored;

  // Sets geometry and barycentric weights of a hit. instance: geometry number, or
  // RTC_INVALID_GEOMETRY_ID. In a mirrored instance, vertices 1 and 2 change places.
  void apply(uint32_t instance, Hit& hit) const {
    if (instance == RTC_INVALID_GEOMETRY_ID || !hit.is_valid()) return;
    hit.geometry = instance;
    if (is_mirrored[instance - first] != 0) std::swap(hit.u, hit.v);
  }
};

struct EmbreeStatus {
  RTCError code = RTC_ERROR_NONE;
  std::string text;
};

struct Tracer::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  RTCScene panes = nullptr;  // panes only, with the same numbers; null: none
  EmbreeStatus status;
  std::vector<HitTest> tests;  // per mesh, then spheres, disks, and instanced meshes
  InstanceNumbers instances;
  size_t pane_triangles = 0;
  size_t packet_size = 8;  // rays per packet: 16 where Embree supports that natively, else 8

  // Throws EnvironmentError if memory runs out.
  Embree(const Scene& scene, const PaneGlass* glass);
  ~Embree();
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;

 private:
  void throw_if_failed() const;
  void* buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, size_t stride,
               size_t count);
  void set_vertices(RTCGeometry geometry, const std::vector<Vec3>& positions);
  void attach(RTCGeometry geometry, uint32_t id);
  void attach_pane(RTCGeometry geometry, uint32_t id);
  RTCScene new_scene() const;
  void commit(RTCScene scene, size_t triangles) const;
  RTCGeometry make_mesh(const Scene& s, const Mesh& mesh, uint32_t test, const PaneGlass* glass);
  void add_mesh(const Scene& s, uint32_t id, const PaneGlass* glass);
  void add_instances(const Scene& s, const PaneGlass* glass);
  void add_spheres(const Scene& s, const PaneGlass* glass);
  void add_disks(const Scene& s, const PaneGlass* glass);
  void set_filters(RTCGeometry geometry, uint32_t id);
  template <class Shapes>
  void mark_panes(RTCGeometry geometry, uint32_t id, const Shapes& shapes, const PaneGlass* glass);
};

}  // namespace troffer
