// Storage of one row of patch_rows.h, and the context in which a row is computed. NearBlocks,
// FarBlocks and PatchRows share it. Values are per unit of the patch's mean radiance.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/form_factors.h"
#include "radiosity/receivers.h"
#include "radiosity/shooter_cells.h"

namespace troffer {

// Visibility of the patch from a block of receivers. listed: dark, and contained in a list of
// contributions.
enum class BlockView : uint16_t { none, lit, dark, listed, partly, near };

// Encodes, in 16 bits, an upper bound on the unoccluded irradiance in a dark block.
uint16_t dark_bits(float most);
float dark_most(uint16_t bits);

struct NearPart {
  uint16_t part, all, visible;  // shares of the point's irradiance, in 65535ths
};

struct NearPoint {
  float unoccluded = 0;
  uint32_t first = 0, last = 0;  // range in `parts`
};

// Results for some consecutive blocks.
struct RowChunk {
  static constexpr size_t most_blocks = 64;
  std::vector<BlockView> view;  // per block
  // per block; partly: index in `visible`; near: in `points`; dark: bits
  std::vector<uint16_t> first;
  std::vector<uint8_t> visible;  // visible shares, in 255ths
  std::vector<NearPoint> points;
  std::vector<NearPart> parts;
  size_t bytes() const;
  void clear(size_t blocks);  // makes `blocks` blocks, all out of sight
};

// The patch that a row belongs to. Rows are computed for uniform radiance over the patch, because
// the radiance of its parts changes from shot to shot.
struct RowShooter {
  std::vector<ShooterCell> cells;  // with share 1
  ShooterBounds bounds;
  CellLevels levels;
  std::vector<double> sent;  // prefix sums of the current power of the cells
  Shooter even;              // shooter with uniform radiance `expected`
  std::span<const ElementPoint> parts;
  uint32_t first_slot = 0;  // slot of the first part (receivers.h)
  float expected;           // luminance of the expected radiance
  uint64_t stream;

  RowShooter(const RadiosityMesh& mesh, const Receivers& receivers, uint32_t patch,
             const Shooter& shooter, const std::vector<ShooterCell>& cells, float expected,
             uint64_t stream);
};

// True if some cell is nearer to some point of the block than `cell_radii` cell radii.
bool is_near(const RowShooter& s, const ReceiverBlock& b, float cell_radii);

struct RowContext {
  const RadiosityMesh& mesh;
  const Receivers& receivers;
  const Tracer& tracer;
  const RayBudget& budget;
  const RowShooter& shooter;
  float* seen;  // per slot: adds the hemisphere share that the patch fills; may be null
};

}  // namespace troffer
