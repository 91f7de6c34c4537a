// What one patch gives to all sample points, found at its first shot and looked up at later ones.
//
// A *row* holds, per block of receivers (receivers.h), what hides the patch from it. The block is
//   - out of sight: behind the patch, or the patch behind it;
//   - far: the patch is a dozen cells, each a point, whose unoccluded irradiance is cheap enough to
//     be found anew at each shot, with the radiance that each cell then has; kept is the visible
//     share: none, all, or one number per point;
//   - near: the exact unoccluded term and rays (form_factors.h), kept per point and part of the
//     patch on which rays ended, so that later shots give each part what it then has [1].
// Rays: as many as form_factors.h wants; where it wants one, points that together get no more
// than two such transfers' error share one.
// References: [1] Hanrahan, Salzman & Aupperle, "A Rapid Hierarchical Radiosity Algorithm",
//   SIGGRAPH 1991 (near pairs at a finer level than far ones).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "radiosity/far_blocks.h"
#include "radiosity/form_factors.h"
#include "radiosity/near_blocks.h"
#include "radiosity/patch_row.h"

namespace troffer {

// Irradiance per unit of a shooter's mean radiance. Only points of `blocks` (in their order) got
// something; the others' numbers are left over from earlier shots.
struct ShotReceived {
  std::vector<float> unoccluded, received;  // per slot (receivers.h)
  std::vector<uint32_t> blocks;
};

// Blocks that a patch cannot reach matter only to lists of what is important though hidden: those
// that would get less than `least` (per block), of irradiance times `scale`, are left out.
struct DarkLimit {
  std::span<const float> least;  // empty: none are left out
  float scale = 1;
};

// What one thread needs to make a row.
struct RowScratch {
  NearBlocks near;
  FarBlocks far;
  RowChunk chunk;
};

class PatchRows {
 public:
  // Rows are kept while they take less than most_bytes; others are found again at each shot.
  PatchRows(const RadiosityMesh& mesh, const Tracer& tracer, int threads, size_t most_bytes);

  // shooter: the patch's, with shares set. `expected`: luminance of the radiance that it is
  // thought to send in all, for numbers of rays. False, with nothing found, once `stop` is set.
  // With is_first, `seen` (per slot) grows by the part of a point's hemisphere that the patch
  // fills.
  bool shoot(uint32_t patch, const Shooter& shooter, float expected, const RayBudget& budget,
             uint64_t stream, const StopFlag& stop, bool is_first, const DarkLimit& dark,
             std::vector<float>& seen, ShotReceived& out);

  uint64_t rays() const { return rays_; }
  size_t bytes() const { return bytes_; }
  size_t rows_not_kept() const { return not_kept_; }
  const Receivers& receivers() const { return receivers_; }

 private:
  using Row = std::vector<RowChunk>;

  void apply(RowChunk& row, size_t chunk, const Shooter& shooter, const CellLevels& cells,
             const DarkLimit& dark, ShotReceived& out) const;

  const RadiosityMesh& mesh_;
  const Tracer& tracer_;
  Receivers receivers_;
  int threads_;
  size_t most_bytes_, bytes_ = 0, not_kept_ = 0;
  uint64_t rays_ = 0;
  std::vector<Row> rows_;  // per patch; empty: not kept
  size_t chunks_;
  std::vector<RowScratch> scratch_;  // per thread
};

}  // namespace troffer
