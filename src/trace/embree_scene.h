// The scene as Embree has it: of the tracer's own files alone.
#pragma once

#include <embree3/rtcore.h>

#include <string>
#include <vector>

#include "trace/tracer.h"

namespace troffer {

// What an alpha test needs to know of its mesh.
struct AlphaTest {
  const Scene* scene;
  const Mesh* mesh;
};

// Of all rays: filters get it with each hit.
struct Context {
  RTCIntersectContext embree;  // the first member: Embree knows the address of this
  bool skips_panes = false;

  explicit Context(bool without_panes) : skips_panes(without_panes) {
    rtcInitIntersectContext(&embree);
  }
};

// Of a geometry of which some are panes.
struct PaneTest {
  bool has_panes = false;
  std::vector<uint8_t> is_pane;  // per primitive; empty: all are
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
  std::vector<AlphaTest> alpha_tests;
  std::vector<PaneTest> pane_tests;  // per mesh, of all spheres, of all disks

  // Throws EnvironmentError if memory runs out.
  Embree(const Scene& scene, const PaneGlass* glass);
  ~Embree();
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;

 private:
  void throw_if_failed() const;
  void* buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, size_t stride,
               size_t count);
  void attach(RTCGeometry geometry, uint32_t id);
  void add_mesh(const Scene& s, uint32_t id, const PaneGlass* glass);
  void add_spheres(const Scene& s, const PaneGlass* glass);
  void add_disks(const Scene& s, const PaneGlass* glass);
  void set_pane_test(RTCGeometry geometry, uint32_t id, std::vector<uint8_t> is_pane);
  template <class Shapes>
  void mark_panes(RTCGeometry geometry, uint32_t id, const Shapes& shapes, const PaneGlass* glass);
};

}  // namespace troffer
