// The sample points side by side, in blocks of one patch: what loops over many receivers read.
#pragma once

#include <vector>

#include "radiosity/meshing.h"

namespace troffer {

// Up to 16 consecutive points of one patch.
struct ReceiverBlock {
  static constexpr uint32_t most_points = 16;
  uint32_t first_point = 0, count = 0, patch = 0;
  uint32_t first_slot = 0;  // in Receivers' arrays
  Vec3 centre;
  float radius = 0;
  Vec3 normal;
  bool is_flat = false;  // all points in one plane, with this normal
};

// A block's points lie in consecutive slots, which are padded to a multiple of `lanes` by its last
// point; the slots of a patch's points are consecutive too.
struct Receivers {
  static constexpr uint32_t lanes = 8;
  std::vector<ReceiverBlock> blocks;
  std::vector<float> x, y, z, nx, ny, nz, offset;
  std::vector<uint32_t> first_slot;  // per patch
  explicit Receivers(const RadiosityMesh& mesh);
  size_t slots() const { return x.size(); }
  Vec3 position(size_t slot) const { return {x[slot], y[slot], z[slot]}; }
  Vec3 normal(size_t slot) const { return {nx[slot], ny[slot], nz[slot]}; }
};
inline uint32_t slots_of(const ReceiverBlock& b) {
  return (b.count + Receivers::lanes - 1) / Receivers::lanes * Receivers::lanes;
}
static_assert(ReceiverBlock::most_points % Receivers::lanes == 0);

// A piece of a shooter, small against its distance from receivers, as a point.
struct ShooterCell {
  Vec3 position, normal;
  float area = 0;      // m²
  float share = 1;     // of what it sends, relative to the shooter's mean
  Vec3 corners[3];     // where rays end; all the same for pieces of curved patches
  uint32_t group = 0;  // cells of one group lie side by side in one plane
};

// The one of `count` consecutive slots from `first` on whose point is nearest, by number from
// `first` on; the first of several.
uint32_t nearest_slot(const Receivers& receivers, uint32_t first, uint32_t count,
                      const Vec3& place);

// irradiance[i] per unit of the mean radiance, of `count` (a multiple of lanes) slots from `first`
// on; exact where cells are small and far.
void cells_irradiance(const Receivers& receivers, uint32_t first, uint32_t count,
                      const std::vector<ShooterCell>& cells, float* irradiance);

}  // namespace troffer
