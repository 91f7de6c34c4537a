#include "render/further_rays.h"

#include <algorithm>
#include <numeric>

#include "base/parallel.h"
#include "render/edge_map.h"
#include "transport/allowed_error.h"

namespace troffer {

namespace {

int passes_of(int samples) {
  return (samples + samples_per_pass - 1) / samples_per_pass;
}

}  // namespace

FurtherRays::FurtherRays(const PreparedScene& scene, const ViewingCamera& camera,
                         const Integrator& integrator, const RenderOptions& options,
                         const TilePlan& plan)
    : scene_(scene), camera_(camera), render_(options), plan_(plan) {
  const PixelSampling sampling = integrator.sampling();
  most_ = most_viewing_rays(options);
  first_spp_ = std::max(options.spp, sampling.first);
  if (sampling.is_by_noise())
    most_.in_pixel = most_.in_mean = std::max(most_.in_pixel, sampling.most);
  steps_.first = uint32_t(passes_of(first_spp_));
  if (most_.in_pixel <= first_spp_) return;
  records_.emplace(plan.region);
  has_surrogates_ = integrator.has_surrogates();
  outlines_.emplace(scene, camera, plan.region, has_surrogates_, options.threads);
  if (sampling.is_by_noise()) {
    options_.error = float(sampling.error);
    options_.evenness = sampling.evenness;
    options_.proportion = sampling.proportion;
    options_.is_everywhere = options_.is_noise = true;
  }
  steps_.further = uint32_t(passes_of(most_.in_pixel - first_spp_));
  if (has_surrogates_) {
    options_.error = float(options.error);
    options_.is_everywhere = true;
    options_.most_even = float(most_even_samples);
    if (options.indirect == Indirect::none)
      options_.least_with_surrogates = options.method.row().refinement * options.spp;
    steps_.surrogates = 1;
  }
  if (are_at_once()) steps_.further = 1;
}

void FurtherRays::wait_for_leader() {
  wanted_.assign(pixels(), {uint32_t(first_spp_), 0});
}

void FurtherRays::decide_row(const RefinementView& view, int y) {
  for (int x = plan_.inner.x0; x < plan_.inner.x1; ++x) {
    WantedPixel& w = wanted_[records_->index(x, y)];
    if (has_surrogates_) w.surrogates = uint32_t(surrogates_wanted(view, x, y, options_));
    w.samples = uint32_t(
        samples_wanted(view, x, y, w.surrogates > 0, first_spp_, most_.in_pixel, options_));
  }
}

void FurtherRays::decide(const Film& film, double typical) {
  if (are_decided()) return;
  const EdgeMap edges(scene_, camera_, plan_.region, *outlines_, render_.threads);
  wait_for_leader();
  const PixelRect& r = plan_.inner;
  constexpr int rows_at_a_time = 8;
  const int bands = (r.height() + rows_at_a_time - 1) / rows_at_a_time;
  parallel_for(size_t(bands), render_.threads, [&](size_t band) {
    const int y0 = r.y0 + int(band) * rows_at_a_time, y1 = std::min(y0 + rows_at_a_time, r.y1);
    const PixelLooks looks(film, has_surrogates_, records_->window, y0, y1);
    for (int y = y0; y < y1; ++y) decide_row({looks, *records_, edges, typical}, y);
  });
  constexpr int surrogates_in_mean = 4096;
  for (const PixelRect& tile : plan_.tiles) {
    if (most_.in_mean < most_.in_pixel) limit_mean(tile, most_.in_mean, &WantedPixel::samples);
    if (has_surrogates_) limit_mean(tile, surrogates_in_mean, &WantedPixel::surrogates);
  }
}

// Limits the mean number over a tile. Pixels may exceed the mean as long as others want less; the
// largest wishes are cut to a common value.
void FurtherRays::limit_mean(const PixelRect& tile, int mean, uint32_t WantedPixel::*number) {
  std::vector<uint32_t*> most_last;
  for (const Pixel2& p : pixels_in_order(tile))
    most_last.push_back(&(wanted_[records_->index(p.x, p.y)].*number));
  std::sort(most_last.begin(), most_last.end(),
            [](const uint32_t* a, const uint32_t* b) { return *a < *b; });
  int64_t left = int64_t(most_last.size()) * mean;
  for (size_t i = 0; i < most_last.size(); ++i) {
    *most_last[i] =
        uint32_t(std::min<int64_t>(*most_last[i], left / int64_t(most_last.size() - i)));
    left -= *most_last[i];
  }
}

bool FurtherRays::restore(std::vector<WantedPixel> wanted) {
  for (const WantedPixel& w : wanted)
    if (w.samples < uint32_t(first_spp_) || w.samples > uint32_t(most_.in_pixel) ||
        w.surrogates > (has_surrogates_ ? uint32_t(most_surrogates) : 0))
      return false;
  wanted_ = std::move(wanted);
  return true;
}

std::vector<size_t> FurtherRays::noisiest_first() const {
  std::vector<double> wanted;
  for (const PixelRect& tile : plan_.tiles) {
    double sum = 0;
    for (int y = tile.y0; y < tile.y1; ++y)
      for (int x = tile.x0; x < tile.x1; ++x) sum += at(x, y).samples;
    wanted.push_back(sum / (double(tile.width()) * tile.height()));
  }
  std::vector<size_t> tiles(plan_.tiles.size());
  std::iota(tiles.begin(), tiles.end(), size_t(0));
  std::stable_sort(tiles.begin(), tiles.end(),
                   [&](size_t a, size_t b) { return wanted[a] > wanted[b]; });
  return tiles;
}

float FurtherRays::error_scale(uint32_t rays) const {
  float scale = 1;
  for (uint32_t n = rays / (16 * uint32_t(std::max(render_.spp, 1))); n > 0; n /= 4) scale *= 2;
  return scale;
}

}  // namespace troffer
