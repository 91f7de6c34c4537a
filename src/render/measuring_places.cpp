#include "render/measuring_places.h"

#include <algorithm>
#include <array>

#include "base/frame.h"
#include "render/cell_pilot.h"
#include "trace/surface.h"

namespace troffer {

namespace {

// A corner of three walls has three surfaces.
constexpr int most_moves = 3;
// Surfaces at a smaller angle to the point's plane count as the point's own.
constexpr float least_sine = 0.05f;

// Finds another surface that passes through a place, and its unit normal. Short rays in the place's
// plane, along two axes in both directions, would hit it. At least one axis crosses any such
// surface, and one of its two rays starts on or before it, whatever the rounding.
bool surface_through(const PreparedScene& scene, const MeasuringPlace& place, Vec3& normal) {
  const Frame frame(place.normal);
  const float reach = place.offset / 16;  // some rounding errors of the coordinates
  std::array<Ray, 4> rays;
  for (size_t k = 0; k < rays.size(); ++k) {
    rays[k].origin = place.position + place.normal * place.offset;
    rays[k].direction = k < 2 ? frame.tangent : frame.bitangent;
    if (k % 2 == 1) rays[k].direction = -rays[k].direction;
    rays[k].t_max = reach;
  }
  std::array<Hit, 4> hits;
  scene.tracer.closest(rays, hits);
  for (size_t k = 0; k < rays.size(); ++k) {
    if (!hits[k].is_valid()) continue;
    normal = surface_at(scene.scene, rays[k], hits[k]).geometric_normal;
    if (length(normal - place.normal * dot(normal, place.normal)) >= least_sine) return true;
  }
  return false;
}

}  // namespace

std::vector<MeasuringPlace> measuring_places(const PreparedScene& scene,
                                             const std::vector<MeasuringPoint>& points) {
  const Box box = bounds(scene.scene);
  std::vector<MeasuringPlace> places;
  places.reserve(points.size());
  for (const MeasuringPoint& p : points) {
    MeasuringPlace place;
    place.position = Vec3(p.position - scene.scene.origin);
    place.normal = normalize(p.normal);
    place.offset = offset_of_point(place.position, box);
    Vec3 normal;
    for (int k = 0; k < most_moves && surface_through(scene, place, normal); ++k) {
      const Vec3 along = normal - place.normal * dot(normal, place.normal);
      place.position = place.position + along * (place.offset / dot(along, along));
      place.is_in_other = true;
    }
    places.push_back(place);
  }
  return places;
}

}  // namespace troffer
