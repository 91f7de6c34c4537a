#include "radiosity/receivers.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/simd.h"
#include "base/units.h"

namespace troffer {

namespace {

void bound(const RadiosityMesh& mesh, ReceiverBlock& b) {
  Vec3d centre;
  for (uint32_t i = 0; i < b.count; ++i)
    centre += Vec3d(mesh.points[b.first_point + i].position) / double(b.count);
  b.centre = Vec3(centre);
  b.normal = mesh.points[b.first_point].normal;
  b.is_flat = true;
  for (uint32_t i = 0; i < b.count; ++i) {
    const ElementPoint& p = mesh.points[b.first_point + i];
    const Vec3 d = p.position - b.centre;
    b.radius = std::max(b.radius, length(d));
    b.is_flat = b.is_flat && length_squared(p.normal - b.normal) < 1e-10f &&
                std::abs(dot(d, b.normal)) <= p.offset;
  }
}

}  // namespace

Receivers::Receivers(const RadiosityMesh& mesh) {
  for (const Patch& patch : mesh.patches) {
    first_slot.push_back(uint32_t(x.size()));
    for (uint32_t first = patch.first_point; first < patch.last_point;
         first += ReceiverBlock::most_points) {
      ReceiverBlock b;
      b.first_point = first;
      b.patch = mesh.points[first].patch;
      b.count = std::min(ReceiverBlock::most_points, patch.last_point - first);
      b.first_slot = uint32_t(x.size());
      bound(mesh, b);
      for (uint32_t i = 0; i < slots_of(b); ++i) {
        const ElementPoint& p = mesh.points[first + std::min(i, b.count - 1)];
        x.push_back(p.position.x);
        y.push_back(p.position.y);
        z.push_back(p.position.z);
        nx.push_back(p.normal.x);
        ny.push_back(p.normal.y);
        nz.push_back(p.normal.z);
        offset.push_back(p.offset);
      }
      blocks.push_back(b);
    }
  }
}

// First computes distances in batches, then the minimum: both loops are branch-free.
TROFFER_MULTIVERSION
uint32_t nearest_slot(const Receivers& r, uint32_t first, uint32_t count, const Vec3& place) {
  constexpr uint32_t most = 32;
  float squares[most];
  uint32_t nearest = 0;
  float least = std::numeric_limits<float>::infinity();
  for (uint32_t at = 0; at < count; at += most) {
    const uint32_t n = std::min(most, count - at);
    const float* const x = r.x.data() + first + at;
    const float* const y = r.y.data() + first + at;
    const float* const z = r.z.data() + first + at;
    for (uint32_t i = 0; i < n; ++i)
      squares[i] = sqr(x[i] - place.x) + sqr(y[i] - place.y) + sqr(z[i] - place.z);
    for (uint32_t i = 0; i < n; ++i) {
      nearest = squares[i] < least ? at + i : nearest;
      least = std::min(least, squares[i]);
    }
  }
  return nearest;
}

TROFFER_MULTIVERSION
void cells_irradiance(const Receivers& r, uint32_t first, uint32_t count,
                      const std::vector<ShooterCell>& cells, float* irradiance) {
  using Lanes = float __attribute__((vector_size(4 * Receivers::lanes)));
  const auto size = sizeof(Lanes);
  for (uint32_t at = first; at < first + count; at += Receivers::lanes) {
    Lanes x, y, z, nx, ny, nz, sum = {};
    std::memcpy(&x, &r.x[at], size);
    std::memcpy(&y, &r.y[at], size);
    std::memcpy(&z, &r.z[at], size);
    std::memcpy(&nx, &r.nx[at], size);
    std::memcpy(&ny, &r.ny[at], size);
    std::memcpy(&nz, &r.nz[at], size);
    for (const ShooterCell& c : cells) {
      const Lanes dx = c.position.x - x, dy = c.position.y - y, dz = c.position.z - z;
      const Lanes along = dx * nx + dy * ny + dz * nz;
      const Lanes facing = dx * -c.normal.x + dy * -c.normal.y + dz * -c.normal.z;
      const Lanes square = dx * dx + dy * dy + dz * dz;
      const Lanes value = along * facing / (square * square) * (c.area * c.share);
      const auto is_seen = (along > 0) & (facing > 0);
      sum += is_seen ? value : Lanes{};
    }
    std::memcpy(irradiance + (at - first), &sum, size);
  }
}

}  // namespace troffer
