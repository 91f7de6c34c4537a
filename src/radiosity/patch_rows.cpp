#include "radiosity/patch_rows.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "base/warp.h"

namespace troffer {

namespace {

constexpr uint32_t purpose_far = 4;
constexpr size_t flat_cells = 10;
constexpr size_t most_curved_cells = 48;
// Points that together get no more than this, in tolerances of one transfer, share a ray.
constexpr float rays_share = 1;
constexpr int unanimous_rays = 8;  // of a block: then it is settled

float area_of(const Vec3 (&c)[3]) {
  return 0.5f * length(cross(c[1] - c[0], c[2] - c[0]));
}

// Halves the largest, again and again.
std::vector<ShooterCell> flat_shooter_cells(const Shooter& shooter) {
  std::vector<ShooterCell> cells;
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal) {
    ShooterCell cell;
    cell.corners[0] = a;
    cell.corners[1] = b;
    cell.corners[2] = c;
    cell.normal = normal;
    cell.area = area_of(cell.corners);
    if (cell.area > 0) cells.push_back(cell);
  };
  for (const LightPrimitive& p : shooter.pieces)
    for (uint32_t i = 1; i + 1 < p.vertex_count; ++i)
      add(p.vertex(0), p.vertex(i), p.vertex(i + 1), Vec3(p.normal));
  while (!cells.empty() && cells.size() < flat_cells) {
    const auto largest = std::max_element(
        cells.begin(), cells.end(),
        [](const ShooterCell& a, const ShooterCell& b) { return a.area < b.area; });
    const ShooterCell c = *largest;
    cells.erase(largest);
    size_t edge = 0;
    float longest = -1;
    for (size_t k = 0; k < 3; ++k) {
      const float l = length_squared(c.corners[(k + 1) % 3] - c.corners[k]);
      if (l > longest) {
        longest = l;
        edge = k;
      }
    }
    const Vec3 a = c.corners[edge], b = c.corners[(edge + 1) % 3], d = c.corners[(edge + 2) % 3];
    const Vec3 m = a * 0.5f + b * 0.5f;
    const size_t before = cells.size();
    add(a, m, d, c.normal);
    add(m, b, d, c.normal);
    if (cells.size() == before) break;  // too small to be halved
  }
  for (ShooterCell& c : cells) c.position = (c.corners[0] + c.corners[1] + c.corners[2]) / 3.0f;
  return cells;
}

std::vector<ShooterCell> curved_shooter_cells(const RadiosityMesh& mesh, uint32_t patch) {
  const Patch& p = mesh.patches[patch];
  const uint32_t count = p.last_point - p.first_point;
  const auto step = uint32_t((count + most_curved_cells - 1) / most_curved_cells);
  std::vector<ShooterCell> cells;
  for (uint32_t i = p.first_point; i < p.last_point; i += step) {
    const ElementPoint& e = mesh.points[i];
    cells.push_back({e.position, e.normal, e.area, 1, {e.position, e.position, e.position}});
  }
  return cells;
}

bool is_plain(const Shooter& s) {
  return s.is_exact && !(s.round_radius > 0);
}

// A cell counts as a point from so many of its radii on, beyond the shooter's own: its error falls
// with the square of the distance.
float near_in_cell_radii(const RayBudget& budget) {
  return std::clamp(std::sqrt(0.003f / budget.tolerance), 1.0f, 6.0f);
}

// Where a shooter is, for whole blocks.
struct ShooterBounds {
  Vec3 centre, normal;
  float radius = 0, cell_radius = 0;
  bool is_flat = true;

  ShooterBounds(const std::vector<ShooterCell>& cells, bool is_plain) {
    float area = 0;
    for (const ShooterCell& c : cells) {
      centre += c.position * c.area;
      area += c.area;
    }
    centre = centre / area;
    normal = cells[0].normal;
    for (const ShooterCell& c : cells) {
      is_flat = is_flat && length_squared(c.normal - normal) < 1e-10f;
      float r = is_plain ? 0.0f : 1.5f * std::sqrt(c.area / pi_f);
      for (const Vec3& v : c.corners) r = std::max(r, length(v - c.position));
      cell_radius = std::max(cell_radius, r);
      radius = std::max(radius, length(c.position - centre) + r);
    }
  }
};

// How far a disc reaches out of its plane along a direction.
float reach(float radius, const Vec3& normal, const Vec3& along) {
  const float c = dot(normal, along);
  return radius * std::sqrt(std::max(0.0f, 1 - c * c));
}

// What hardly rises over a plane gets nothing from it: surfaces in contact, and all in one plane.
bool is_out_of_sight(const ShooterBounds& s, const ReceiverBlock& b) {
  const Vec3 d = b.centre - s.centre;
  const float slack = 1e-5f * (s.radius + b.radius + length(d));
  if (s.is_flat) {
    const float out = b.is_flat ? reach(b.radius, b.normal, s.normal) : b.radius;
    if (dot(d, s.normal) + out <= slack) return true;
  }
  if (b.is_flat) {
    const float out = s.is_flat ? reach(s.radius, s.normal, b.normal) : s.radius;
    if (-dot(d, b.normal) + out <= slack) return true;
  }
  return false;
}

uint16_t in_65535ths(double x) {
  return uint16_t(std::lround(std::clamp(x, 0.0, 1.0) * 65535));
}

}  // namespace

std::vector<ShooterCell> shooter_cells(const RadiosityMesh& mesh, uint32_t patch,
                                       const Shooter& shooter) {
  std::vector<ShooterCell> cells =
      is_plain(shooter) ? flat_shooter_cells(shooter) : curved_shooter_cells(mesh, patch);
  double area = 0, sent = 0;
  for (ShooterCell& c : cells) {
    c.share = share_at(shooter, c.position);
    area += double(c.area);
    sent += double(c.area) * double(c.share);
  }
  if (!(area > 0) || !(sent > 0)) return {};
  const auto scale = float(double(shooter.area()) / area), level = float(area / sent);
  for (ShooterCell& c : cells) {
    c.area *= scale;
    c.share *= level;
  }
  return cells;
}

size_t PatchRows::RowChunk::bytes() const {
  return sizeof(*this) + view.capacity() * sizeof(View) + first.capacity() * sizeof(uint16_t) +
         visible.capacity() + points.capacity() * sizeof(NearPoint) +
         parts.capacity() * sizeof(NearPart);
}

PatchRows::PatchRows(const RadiosityMesh& mesh, const Tracer& tracer, int threads,
                     size_t most_bytes)
    : mesh_(mesh),
      tracer_(tracer),
      receivers_(mesh),
      threads_(threads),
      most_bytes_(most_bytes),
      rows_(mesh.patches.size()),
      chunks_((receivers_.blocks.size() + chunk_blocks - 1) / chunk_blocks) {}

// Makes one chunk of a row.
class PatchRows::Maker {
 public:
  Maker(const PatchRows& rows, uint32_t patch, const Shooter& shooter,
        std::span<const ShooterCell> cells, float expected, const RayBudget& budget,
        uint64_t stream, float* seen)
      : rows_(rows),
        patch_(rows.mesh_.patches[patch]),
        cells_(cells.begin(), cells.end()),
        bounds_(cells_, is_plain(shooter)),
        offset_(shooter.offset),
        expected_(expected),
        budget_(budget),
        stream_(stream),
        seen_(seen),
        near_shooter_(shooter) {
    double sum = 0;
    for (ShooterCell& c : cells_) {
      sent_.push_back(sum += double(c.area) * double(c.share));
      c.share = 1;
    }
    near_shooter_.share.clear();
    near_shooter_.parts = {};
    for (LightPrimitive& p : near_shooter_.pieces) p.mean_radiance = Rgb{expected};
    if (shooter.is_exact && patch_.last_point - patch_.first_point <= most_parts)
      parts_ = {rows.mesh_.points.data() + patch_.first_point,
                patch_.last_point - patch_.first_point};
  }

  size_t run(size_t chunk, RowChunk& out) {
    const std::vector<ReceiverBlock>& blocks = rows_.receivers_.blocks;
    first_block_ = chunk * chunk_blocks;
    const size_t last = std::min(blocks.size(), first_block_ + chunk_blocks);
    out.view.assign(last - first_block_, none);
    out.first.assign(last - first_block_, 0);
    for (size_t b = first_block_; b < last; ++b) {
      if (is_out_of_sight(bounds_, blocks[b])) continue;
      if (is_near(blocks[b]))
        make_near(b, out);
      else
        start_far(b);
    }
    finish_far(out);
    out.visible.shrink_to_fit();
    out.points.shrink_to_fit();
    out.parts.shrink_to_fit();
    return rays_;
  }

 private:
  static constexpr uint32_t most_parts = 256;

  bool is_near(const ReceiverBlock& b) const {
    return length(b.centre - bounds_.centre) - b.radius <
           bounds_.radius + near_in_cell_radii(budget_) * bounds_.cell_radius;
  }

  // ---- near ----

  void make_near(size_t block, RowChunk& out) {
    const ReceiverBlock& b = rows_.receivers_.blocks[block];
    records_.clear();
    scratch_.records = &records_;
    transfers_.assign(b.count, {});
    rays_ += transfer(near_shooter_, {rows_.mesh_.points.data() + b.first_point, b.count},
                      rows_.tracer_, budget_, stream_, b.first_point, transfers_, scratch_);
    std::stable_sort(records_.begin(), records_.end(), [](const RayRecord& x, const RayRecord& y) {
      return x.receiver < y.receiver;
    });
    const size_t first_point = out.points.size();
    bool is_any = false;
    size_t record = 0;
    for (uint32_t i = 0; i < b.count; ++i) {
      NearPoint p;
      const float u = luminance(transfers_[i].unoccluded);
      const size_t first = record;
      while (record < records_.size() && records_[record].receiver == i) ++record;
      p.first = p.last = uint32_t(out.parts.size());
      if (std::isfinite(u) && u > 0) {
        is_any = true;
        p.unoccluded = u / expected_;
        add_parts({records_.data() + first, record - first}, out);
        p.last = uint32_t(out.parts.size());
        if (seen_ != nullptr) seen_[b.first_point + i] += p.unoccluded / pi_f * visible_share_;
      }
      out.points.push_back(p);
    }
    if (!is_any) {
      out.points.resize(first_point);
      return;
    }
    out.view[block - first_block_] = near;
    out.first[block - first_block_] = uint16_t(first_point);
  }

  // What ended on each part.
  void add_parts(std::span<const RayRecord> records, RowChunk& out) {
    all_.assign(std::max<size_t>(1, parts_.size()), 0);
    visible_ = all_;
    double sum = 0, visible = 0;
    for (const RayRecord& r : records) {
      const size_t part = nearest_part(parts_, r.end);
      all_[part] += double(r.weight);
      sum += double(r.weight);
      if (!r.is_visible) continue;
      visible_[part] += double(r.weight);
      visible += double(r.weight);
    }
    visible_share_ = sum > 0 ? float(visible / sum) : 0.0f;
    if (!(sum > 0)) return;
    for (size_t part = 0; part < all_.size(); ++part)
      if (all_[part] > 0)
        out.parts.push_back(
            {uint16_t(part), in_65535ths(all_[part] / sum), in_65535ths(visible_[part] / sum)});
  }

  // ---- far ----

  // A ray, for the points [first, last) of a block.
  struct FarRay {
    uint32_t block;
    uint8_t first, last;
    float weight;
  };
  struct FarBlock {
    uint32_t block;
    int wanted = 1;
    float irradiance[ReceiverBlock::most_points];  // luminance
    float all[ReceiverBlock::most_points] = {}, visible[ReceiverBlock::most_points] = {};
  };

  void start_far(size_t block) {
    const ReceiverBlock& b = rows_.receivers_.blocks[block];
    FarBlock f;
    f.block = uint32_t(block);
    const uint32_t padded = (b.count + Receivers::lanes - 1) / Receivers::lanes * Receivers::lanes;
    cells_irradiance(rows_.receivers_, b.first_slot, padded, cells_, f.irradiance);
    float most = 0;
    for (uint32_t i = 0; i < b.count; ++i) {
      if (!std::isfinite(f.irradiance[i])) f.irradiance[i] = 0;
      f.irradiance[i] *= expected_;
      most = std::max(most, f.irradiance[i]);
    }
    if (!(most > 0)) return;
    f.wanted = rays_wanted(budget_, most);
    far_.push_back(f);
    const auto index = uint32_t(far_.size() - 1);
    if (f.wanted > 1) {
      const int first = std::max(1, f.wanted / 4);
      for (uint8_t i = 0; i < b.count; ++i)
        for (int k = 0; k < first; ++k) add_ray(index, i, uint8_t(i + 1), k);
      return;
    }
    const float limit = rays_share * budget_.tolerance * budget_.reference;
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

  // To a cell chosen by what it sends now, so that what is seen is the light, not the area: before
  // the dark end of a patch that something hides there, its bright end is whole.
  void add_ray(uint32_t index, uint8_t first, uint8_t last, int k) {
    const ReceiverBlock& b = rows_.receivers_.blocks[far_[index].block];
    const uint64_t h = mix64(stream_ + (uint64_t(b.first_point + first) << 20) + uint64_t(k));
    const uint8_t i = uint8_t(first + (h >> 48) % uint64_t(last - first));
    if (!(far_[index].irradiance[i] > 0)) return;
    const ElementPoint& r = rows_.mesh_.points[b.first_point + i];
    Vec2 u{float(h & 0xffffff) * 0x1p-24f, float(h >> 24 & 0xffffff) * 0x1p-24f};
    double x = first_number(b.first_point + first);
    if (far_[index].wanted > 1) {  // a point's own rays are stratified
      u = SobolGroup(stream_ + mix64(b.first_point + i), purpose_far, uint32_t(k)).get2();
      x = double(u.x);
    }
    const size_t n = cells_.size(), start = choose_cell(x);
    if (far_[index].wanted > 1) u.x = float(x);
    const Vec2 w = triangle_from_square(u);
    for (size_t step = 0; step < n; ++step) {
      const ShooterCell& c = cells_[(start + step) % n];
      const Vec3 end =
          c.corners[0] + (c.corners[1] - c.corners[0]) * w.x + (c.corners[2] - c.corners[0]) * w.y;
      const Vec3 d = end - r.position;
      const float along = dot(d, r.normal), facing = -dot(d, c.normal), d2 = length_squared(d);
      if (!(along > r.offset && facing > offset_)) continue;
      Ray ray;
      ray.origin = r.position + r.normal * r.offset;
      ray.direction = end + c.normal * offset_ - ray.origin;
      ray.t_max = 1;
      ray_list_.push_back(ray);
      far_rays_.push_back({index, first, last, along * facing / (d2 * d2)});
      return;
    }
  }

  // Neighbouring points are spread over the cells: steps of the golden ratio.
  double first_number(uint32_t point) const {
    const uint64_t phase = mix64(stream_) + uint64_t(point) * 0x9e3779b97f4a7c15ull;
    return double(phase >> 11) * 0x1p-53;
  }

  // By a number in [0,1), of which what is left, in [0,1) again, comes back.
  size_t choose_cell(double& x) const {
    x *= sent_.back();
    const size_t i = std::min(
        size_t(std::upper_bound(sent_.begin(), sent_.end(), x) - sent_.begin()), sent_.size() - 1);
    const double before = i > 0 ? sent_[i - 1] : 0.0, width = sent_[i] - before;
    x = width > 0 ? std::clamp((x - before) / width, 0.0, double(one_minus_epsilon)) : 0.0;
    return i;
  }

  void trace_far() {
    occluded_.resize(ray_list_.size());
    rows_.tracer_.occluded(ray_list_, occluded_, Coherence::coherent);
    rays_ += ray_list_.size();
    for (size_t k = 0; k < far_rays_.size(); ++k) {
      FarBlock& f = far_[far_rays_[k].block];
      for (uint8_t i = far_rays_[k].first; i < far_rays_[k].last; ++i) {
        f.all[i] += far_rays_[k].weight;
        if (occluded_[k] == 0) f.visible[i] += far_rays_[k].weight;
      }
    }
    ray_list_.clear();
    far_rays_.clear();
  }

  static bool is_unanimous(const FarBlock& f, uint32_t count, bool& is_lit) {
    bool is_any_lit = false, is_any_dark = false;
    for (uint32_t i = 0; i < count; ++i) {
      if (!(f.all[i] > 0)) continue;
      is_any_lit = is_any_lit || f.visible[i] > 0;
      is_any_dark = is_any_dark || f.visible[i] < f.all[i];
    }
    is_lit = is_any_lit;
    return is_any_lit != is_any_dark;
  }

  void finish_far(RowChunk& out) {
    trace_far();
    for (uint32_t index = 0; index < far_.size(); ++index) {
      FarBlock& f = far_[index];
      const uint32_t count = rows_.receivers_.blocks[f.block].count;
      const int first = std::max(1, f.wanted / 4);
      bool is_lit = false;
      if (f.wanted == 1 || (is_unanimous(f, count, is_lit) && first * int(count) >= unanimous_rays))
        continue;
      for (uint8_t i = 0; i < count; ++i)
        for (int k = first; k < f.wanted; ++k) add_ray(index, i, uint8_t(i + 1), k);
    }
    trace_far();
    for (const FarBlock& f : far_) settle(f, out);
    far_.clear();
  }

  void settle(const FarBlock& f, RowChunk& out) {
    const ReceiverBlock& b = rows_.receivers_.blocks[f.block];
    bool is_lit = false;
    View& view = out.view[f.block - first_block_];
    if (is_unanimous(f, b.count, is_lit)) {
      view = is_lit ? lit : dark;
      if (is_lit) note_seen(f, b, 1);
      return;
    }
    float all = 0, visible = 0;
    for (uint32_t i = 0; i < b.count; ++i) {
      all += f.all[i];
      visible += f.visible[i];
    }
    if (!(all > 0)) return;  // no place on the patch and above the horizon was found
    view = partly;
    out.first[f.block - first_block_] = uint16_t(out.visible.size());
    for (uint32_t i = 0; i < b.count; ++i) {
      const float share = f.all[i] > 0 ? f.visible[i] / f.all[i] : visible / all;
      out.visible.push_back(uint8_t(std::lround(std::clamp(share, 0.0f, 1.0f) * 255)));
      if (seen_ != nullptr)
        seen_[b.first_point + i] += f.irradiance[i] / (pi_f * expected_) * share;
    }
  }

  void note_seen(const FarBlock& f, const ReceiverBlock& b, float share) {
    if (seen_ == nullptr) return;
    for (uint32_t i = 0; i < b.count; ++i)
      seen_[b.first_point + i] += f.irradiance[i] / (pi_f * expected_) * share;
  }

  const PatchRows& rows_;
  const Patch& patch_;
  std::vector<ShooterCell> cells_;  // with share 1
  ShooterBounds bounds_;
  std::vector<double> sent_;  // running sums of what cells send
  float offset_, expected_;
  const RayBudget& budget_;
  uint64_t stream_;
  float* seen_;
  Shooter near_shooter_;
  std::span<const ElementPoint> parts_;
  size_t first_block_ = 0, rays_ = 0;
  float visible_share_ = 0;
  std::vector<RayRecord> records_;
  std::vector<Transfer> transfers_;
  std::vector<double> all_, visible_;
  std::vector<FarBlock> far_;
  std::vector<FarRay> far_rays_;
  std::vector<Ray> ray_list_;
  std::vector<uint8_t> occluded_;
  TransferScratch scratch_;
};

bool PatchRows::shoot(uint32_t patch, const Shooter& shooter, float expected,
                      const RayBudget& budget, uint64_t stream, const StopFlag& stop, bool is_first,
                      std::vector<float>& seen, ShotReceived& out) {
  out.blocks.clear();
  const std::vector<ShooterCell> cells = shooter_cells(mesh_, patch, shooter);
  if (cells.empty() || !(expected > 0)) return true;
  Row made;
  Row& kept = rows_[patch];
  const bool is_new = kept.empty();
  if (is_new) {
    made.resize(chunks_);
    std::vector<size_t> rays(made.size(), 0);
    float* const seen_by = is_first ? seen.data() : nullptr;
    parallel_for(made.size(), threads_, [&](size_t chunk) {
      if (stop.load(std::memory_order_relaxed)) return;
      rays[chunk] = Maker(*this, patch, shooter, cells, expected, budget, stream, seen_by)
                        .run(chunk, made[chunk]);
    });
    if (stop) return false;
    for (const size_t r : rays) rays_ += r;
  }
  const Row& row = is_new ? made : kept;
  for (size_t chunk = 0; chunk < row.size(); ++chunk) apply(row[chunk], chunk, shooter, cells, out);
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

void PatchRows::apply(const RowChunk& row, size_t chunk, const Shooter& shooter,
                      const std::vector<ShooterCell>& cells, ShotReceived& out) const {
  const auto share_of = [&](size_t part) {
    return shooter.share.empty() ? 1.0f : shooter.share[part];
  };
  for (size_t k = 0; k < row.view.size(); ++k) {
    const View view = row.view[k];
    if (view == none) continue;
    const auto block = uint32_t(chunk * chunk_blocks + k);
    const ReceiverBlock& b = receivers_.blocks[block];
    out.blocks.push_back(block);
    float* const unoccluded = out.unoccluded.data() + b.first_point;
    float* const received = out.received.data() + b.first_point;
    if (view == near) {
      for (uint32_t i = 0; i < b.count; ++i) {
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
      continue;
    }
    alignas(64) float values[ReceiverBlock::most_points];
    const uint32_t padded = (b.count + Receivers::lanes - 1) / Receivers::lanes * Receivers::lanes;
    cells_irradiance(receivers_, b.first_slot, padded, cells, values);
    for (uint32_t i = 0; i < b.count; ++i) {
      unoccluded[i] = std::isfinite(values[i]) ? values[i] : 0.0f;
      received[i] = view == lit    ? unoccluded[i]
                    : view == dark ? 0.0f
                                   : unoccluded[i] * (1 / 255.0f) *
                                         float(row.visible[size_t(row.first[k]) + i]);
    }
  }
}

}  // namespace troffer
