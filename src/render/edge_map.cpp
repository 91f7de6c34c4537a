#include "render/edge_map.h"

#include <cmath>

#include "base/parallel.h"
#include "render/light_outlines.h"
#include "trace/surface.h"

namespace troffer {

namespace {

// What the ray through a corner of a pixel meets.
struct Corner {
  uint32_t geometry = no_geometry;
  bool is_front = true;
  Vec3 normal, position;  // the normal as shaded, on the viewer's side
};

// The same object, facing about the same way (within 25 degrees, as is_same_surface of
// shadow_record.h), and no step from one to the other.
bool is_same(const Corner& a, const Corner& b) {
  constexpr float cos_same_way = 0.906f, sin_step = 0.45f;
  if (a.geometry != b.geometry) return false;
  if (a.geometry == no_geometry) return true;
  if (a.is_front != b.is_front || dot(a.normal, b.normal) < cos_same_way) return false;
  const Vec3 d = b.position - a.position;
  return std::abs(dot(d, a.normal)) <= sin_step * length(d) ||
         std::abs(dot(d, b.normal)) <= sin_step * length(d);
}

std::vector<Corner> trace_corners(const PreparedScene& scene, const ViewingCamera& camera,
                                  const PixelRect& region, int threads) {
  // Where a ray runs into an edge, which of its two surfaces it meets may depend on the packet in
  // which it is traced: packets are those of the whole picture, whatever the region.
  constexpr size_t packet = 16;
  const size_t columns = size_t(region.width()) + 1, rows = size_t(region.height()) + 1;
  const size_t before = size_t(region.x0) % packet,
               traced = (before + columns + packet - 1) / packet * packet;
  std::vector<Corner> corners(columns * rows);
  parallel_for(rows, threads, [&](size_t row) {
    std::vector<Ray> rays(traced);
    std::vector<Hit> hits(traced);
    for (size_t i = 0; i < traced; ++i)
      rays[i] =
          camera.ray({float(region.x0) + float(i) - float(before), float(region.y0) + float(row)},
                     {0.5f, 0.5f});
    scene.tracer.closest(rays, hits, Coherence::coherent, Meeting::as_seen);
    for (size_t i = 0; i < columns; ++i) {
      if (!hits[before + i].is_valid()) continue;
      const Surface s = surface_at(scene.scene, rays[before + i], hits[before + i]);
      Corner& c = corners[row * columns + i];
      c.geometry = s.geometry;
      c.is_front = dot(s.geometric_normal, rays[before + i].direction) <= 0;
      c.normal = c.is_front ? s.shading_normal : -s.shading_normal;
      c.position = s.position;
    }
  });
  return corners;
}

}  // namespace

EdgeMap::EdgeMap(const PreparedScene& scene, const ViewingCamera& camera, const PixelRect& region,
                 int threads)
    : region_(region), edges_(size_t(region.width()) * size_t(region.height()), 0) {
  const std::vector<Corner> corners = trace_corners(scene, camera, region, threads);
  const size_t columns = size_t(region.width()) + 1;
  for (int y = region.y0; y < region.y1; ++y)
    for (int x = region.x0; x < region.x1; ++x) {
      const Corner* c = &corners[size_t(y - region.y0) * columns + size_t(x - region.x0)];
      // All six pairs: what is alike need not be so by way of a third.
      if (!is_same(c[0], c[1]) || !is_same(c[0], c[columns]) || !is_same(c[0], c[columns + 1]) ||
          !is_same(c[1], c[columns]) || !is_same(c[1], c[columns + 1]) ||
          !is_same(c[columns], c[columns + 1]))
        edges_[index(x, y)] |= surface_edge;
    }
  for (const Pixel2& p : pixels_on_light_outlines(scene, camera, region))
    edges_[index(p.x, p.y)] |= light_edge;
}

}  // namespace troffer
