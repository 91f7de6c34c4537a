// Blocks of receivers near a patch: the exact unoccluded term and rays (form_factors.h), kept per
// point and part of the patch on which rays ended.
#pragma once

#include "radiosity/patch_row.h"

namespace troffer {

class NearBlocks {
 public:
  // For a patch's row; its memory serves one after the other.
  void begin(const RowContext& row);
  // Of block `k` of the chunk, which is `block` of all.
  void find(size_t block, size_t k, RowChunk& out);
  uint64_t rays() const { return rays_; }

 private:
  // By receiver, in their order: sorted_ from first_record_[i] on is the i-th one's.
  void sort_records(uint32_t receivers);
  // Appends what ended on each part of the patch; returns the share that is visible.
  float add_parts(std::span<const RayRecord> records, RowChunk& out);

  const RowContext* row_ = nullptr;
  uint64_t rays_ = 0;
  std::vector<RayRecord> records_, sorted_;
  std::vector<uint32_t> first_record_, next_record_;
  std::vector<Transfer> transfers_;
  std::vector<double> all_, visible_;  // weights of rays, per part
  TransferScratch scratch_;
};

}  // namespace troffer
