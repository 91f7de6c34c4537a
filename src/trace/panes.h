// Panes: clear thin glass, which transmits light without bending it. Shadow rays pass panes, and
// their transmittance is computed separately.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/box.h"
#include "base/rgb.h"
#include "scene/mesh_in_world.h"
#include "scene/scene.h"
#include "trace/ray.h"

namespace troffer {

// Tells which materials are panes, and their transmittance. The tracer itself knows nothing of
// materials.
class PaneGlass {
 public:
  virtual ~PaneGlass() = default;
  virtual bool is_pane(uint32_t material) const = 0;
  // True if the pane is uniform, so that transmittance_at() holds everywhere on it.
  virtual bool is_even(uint32_t material) const = 0;
  // Returns the transmittance of a uniform pane by the cosine of incidence.
  virtual Rgb transmittance_at(uint32_t material, float cosine) const = 0;
  // Returns the transmittance of a pane along `ray`, at its hit.
  virtual Rgb transmittance(const Ray& ray, const Hit& hit) const = 0;
};

// Transmittance of the panes on each of some rays.
struct PaneFactors {
  std::vector<Rgb> values;  // empty: 1 for all rays
  Rgb operator[](size_t i) const { return values.empty() ? Rgb{1} : values[i]; }
};

// Panes that light between two boxes may meet.
struct PanesBetween {
  bool are_any = false;
  bool are_simple = true;        // PanePlaces::transmittance() is exact
  std::vector<uint32_t> places;  // indices of places
};

// Positions of panes, and the transmittance of flat uniform ones, without rays. Immutable and
// thread safe after construction.
class PanePlaces {
 public:
  PanePlaces() = default;
  PanePlaces(const Scene& scene, const PaneGlass& glass);
  bool is_empty() const { return places_.empty(); }
  // Sets `out` to all panes that a segment between a point of `a` and a point of `b` may meet.
  void between(const Box& a, const Box& b, PanesBetween& out) const;
  // Returns the transmittance of simple panes for light that reaches x from x + way.
  Rgb transmittance(const PanesBetween& panes, const Vec3& x, const Vec3& way) const;

 private:
  struct Place {
    Box bounds;
    Vec3 normal;       // normal of a flat pane; 0: not flat
    float height = 0;  // along the normal
    float slack = 0;   // possible distance from that plane, metres
    // Triangles of a simple pane, and its transmittance at even steps of the cosine of incidence.
    // Empty for other panes.
    std::vector<std::array<Vec3, 3>> triangles;
    std::vector<Rgb> by_cosine;
  };
  Place& add(const Box& bounds, const Vec3& normal, const std::vector<Vec3>& points);
  void make_simple(const Scene& scene, const MeshInWorld& mesh, const PaneGlass& glass,
                   Place& place);
  std::vector<Place> places_;
};

}  // namespace troffer
