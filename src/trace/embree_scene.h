// The scene as Embree has it: of the tracer's own files alone.
#pragma once

#include <embree3/rtcore.h>

#include <string>
#include <vector>

#include "trace/tracer.h"

namespace troffer {

// Of all rays: filters get it with each hit.
struct Context {
  RTCIntersectContext embree;  // the first member: Embree knows the address of this
  Meeting meeting;

  explicit Context(Meeting what) : meeting(what) { rtcInitIntersectContext(&embree); }
};

// What of a geometry is not there for some rays, or has holes.
struct HitTest {
  const Scene* scene = nullptr;
  const Mesh* mesh = nullptr;  // null: spheres or disks
  bool has_holes = false, hides_backs = false, has_panes = false;
  std::vector<uint8_t> is_pane;  // per primitive; empty: all are, where it has any

  bool is_pane_at(uint32_t primitive) const {
    return has_panes && (is_pane.empty() || is_pane[primitive] != 0);
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
  std::vector<HitTest> tests;  // per mesh, of all spheres, of all disks

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
  void add_mesh(const Scene& s, uint32_t id, const PaneGlass* glass);
  void add_spheres(const Scene& s, const PaneGlass* glass);
  void add_disks(const Scene& s, const PaneGlass* glass);
  void set_filters(RTCGeometry geometry, uint32_t id);
  template <class Shapes>
  void mark_panes(RTCGeometry geometry, uint32_t id, const Shapes& shapes, const PaneGlass* glass);
};

}  // namespace troffer
