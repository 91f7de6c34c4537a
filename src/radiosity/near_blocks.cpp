#include "radiosity/near_blocks.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace troffer {

namespace {

uint16_t in_65535ths(double x) {
  return uint16_t(std::lround(std::clamp(x, 0.0, 1.0) * 65535));
}

}  // namespace

void NearBlocks::begin(const RowContext& row) {
  row_ = &row;
  rays_ = 0;
}

void NearBlocks::find(size_t block, size_t k, RowChunk& out) {
  const ReceiverBlock& b = row_->receivers.blocks[block];
  records_.clear();
  scratch_.records = &records_;
  transfers_.assign(b.count, {});
  rays_ += transfer(row_->shooter.even, {row_->mesh.points.data() + b.first_point, b.count},
                    row_->tracer, row_->budget, row_->shooter.stream, b.first_point, transfers_,
                    scratch_);
  sort_records(b.count);
  const size_t first_point = out.points.size();
  bool is_any = false;
  for (uint32_t i = 0; i < b.count; ++i) {
    NearPoint p;
    const float u = luminance(transfers_[i].unoccluded);
    p.first = p.last = uint32_t(out.parts.size());
    if (std::isfinite(u) && u > 0) {
      is_any = true;
      p.unoccluded = u / row_->shooter.expected;
      const float visible = add_parts(
          {sorted_.data() + first_record_[i], first_record_[i + 1] - first_record_[i]}, out);
      p.last = uint32_t(out.parts.size());
      if (row_->seen != nullptr) row_->seen[b.first_slot + i] += p.unoccluded / pi_f * visible;
    }
    out.points.push_back(p);
  }
  if (!is_any) {
    out.points.resize(first_point);
    return;
  }
  out.view[k] = BlockView::near;
  out.first[k] = uint16_t(first_point);
}

void NearBlocks::sort_records(uint32_t receivers) {
  first_record_.assign(size_t(receivers) + 1, 0);
  for (const RayRecord& r : records_) ++first_record_[r.receiver + 1];
  for (uint32_t i = 0; i < receivers; ++i) first_record_[i + 1] += first_record_[i];
  next_record_ = first_record_;
  sorted_.resize(records_.size());
  for (const RayRecord& r : records_) sorted_[next_record_[r.receiver]++] = r;
}

float NearBlocks::add_parts(std::span<const RayRecord> records, RowChunk& out) {
  all_.assign(std::max<size_t>(1, row_->shooter.parts.size()), 0);
  visible_ = all_;
  double sum = 0, visible = 0;
  for (const RayRecord& r : records) {
    const size_t part = row_->shooter.parts.empty()
                            ? 0
                            : nearest_slot(row_->receivers, row_->shooter.first_slot,
                                           uint32_t(row_->shooter.parts.size()), r.end);
    all_[part] += double(r.weight);
    sum += double(r.weight);
    if (!r.is_visible) continue;
    visible_[part] += double(r.weight);
    visible += double(r.weight);
  }
  if (!(sum > 0)) return 0;
  for (size_t part = 0; part < all_.size(); ++part)
    if (all_[part] > 0)
      out.parts.push_back(
          {uint16_t(part), in_65535ths(all_[part] / sum), in_65535ths(visible_[part] / sum)});
  return float(visible / sum);
}

}  // namespace troffer
