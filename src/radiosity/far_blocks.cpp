#include "radiosity/far_blocks.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "base/warp.h"

namespace troffer {

namespace {

constexpr uint32_t purpose_far = 4;
// Points that together receive at most this, in tolerances of one transfer, share a ray.
constexpr float rays_share = 1;
constexpr int unanimous_rays = 8;  // rays of a block that must agree to settle it

// Golden-ratio steps distribute neighbouring points over the cells.
double first_number(uint64_t start, uint32_t point) {
  const uint64_t phase = start + uint64_t(point) * 0x9e3779b97f4a7c15ull;
  return double(phase >> 11) * 0x1p-53;
}

// Chooses a cell by x in [0,1), proportional to the power sent. Remaps x to [0,1) for reuse.
size_t choose_cell(const std::vector<double>& sent, double& x) {
  x *= sent.back();
  size_t i = 0;  // branch-free: the branches would be unpredictable
  for (size_t k = 0; k + 1 < sent.size(); ++k) i += sent[k] <= x ? 1 : 0;
  const double before = i > 0 ? sent[i - 1] : 0.0, width = sent[i] - before;
  x = width > 0 ? std::clamp((x - before) / width, 0.0, double(one_minus_epsilon)) : 0.0;
  return i;
}

}  // namespace

void FarBlocks::begin(const RowContext& row) {
  row_ = &row;
  phase_ = mix64(row.shooter.stream);
  rays_ = 0;
}

float FarBlocks::find_irradiance(Block& f) const {
  const ReceiverBlock& b = row_->receivers.blocks[f.block];
  cells_irradiance(row_->receivers, b.first_slot, slots_of(b), row_->shooter.levels.for_block(b),
                   f.irradiance);
  float most = 0;
  for (uint32_t i = 0; i < b.count; ++i) {
    if (!std::isfinite(f.irradiance[i])) f.irradiance[i] = 0;
    f.irradiance[i] *= row_->shooter.expected;
    most = std::max(most, f.irradiance[i]);
  }
  return most;
}

void FarBlocks::start(size_t block) {
  Block f;
  f.block = uint32_t(block);
  const float most = find_irradiance(f);
  if (!(most > 0)) return;
  f.wanted = rays_wanted(row_->budget, most);
  add(f);
}

bool FarBlocks::start_if_weak(size_t block) {
  // error factor of the cells' irradiance beyond one cell radius
  constexpr float cells_may_err = 2;
  const ReceiverBlock& b = row_->receivers.blocks[block];
  if (is_near(row_->shooter, b, 1)) return false;
  Block f;
  f.block = uint32_t(block);
  const float most = find_irradiance(f);
  if (rays_wanted(row_->budget, cells_may_err * most) > 1) return false;
  if (most > 0) add(f);
  return true;
}

void FarBlocks::add(const Block& f) {
  const ReceiverBlock& b = row_->receivers.blocks[f.block];
  blocks_.push_back(f);
  const auto index = uint32_t(blocks_.size() - 1);
  if (f.wanted > 1) {
    const int first = std::max(1, f.wanted / 4);
    for (uint8_t i = 0; i < b.count; ++i)
      for (int k = 0; k < first; ++k) add_ray(index, i, uint8_t(i + 1), k);
    return;
  }
  const float limit = rays_share * row_->budget.tolerance * row_->budget.reference;
  float sum = 0;
  uint8_t first = 0;
  for (uint8_t i = 0; i < b.count; ++i) {
    sum += f.irradiance[i];
    if (i + 1u < b.count && sum + f.irradiance[i + 1u] <= limit) continue;
    add_ray(index, first, uint8_t(i + 1), 0);
    first = uint8_t(i + 1);
    sum = 0;
  }
}

void FarBlocks::add_ray(uint32_t index, uint8_t first, uint8_t last, int k) {
  const Block& f = blocks_[index];
  const uint32_t first_point = row_->receivers.blocks[f.block].first_point;
  const uint64_t h =
      mix64(row_->shooter.stream + (uint64_t(first_point + first) << 20) + uint64_t(k));
  const uint8_t i = uint8_t(first + (h >> 48) % uint64_t(last - first));
  if (!(f.irradiance[i] > 0)) return;
  Purpose& p = purposes_.emplace_back();
  p.block = index;
  p.first = first;
  p.last = last;
  p.point = i;
  p.k = uint8_t(k);
  p.hash = h;
}

// Chooses a cell by the power that it sends, so that visibility is that of the light and not of the
// area. An occluder at the dark end of a patch then does not reduce the light of its bright end.
void FarBlocks::aim(Purpose& p) const {
  const Block& f = blocks_[p.block];
  const uint32_t first_point = row_->receivers.blocks[f.block].first_point;
  p.u = {float(p.hash & 0xffffff) * 0x1p-24f, float(p.hash >> 24 & 0xffffff) * 0x1p-24f};
  double x = first_number(phase_, first_point + p.first);
  if (f.wanted > 1) {  // rays of one point are stratified
    p.u = SobolGroup(row_->shooter.stream + mix64(first_point + p.point), purpose_far, p.k).get2();
    x = double(p.u.x);
  }
  p.cell = uint32_t(choose_cell(row_->shooter.sent, x));
  if (f.wanted > 1) p.u.x = float(x);
}

// Appends a ray to ray_list_. Returns false if the point and all cells face away from each other.
bool FarBlocks::find_ray(Purpose& p) {
  const size_t slot = row_->receivers.blocks[blocks_[p.block].block].first_slot + p.point;
  const Vec3 from = row_->receivers.position(slot), normal = row_->receivers.normal(slot);
  const float offset = row_->receivers.offset[slot];
  const Vec2 w = triangle_from_square(p.u);
  const size_t n = row_->shooter.cells.size();
  size_t cell = p.cell;
  for (size_t step = 0; step < n; ++step, cell = cell + 1 < n ? cell + 1 : 0) {
    const ShooterCell& c = row_->shooter.cells[cell];
    const Vec3 end =
        c.corners[0] + (c.corners[1] - c.corners[0]) * w.x + (c.corners[2] - c.corners[0]) * w.y;
    const Vec3 d = end - from;
    const float along = dot(d, normal), facing = -dot(d, c.normal), d2 = length_squared(d);
    if (!(along > offset && facing > row_->shooter.even.offset)) continue;
    Ray& ray = ray_list_.emplace_back();
    ray.origin = from + normal * offset;
    ray.direction = end + c.normal * row_->shooter.even.offset - ray.origin;
    ray.t_max = 1;
    p.weight = along * facing / (d2 * d2);
    return true;
  }
  return false;
}

void FarBlocks::trace() {
  for (Purpose& p : purposes_) aim(p);
  std::erase_if(purposes_, [&](Purpose& p) { return !find_ray(p); });
  occluded_.resize(ray_list_.size());
  row_->tracer.occluded(ray_list_, occluded_, Coherence::coherent, factors_);
  rays_ += ray_list_.size();
  for (size_t k = 0; k < purposes_.size(); ++k) {
    Block& f = blocks_[purposes_[k].block];
    for (uint8_t i = purposes_[k].first; i < purposes_[k].last; ++i) {
      f.all[i] += purposes_[k].weight;
      if (occluded_[k] == 0) f.visible[i] += purposes_[k].weight * luminance(factors_[k]);
    }
  }
  ray_list_.clear();
  purposes_.clear();
}

bool FarBlocks::is_unanimous(const Block& f, uint32_t count, bool& is_lit) {
  bool is_any_lit = false, is_any_dark = false;
  for (uint32_t i = 0; i < count; ++i) {
    if (!(f.all[i] > 0)) continue;
    is_any_lit = is_any_lit || f.visible[i] > 0;
    is_any_dark = is_any_dark || f.visible[i] < f.all[i];
  }
  is_lit = is_any_lit;
  return is_any_lit != is_any_dark;
}

void FarBlocks::finish(size_t first_block, RowChunk& out) {
  trace();
  for (uint32_t index = 0; index < blocks_.size(); ++index) {
    Block& f = blocks_[index];
    const uint32_t count = row_->receivers.blocks[f.block].count;
    const int first = std::max(1, f.wanted / 4);
    bool is_lit = false;
    if (f.wanted == 1 || (is_unanimous(f, count, is_lit) && first * int(count) >= unanimous_rays))
      continue;
    for (uint8_t i = 0; i < count; ++i)
      for (int k = first; k < f.wanted; ++k) add_ray(index, i, uint8_t(i + 1), k);
  }
  trace();
  for (const Block& f : blocks_) settle(f, first_block, out);
  blocks_.clear();
}

void FarBlocks::settle(const Block& f, size_t first_block, RowChunk& out) const {
  const ReceiverBlock& b = row_->receivers.blocks[f.block];
  bool is_lit = false;
  BlockView& view = out.view[f.block - first_block];
  if (is_unanimous(f, b.count, is_lit)) {
    view = is_lit ? BlockView::lit : BlockView::dark;
    if (!is_lit) {
      const float most = *std::max_element(f.irradiance, f.irradiance + b.count);
      out.first[f.block - first_block] = dark_bits(most / row_->shooter.expected);
    }
    for (uint32_t i = 0; is_lit && i < b.count; ++i) note_seen(f, i, 1);
    return;
  }
  float all = 0, visible = 0;
  for (uint32_t i = 0; i < b.count; ++i) {
    all += f.all[i];
    visible += f.visible[i];
  }
  if (!(all > 0)) return;  // no cell faces the points
  view = BlockView::partly;
  out.first[f.block - first_block] = uint16_t(out.visible.size());
  for (uint32_t i = 0; i < b.count; ++i) {
    const float share = f.all[i] > 0 ? f.visible[i] / f.all[i] : visible / all;
    out.visible.push_back(uint8_t(std::lround(std::clamp(share, 0.0f, 1.0f) * 255)));
    note_seen(f, i, share);
  }
}

void FarBlocks::note_seen(const Block& f, uint32_t i, float share) const {
  if (row_->seen == nullptr) return;
  row_->seen[row_->receivers.blocks[f.block].first_slot + i] +=
      f.irradiance[i] / (pi_f * row_->shooter.expected) * share;
}

}  // namespace troffer
