// Sample points as arrays, in blocks of one patch, for vectorised loops over many receivers. Rows
// and shots of patches (patch_rows.h, patch_shots.h) use it. Positions are in world space, offsets
// in metres.
#pragma once

#include <vector>

#include "radiosity/meshing.h"

namespace troffer {

// Block of up to 16 consecutive points of one patch.
struct ReceiverBlock {
  static constexpr uint32_t most_points = 16;
  uint32_t first_point = 0, count = 0, patch = 0;
  uint32_t first_slot = 0;  // in the arrays of Receivers
  Vec3 centre;
  float radius = 0;
  Vec3 normal;
  bool is_flat = false;  // all points lie in one plane with this normal
};

// Arrays of all points. A block's points occupy consecutive slots, padded with copies of its last
// point to a multiple of `lanes`. The slots of one patch are consecutive.
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

// Piece of a shooter that counts as a point because it is small relative to its distance.
struct ShooterCell {
  Vec3 position, normal;
  float area = 0;      // m²
  float share = 1;     // radiance relative to the shooter's mean
  Vec3 corners[3];     // ray ends are sampled here; all equal for curved patches
  uint32_t group = 0;  // cells of one group are adjacent in one plane
};

// Returns the nearest point to `place` among `count` slots from `first` on, relative to `first`.
// Ties go to the first.
uint32_t nearest_slot(const Receivers& receivers, uint32_t first, uint32_t count,
                      const Vec3& place);

// Computes irradiance[i] per unit of mean radiance, for `count` slots (a multiple of lanes) from
// `first` on. Exact for cells that are small and distant.
void cells_irradiance(const Receivers& receivers, uint32_t first, uint32_t count,
                      const std::vector<ShooterCell>& cells, float* irradiance);

}  // namespace troffer
