#include "radiosity/patch_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace troffer {

namespace {

// Returns the distance, in cell radii, from which a cell counts as a point. The error of a point
// falls with the square of the distance.
float near_in_cell_radii(const RayBudget& budget) {
  return 1 + std::clamp(std::sqrt(0.003f / budget.tolerance), 1.0f, 6.0f);
}

// Makes the chunk that begins at first_block. Returns the number of rays.
uint64_t make_chunk(const RowContext& row, size_t first_block, RowScratch& s, RowChunk& out) {
  const std::vector<ReceiverBlock>& blocks = row.receivers.blocks;
  const size_t count = std::min(blocks.size() - first_block, RowChunk::most_blocks);
  s.chunk.clear(count);
  const float cell_radii = near_in_cell_radii(row.budget);
  s.near.begin(row);
  s.far.begin(row);
  for (size_t k = 0; k < count; ++k) {
    const ReceiverBlock& block = blocks[first_block + k];
    if (is_out_of_sight(row.shooter.bounds, block)) continue;
    if (is_near(row.shooter, block, cell_radii)) {
      if (s.far.start_if_weak(first_block + k)) continue;
      s.near.find(first_block + k, k, s.chunk);
    } else {
      s.far.start(first_block + k);
    }
  }
  s.far.finish(first_block, s.chunk);
  out = s.chunk;  // the copy takes no more memory than it needs
  return s.near.rays() + s.far.rays();
}

// Computes what a near block receives at the parts' current radiance.
void apply_near(const RowChunk& row, size_t k, uint32_t count, const Shooter& shooter,
                float* unoccluded, float* received) {
  const auto share_of = [&](size_t part) {
    return shooter.share.empty() ? 1.0f : shooter.share[part];
  };
  for (uint32_t i = 0; i < count; ++i) {
    const NearPoint& p = row.points[size_t(row.first[k]) + i];
    float all = 0, visible = 0;
    for (uint32_t at = p.first; at < p.last; ++at) {
      const float share = share_of(row.parts[at].part);
      all += share * float(row.parts[at].all);
      visible += share * float(row.parts[at].visible);
    }
    unoccluded[i] = p.unoccluded * all * (1 / 65535.0f);
    received[i] = p.unoccluded * visible * (1 / 65535.0f);
  }
}

// Computes what far points receive: `unoccluded` times the share `all`, or times `visible` (in
// 255ths) per point. Values that are not finite become 0.
void share_out(float* unoccluded, uint32_t count, float all, const uint8_t* visible,
               float* received) {
  for (uint32_t i = 0; i < count; ++i)
    unoccluded[i] =
        std::abs(unoccluded[i]) < std::numeric_limits<float>::infinity() ? unoccluded[i] : 0.0f;
  if (visible == nullptr)
    for (uint32_t i = 0; i < count; ++i) received[i] = unoccluded[i] * all;
  else
    for (uint32_t i = 0; i < count; ++i)
      received[i] = unoccluded[i] * (1 / 255.0f) * float(visible[i]);
}

}  // namespace

PatchRows::PatchRows(const RadiosityMesh& mesh, const Tracer& tracer, int threads,
                     size_t most_bytes)
    : mesh_(mesh),
      tracer_(tracer),
      receivers_(mesh),
      threads_(threads),
      most_bytes_(most_bytes),
      rows_(mesh.patches.size()),
      chunks_((receivers_.blocks.size() + RowChunk::most_blocks - 1) / RowChunk::most_blocks) {}

bool PatchRows::shoot(uint32_t patch, const Shooter& shooter, float expected,
                      const RayBudget& budget, uint64_t stream, const StopFlag& stop, bool is_first,
                      const DarkLimit& dark, std::vector<float>& seen, ShotReceived& out) {
  out.blocks.clear();
  const std::vector<ShooterCell> cells = shooter_cells(mesh_, patch, shooter);
  if (cells.empty() || !(expected > 0)) return true;
  Row made;
  Row& kept = rows_[patch];
  const bool is_new = kept.empty();
  if (is_new) {
    made.resize(chunks_);
    std::vector<uint64_t> rays(made.size(), 0);
    const RowShooter row_shooter(mesh_, receivers_, patch, shooter, cells, expected, stream);
    const RowContext row_context{mesh_,  receivers_,  tracer_,
                                 budget, row_shooter, is_first ? seen.data() : nullptr};
    scratch_.resize(size_t(thread_count(threads_)));
    parallel_for_slots(made.size(), threads_, [&](size_t chunk, size_t slot) {
      if (stop.load(std::memory_order_relaxed)) return;
      rays[chunk] =
          make_chunk(row_context, chunk * RowChunk::most_blocks, scratch_[slot], made[chunk]);
    });
    if (stop) return false;
    for (const uint64_t r : rays) rays_ += r;
  }
  Row& row = is_new ? made : kept;
  // The row records which blocks are listed. When a row is made again, all dark blocks may be
  // listed.
  DarkLimit limit = is_new && !is_first ? DarkLimit{} : dark;
  float most_share = 0;
  for (const ShooterCell& c : cells) most_share = std::max(most_share, c.share);
  limit.scale *= most_share;
  const CellLevels levels(cells, ShooterBounds(cells, shooter));
  for (size_t chunk = 0; chunk < row.size(); ++chunk)
    apply(row[chunk], chunk, shooter, levels, limit, out);
  if (!is_new) return true;
  size_t bytes = 0;
  for (const RowChunk& c : made) bytes += c.bytes();
  if (bytes_ + bytes > most_bytes_) {
    ++not_kept_;
    return true;
  }
  bytes_ += bytes;
  kept = std::move(made);
  return true;
}

void PatchRows::apply(RowChunk& row, size_t chunk, const Shooter& shooter, const CellLevels& cells,
                      const DarkLimit& dark, ShotReceived& out) const {
  for (size_t k = 0; k < row.view.size(); ++k) {
    const BlockView view = row.view[k];
    if (view == BlockView::none) continue;
    const auto block = uint32_t(chunk * RowChunk::most_blocks + k);
    if (view == BlockView::dark) {
      if (!dark.least.empty() && dark_most(row.first[k]) * dark.scale < dark.least[block]) continue;
      row.view[k] = BlockView::listed;
    }
    const ReceiverBlock& b = receivers_.blocks[block];
    out.blocks.push_back(block);
    float* const unoccluded = out.unoccluded.data() + b.first_slot;
    float* const received = out.received.data() + b.first_slot;
    if (view == BlockView::near) {
      apply_near(row, k, b.count, shooter, unoccluded, received);
      continue;
    }
    cells_irradiance(receivers_, b.first_slot, slots_of(b), cells.for_block(b), unoccluded);
    const uint8_t* const visible =
        view == BlockView::partly ? row.visible.data() + row.first[k] : nullptr;
    share_out(unoccluded, b.count, view == BlockView::lit ? 1.0f : 0.0f, visible, received);
  }
}

}  // namespace troffer
