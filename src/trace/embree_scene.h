// The scene as Embree has it: of the tracer's own files alone.
#pragma once

#include <embree3/rtcore.h>

#include <string>
#include <utility>
#include <vector>

#include "trace/tracer.h"

namespace troffer {

// Of all rays: filters get it with each hit.
struct Context {
  RTCIntersectContext embree;  // the first member: Embree knows the address of this
  Meeting meeting;
  bool is_through = false;  // every pane is met, but for its holes: to ask what panes take

  explicit Context(Meeting what, bool goes_through = false)
      : meeting(what), is_through(goes_through) {
    rtcInitIntersectContext(&embree);
  }
};

// What of a geometry is not there for some rays, or has holes.
struct HitTest {
  const Scene* scene = nullptr;
  const Mesh* mesh = nullptr;  // null: spheres or disks
  bool has_holes = false, hides_backs = false, has_panes = false;
  bool hides_in_places = false;  // panes are opaque where alpha is 1
  std::vector<uint8_t> is_pane;  // per primitive; empty: all are, where it has any
  std::vector<uint8_t> has_coincident_front;  // per triangle (coincident_fronts); empty: none has

  bool is_pane_at(uint32_t primitive) const {
    return has_panes && (is_pane.empty() || is_pane[primitive] != 0);
  }
};

// From what Embree says of instances to our numbers.
struct InstanceNumbers {
  uint32_t first = 0;  // geometry of the first one
  std::vector<uint8_t> is_mirrored;

  // instance: geometry number, or RTC_INVALID_GEOMETRY_ID. In a mirrored one vertices 1 and 2
  // change places.
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
  RTCScene panes = nullptr;  // alone, by the same numbers; null: there are none
  EmbreeStatus status;
  std::vector<HitTest> tests;  // per mesh, of all spheres, of all disks, per instanced mesh
  InstanceNumbers instances;
  size_t pane_triangles = 0;
  size_t packet_size = 8;  // of rays: 8, or 16 where Embree has these as they are

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
