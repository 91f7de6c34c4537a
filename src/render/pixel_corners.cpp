#include "render/pixel_corners.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "trace/surface.h"

namespace troffer {

bool SeenPlace::is_of_surface_of(const SeenPlace& o) const {
  constexpr float cos_same_way = 0.906f, sin_step = 0.45f;
  if (geometry != o.geometry) return false;
  if (geometry == no_geometry) return true;
  if (is_front != o.is_front || dot(normal, o.normal) < cos_same_way) return false;
  const Vec3 d = o.position - position, size = abs(position);
  // The positions are equal but for rounding, so d has no direction.
  if (length(d) <= ray_offset(std::max({size.x, size.y, size.z}))) return true;
  return std::abs(dot(d, normal)) <= sin_step * length(d) ||
         std::abs(dot(d, o.normal)) <= sin_step * length(d);
}

PixelCorners::PixelCorners(const PreparedScene& scene, const ViewingCamera& camera,
                           const PixelRect& region, int threads)
    : region_(region), columns_(size_t(region.width()) + 1) {
  // The surface that a ray along an edge meets may depend on its packet. Packets are therefore
  // aligned to the whole picture, whatever the region.
  constexpr size_t packet = 16;
  const size_t rows = size_t(region.height()) + 1;
  const size_t before = size_t(region.x0) % packet,
               traced = (before + columns_ + packet - 1) / packet * packet;
  corners_.resize(columns_ * rows);
  parallel_for(rows, threads, [&](size_t row) {
    std::vector<Ray> rays(traced);
    std::vector<Hit> hits(traced);
    for (size_t i = 0; i < traced; ++i)
      rays[i] =
          camera.ray({float(region.x0) + float(i) - float(before), float(region.y0) + float(row)},
                     {0.5f, 0.5f});
    scene.tracer.closest(rays, hits, Coherence::coherent, Meeting::as_seen);
    for (size_t i = 0; i < columns_; ++i) {
      if (!hits[before + i].is_valid()) continue;
      const Surface s = surface_at(scene.scene, rays[before + i], hits[before + i]);
      SeenPlace& c = corners_[row * columns_ + i];
      c.geometry = s.geometry;
      c.is_front = dot(s.geometric_normal, rays[before + i].direction) <= 0;
      c.normal = c.is_front ? s.shading_normal : -s.shading_normal;
      c.position = s.position;
    }
  });
}

bool PixelCorners::differ(int x, int y) const {
  const SeenPlace* c = &of(x, y);
  const std::array<const SeenPlace*, 4> four{c, c + 1, c + columns_, c + columns_ + 1};
  // All six pairs, since similarity is not transitive.
  for (size_t i = 0; i < 4; ++i)
    for (size_t j = i + 1; j < 4; ++j)
      if (!four[i]->is_of_surface_of(*four[j])) return true;
  return false;
}

}  // namespace troffer
