#include "gather/gather_records.h"

#include <algorithm>
#include <cmath>

#include "gather/gather_pass.h"

namespace troffer {

bool is_one_surface(const CellHit& a, const CellHit& b, float spacing) {
  constexpr float least_cosine = 0.94f;  // 20°
  constexpr float flatness = 0.03f;      // in pixel spacings
  if (dot(a.normal, b.normal) < least_cosine) return false;
  const Vec3 d = b.position - a.position;
  const float off = std::max(std::abs(dot(d, a.horizon)), std::abs(dot(d, b.horizon)));
  const float flat = flatness * spacing;
  if (off <= flat) return true;
  const float bend = length(a.horizon - b.horizon) * length(d);
  return off <= flat + bend;
}

Ray PictureView::pixel_ray(int x, int y, float& spread) const {
  const float u = float(x) + 0.5f, v = float(y) + 0.5f;
  const Ray at = ray(u, v), next = ray(u + 1, v);
  spread = length(next.direction - at.direction) + length(next.origin - at.origin);
  return at;
}

void GatherRecords::leave_out(const std::vector<uint8_t>& flags) {
  uint32_t kept = 0, from = 0;
  for (size_t p = 0; p + 1 < first_.size(); ++p) {
    const uint32_t end = first_[p + 1];
    first_[p] = kept;
    for (; from < end; ++from)
      if (flags[from] == 0) records_[kept++] = records_[from];
  }
  first_.back() = kept;
  records_.resize(kept);
  records_.shrink_to_fit();
}

std::unique_ptr<GatherRecords> GatherRecords::make(const Cells& cells, const PictureView& view,
                                                   const GatherOptions& options,
                                                   const std::function<void(double)>& progress,
                                                   const StopFlag& stop, Counters& counters) {
  // A pixel reads its neighbours' fits. These read gathers within most_pixels, whose further rays
  // follow from gathers as far again, and usual_rays() around them. The rest is for lookups and
  // thinning.
  constexpr int border = 2 * GatherFits::most_pixels + GatherFits::usual_pixels + 7;
  // The window grows to whole tiles of the picture, so that a tile's rays are the same for every
  // window.
  constexpr int side = tile_side;
  const auto first = [&](int v) { return std::max(v - border, 0) / side * side; };
  const auto last = [&](int v) { return (v + border + side - 1) / side * side; };
  PixelWindow w = view.window;
  if (!options.is_trial)
    w = {std::max(first(w.x0), view.image.x0), std::max(first(w.y0), view.image.y0),
         std::min(last(w.x1), view.image.x1), std::min(last(w.y1), view.image.y1)};
  std::unique_ptr<GatherRecords> records(new GatherRecords(w));
  GatherPass pass(cells, view, options, stop, *records);
  if (!pass.run(progress, counters)) return nullptr;
  return records;
}

const GatherDistribution& GatherRecords::aim_at(int x, int y, const CellHit& hit,
                                                const LitRegions& places,
                                                CachedDistribution& last) const {
  const CellHit* at = &hit;
  uint32_t record = no_record;
  of_pixel(x, y, [&](uint32_t r) {
    const GatherRecord& n = records_[r];
    constexpr float close = 4;  // pixels
    if (length_squared(n.hit.position - hit.position) > sqr(close * n.spacing) ||
        !is_one_surface(n.hit, hit, n.spacing))
      return;
    at = &n.hit;
    record = r;
  });
  if (at != &hit && record == last.record) return last.aim;
  const int x0 = window_.x0 / tile_side, y0 = window_.y0 / tile_side;
  const int across = (window_.x1 + tile_side - 1) / tile_side - x0;
  const auto tile = size_t(y / tile_side - y0) * size_t(across) + size_t(x / tile_side - x0);
  const size_t n = places.all().size();
  last = {GatherDistribution(places, std::span(visible_).subspan(tile * n, n), rest_[tile], *at),
          record};
  return last.aim;
}

bool GatherRecords::irradiance_at(int x, int y, const CellHit& hit, uint32_t gloss, bool is_rough,
                                  FittedRecord& out) const {
  float weights = 0, nearest = 0;
  bool is_held = is_rough;
  out = {};
  for (int j = y - 1; j <= y + 1; ++j)
    for (int i = x - 1; i <= x + 1; ++i)
      of_pixel(i, j, [&](uint32_t r) {
        const GatherRecord& record = records_[r];
        if (gloss != GlossPlace::no_material && gloss != record.place.material) return;
        const float d2 = length_squared(record.hit.position - hit.position);
        // Neighbouring hits are farther apart than the spacing where one looks along a surface, up
        // to this factor.
        if (d2 > sqr(16 * record.spacing) || !is_one_surface(record.hit, hit, record.spacing))
          return;
        // The pixel's own record dominates, except near the border to the next pixel.
        const float w = 1 / sqr(d2 / sqr(record.spacing) + 0.03f);
        if (w > nearest) {
          nearest = w;
          is_held = is_rough || !fitted_[r].is_alone;
        }
        if (!is_rough && d2 > sqr(fitted_[r].reach)) return;
        out.irradiance += fitted_[r].irradiance * w;
        out.error += fitted_[r].error * w;
        out.gloss += fitted_[r].gloss * w;
        out.gloss_error += fitted_[r].gloss_error * w;
        out.rays = std::max(out.rays, fitted_[r].rays);
        weights += w;
      });
  if (weights == 0 || !is_held) return false;
  out.irradiance *= 1 / weights;
  out.error /= weights;
  out.gloss *= 1 / weights;
  out.gloss_error /= weights;
  return true;
}

}  // namespace troffer
