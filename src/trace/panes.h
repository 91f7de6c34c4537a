// Panes: surfaces that hide nothing of a light, but take of it: clear thin glass. Shadow rays pass
// them; what of the light is left is asked for separately.
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

// Which surfaces are panes, and what they do: the tracer knows nothing of materials.
class PaneGlass {
 public:
  virtual ~PaneGlass() = default;
  virtual bool is_pane(uint32_t material) const = 0;
  // … of which the same can be said everywhere on it: transmittance_at() holds.
  virtual bool is_even(uint32_t material) const = 0;
  virtual Rgb transmittance_at(uint32_t material, float cosine) const = 0;
  // The share of its light that the pane which a ray has hit lets through straight on.
  virtual Rgb transmittance(const Ray& ray, const Hit& hit) const = 0;
};

// What panes leave of the light of each of some rays.
struct PaneFactors {
  std::vector<Rgb> values;  // empty: everything
  Rgb operator[](size_t i) const { return values.empty() ? Rgb{1} : values[i]; }
};

// Panes that light between two boxes may meet.
struct PanesBetween {
  bool are_any = false;
  bool are_simple = true;        // PanePlaces::transmittance() holds
  std::vector<uint32_t> places;  // where they are
};

// Where panes are, and what flat even ones do, without rays.
class PanePlaces {
 public:
  PanePlaces() = default;
  PanePlaces(const Scene& scene, const PaneGlass& glass);
  bool is_empty() const { return places_.empty(); }
  // Sets `out` to all that a segment between a point of each may meet.
  void between(const Box& a, const Box& b, PanesBetween& out) const;
  // What simple panes leave of light that comes to x over the way from x.
  Rgb transmittance(const PanesBetween& panes, const Vec3& x, const Vec3& way) const;

 private:
  struct Place {
    Box bounds;
    Vec3 normal;       // of a flat one; 0: it is not flat
    float height = 0;  // along the normal
    float slack = 0;   // metres by which it may be off that
    // Of a simple one, else empty: its triangles, and transmittance by the cosine of incidence at
    // even steps.
    std::vector<std::array<Vec3, 3>> triangles;
    std::vector<Rgb> by_cosine;
  };
  Place& add(const Box& bounds, const Vec3& normal, const std::vector<Vec3>& points);
  void make_simple(const Scene& scene, const MeshInWorld& mesh, const PaneGlass& glass,
                   Place& place);
  std::vector<Place> places_;
};

}  // namespace troffer
