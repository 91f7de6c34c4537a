// Transfers from patches to all sample points. They are computed at a patch's first shot and looked
// up at later ones; the solver uses them.
//
// A *row* stores the visibility of one patch for each block of receivers (receivers.h). A block is
// one of:
// - out of sight: it lies behind the patch, or the patch lies behind it;
// - far: the patch is a dozen cells that count as points. Their unoccluded irradiance is cheap and
//   is recomputed at each shot with the cells' current radiance. The row stores the visible share:
//   none, all, or one number per point;
// - near: the exact unoccluded term and rays (form_factors.h). The row stores them per point and
//   per part of the patch at the ray ends, so that later shots use each part's current radiance
//   [1].
//
// form_factors.h determines the number of rays. Where one ray suffices, points whose irradiance
// together is small (rays_share in far_blocks.cpp) share one ray.
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

// Irradiance per unit of a shooter's mean radiance. Only the points of `blocks`, in order, are
// valid; other entries are stale.
struct ShotReceived {
  std::vector<float> unoccluded, received;  // per slot (receivers.h)
  std::vector<uint32_t> blocks;
};

// Bound for dark blocks, which matter only for lists of important contributions that are hidden.
// Blocks whose irradiance times `scale` is below `least` (per block) are left out.
struct DarkLimit {
  std::span<const float> least;  // empty: none is left out
  float scale = 1;
};

// Buffers of one thread for making a row.
struct RowScratch {
  NearBlocks near;
  FarBlocks far;
  RowChunk chunk;
};

class PatchRows {
 public:
  // Rows are kept up to a total of most_bytes; further ones are recomputed at each shot.
  PatchRows(const RadiosityMesh& mesh, const Tracer& tracer, int threads, size_t most_bytes);

  // Computes what a patch's shot gives. `shooter` is the patch's, with shares set. `expected` is
  // the luminance of the radiance that it is expected to send in total; it determines the number of
  // rays. With is_first, `seen` (per slot) grows by the share of a point's hemisphere that the
  // patch fills. Returns false without a result once `stop` is set.
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
