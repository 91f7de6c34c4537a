// A row of patch_rows.h as it is kept, and what is known while one is made.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/form_factors.h"
#include "radiosity/receivers.h"
#include "radiosity/shooter_cells.h"

namespace troffer {

// How a block of receivers sees the patch.
// listed: dark, and in somebody's list of contributions.
enum class BlockView : uint16_t { none, lit, dark, listed, partly, near };

// Above what any point of a dark block would get unoccluded, in 16 bits.
uint16_t dark_bits(float most);
float dark_most(uint16_t bits);

struct NearPart {
  uint16_t part, all, visible;  // shares of what the point gets, in 65535ths
};

struct NearPoint {
  float unoccluded = 0;
  uint32_t first = 0, last = 0;  // in parts
};

// Of some consecutive blocks.
struct RowChunk {
  static constexpr size_t most_blocks = 64;
  std::vector<BlockView> view;   // per block
  std::vector<uint16_t> first;   // per block. partly: in `visible`; near: in `points`; dark: bits
  std::vector<uint8_t> visible;  // in 255ths
  std::vector<NearPoint> points;
  std::vector<NearPart> parts;
  size_t bytes() const;
  void clear(size_t blocks);  // so many, out of sight
};

// The patch whose row it is. Rows are found for its light as if it were the same everywhere: what
// its parts send changes from shot to shot.
struct RowShooter {
  std::vector<ShooterCell> cells;  // with share 1
  ShooterBounds bounds;
  CellLevels levels;
  std::vector<double> sent;  // running sums of what cells send now
  Shooter even;              // sends `expected`, the same everywhere
  std::span<const ElementPoint> parts;
  uint32_t first_slot = 0;  // of parts (receivers.h)
  float expected;           // luminance of radiance
  uint64_t stream;

  RowShooter(const RadiosityMesh& mesh, const Receivers& receivers, uint32_t patch,
             const Shooter& shooter, const std::vector<ShooterCell>& cells, float expected,
             uint64_t stream);
};

// Whether some cell is nearer to some point of the block than so many radii of cells.
bool is_near(const RowShooter& s, const ReceiverBlock& b, float cell_radii);

struct RowContext {
  const RadiosityMesh& mesh;
  const Receivers& receivers;
  const Tracer& tracer;
  const RayBudget& budget;
  const RowShooter& shooter;
  float* seen;  // per slot: grows by the part of the point's hemisphere that the patch fills; or
                // nullptr
};

}  // namespace troffer
