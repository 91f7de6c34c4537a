// Transfer from a patch to nearby blocks of receivers: the exact unoccluded term and rays
// (form_factors.h). PatchRows uses it. Results are stored per point and per part of the patch at
// the ray ends.
#pragma once

#include "radiosity/patch_row.h"

namespace troffer {

class NearBlocks {
 public:
  // Starts a patch's row. Buffers are reused from row to row.
  void begin(const RowContext& row);
  // Computes block `block`, which is the k-th of the chunk.
  void find(size_t block, size_t k, RowChunk& out);
  uint64_t rays() const { return rays_; }

 private:
  // Sorts the records by receiver: those of receiver i start at first_record_[i] in sorted_.
  void sort_records(uint32_t receivers);
  // Appends the shares of each part of the patch; returns the visible share.
  float add_parts(std::span<const RayRecord> records, RowChunk& out);

  const RowContext* row_ = nullptr;
  uint64_t rays_ = 0;
  std::vector<RayRecord> records_, sorted_;
  std::vector<uint32_t> first_record_, next_record_;
  std::vector<Transfer> transfers_;
  std::vector<double> all_, visible_;  // ray weights per part
  TransferScratch scratch_;
};

}  // namespace troffer
