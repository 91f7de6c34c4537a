#include "render/cell_pilot.h"

#include <algorithm>

#include "base/random.h"
#include "integrate/purposes.h"
#include "trace/surface.h"

namespace troffer {

namespace {

constexpr uint32_t rays_of_pilot = 8192;

}  // namespace

CellPilot picture_pilot(const ViewingCamera& camera, const ImageSize& size, uint64_t seed) {
  CellPilot pilot;
  const uint64_t stream = hash_of(seed, uint64_t{0x7069'6374});
  for (uint32_t i = 0; i < rays_of_pilot; ++i) {
    const SobolGroup random(stream, purpose_camera, i);
    const Vec2 at = random.get2(0);
    pilot.viewing.rays.push_back(
        camera.ray({at.x * float(size.width), at.y * float(size.height)}, random.get2(2)));
    pilot.viewing.streams.push_back(stream);
    pilot.viewing.samples.push_back(i);
  }
  return pilot;
}

CellPilot points_pilot(const PreparedScene& scene, const std::vector<MeasuringPoint>& points) {
  CellPilot pilot;
  const Box box = bounds(scene.scene);
  for (const MeasuringPoint& p : points) {
    const Vec3 position(p.position - scene.scene.origin), n = normalize(p.normal);
    pilot.places.push_back({position, n, n, offset_of_point(position, box)});
  }
  return pilot;
}

float offset_of_point(const Vec3& position, const Box& scene) {
  const Vec3 p = abs(position);
  return std::max(ray_offset(std::max({p.x, p.y, p.z})), std::min(1e-5f, 1e-6f * scene.diagonal()));
}

}  // namespace troffer
