// Refinement of a rendering in progress (rendering.h).
#include <algorithm>
#include <tuple>
#include <utility>

#include "base/error.h"
#include "base/random.h"
#include "base/streams.h"
#include "render/edge_map.h"
#include "render/rendering.h"
#include "transport/allowed_error.h"

namespace troffer {

namespace {

// Number of parts of the further rays after which RenderOptions::error_limit is tested.
constexpr size_t looks = 32;

}  // namespace

// Traces the further rays that the first pass calls for.
RenderEnd Rendering::refine() {
  const bool is_same_in_crops = options_.method.row().is_same_in_crops;
  if (!leads())  // rank 0 sends the plans with each tile
    refining_.wanted.emplace(refining_.records->records.size(), refining_.first_spp);
  else if (!refining_.wanted)
    refining_.wanted =
        further_rays(is_same_in_crops ? typical_luminance() : mean_luminance(plan_.asked));
  refining_.has_begun = true;
  return refines_at_once() ? refine_by_tiles() : refine_by_passes();
}

RenderEnd Rendering::refine_by_passes() {
  if (options_.group != nullptr) share_records();
  const PixelRecords& records = *refining_.records;
  const uint32_t at_a_time = refining_.is_stepwise ? 1 : steps_.further;
  for (uint32_t pass = 0; pass < steps_.further; pass += at_a_time) {
    const uint32_t begin = steps_.first + pass, end = begin + at_a_time;
    step({begin, end}, all_tiles(), [&](uint32_t number, const PixelRect& tile, Work& w) {
      const int first = refining_.first_spp + int(number - steps_.first) * samples_per_batch;
      for (const Pixel2& p : pixels_in_order(tile)) {
        const int count =
            std::min(samples_per_batch, refining_.wanted->samples[records.index(p.x, p.y)] - first);
        if (count <= 0) continue;
        add_rays(p, uint32_t(count), w);
        w.rays.neighbours.resize(w.rays.size(), records.around(p.x, p.y));
      }
      return trace_all(w);
    });
    if (progress_.was_stopped) return RenderEnd::stopped;
    if (pass + at_a_time < steps_.further && is_good_enough(end - 1, all_tiles()))
      return RenderEnd::good_enough;
  }
  return RenderEnd::complete;
}

// Traces all further rays of a tile at once: a few pixels may get many.
RenderEnd Rendering::refine_by_tiles() {
  const uint32_t further = steps_.first + steps_.surrogates;
  const auto act = [&](uint32_t number, const PixelRect& tile, Work& w) {
    return number < further ? add_surrogates(tile, w) : refine(tile, w);
  };
  if (!refining_.is_stepwise) {
    // Start the longest tiles first.
    step({steps_.first, steps_.all()}, leads() ? noisiest_first() : all_tiles(), act);
    return progress_.was_stopped ? RenderEnd::stopped : RenderEnd::complete;
  }
  if (steps_.surrogates > 0) step({steps_.first, further}, all_tiles(), act);
  Tiles left = is_limited() && leads() ? noisiest_first() : all_tiles();
  const size_t parts = options_.error_limit > 0 ? std::min(looks, left.size()) : 1;
  const size_t in_all = left.size();
  for (size_t part = 0; part < parts; ++part) {
    if (progress_.was_stopped) return RenderEnd::stopped;
    if (is_good_enough(further - 1, left)) return RenderEnd::good_enough;
    const auto end = std::ptrdiff_t(in_all * (part + 1) / parts - (in_all - left.size()));
    step({further, further + 1}, Tiles(left.begin(), left.begin() + end), act);
    left.erase(left.begin(), left.begin() + end);
  }
  return progress_.was_stopped ? RenderEnd::stopped : RenderEnd::complete;
}

// Returns the tiles ordered by the mean number of samples wanted, so that scarce time goes to the
// noisiest.
Rendering::Tiles Rendering::noisiest_first() const {
  std::vector<double> wanted;
  for (const PixelRect& tile : plan_.tiles) {
    double sum = 0;
    for (int y = tile.y0; y < tile.y1; ++y)
      for (int x = tile.x0; x < tile.x1; ++x)
        sum += refining_.wanted->samples[refining_.records->index(x, y)];
    wanted.push_back(sum / (double(tile.width()) * tile.height()));
  }
  Tiles tiles = all_tiles();
  std::stable_sort(tiles.begin(), tiles.end(),
                   [&](size_t a, size_t b) { return wanted[a] > wanted[b]; });
  return tiles;
}

// Returns the error scale of each of `rays` rays of a pixel. Their mean still errs at most half as
// much as that of the usual number. Powers of two let the rays of many pixels share batches.
float Rendering::error_scale(int rays) const {
  float loose = 1;
  for (int n = rays / (16 * std::max(options_.spp, 1)); n > 0; n /= 4) loose *= 2;
  return loose;
}

// Returns false if it was stopped before all of the tile's rays were traced.
bool Rendering::refine(const PixelRect& tile, Work& w) {
  constexpr size_t rays_at_a_time = 1024;
  const auto send = [&] {
    trace_all(w);
    w.rays.clear();
    w.pixels.clear();
  };
  const auto wanted = [&](const Pixel2& p) {
    return refining_.wanted->samples[refining_.records->index(p.x, p.y)];
  };
  const auto leniency = [&](const Pixel2& p) {
    return std::pair(refining_.wanted->effort_divisor[refining_.records->index(p.x, p.y)],
                     error_scale(wanted(p)));
  };
  std::vector<Pixel2> pixels = pixels_in_order(tile);
  std::stable_sort(pixels.begin(), pixels.end(),
                   [&](const Pixel2& a, const Pixel2& b) { return leniency(a) < leniency(b); });
  const auto end = [&](bool is_whole) {
    send();
    w.rays.request.error_scale = 1;
    w.rays.request.effort_divisor = 1;
    return is_whole;
  };
  for (const Pixel2& p : pixels) {
    if (leniency(p) != std::pair(w.rays.request.effort_divisor, w.rays.request.error_scale)) send();
    std::tie(w.rays.request.effort_divisor, w.rays.request.error_scale) = leniency(p);
    film_.expect_samples(p.x, p.y, uint32_t(wanted(p)));
    int left = wanted(p) - refining_.first_spp;
    while (left > 0) {
      if (stop_.load(std::memory_order_relaxed)) return end(false);
      const int count = std::min(left, int(rays_at_a_time - w.rays.size()));
      add_rays(p, uint32_t(count), w);
      left -= count;
      if (w.rays.size() == rays_at_a_time) send();
    }
  }
  return end(true);
}

// Decides the further rays and surrogate samples of all pixels of the region, from the first pass.
Rendering::FurtherRays Rendering::further_rays(double typical) const {
  const PixelRecords& records = *refining_.records;
  const EdgeMap edges(scene_, camera_, plan_.region, *refining_.outlines, options_.threads);
  FurtherRays wanted(records.records.size(), refining_.first_spp);
  const PixelRect& r = plan_.inner;
  const auto row = [&](const RefinementView& view, int y) {
    for (int x = r.x0; x < r.x1; ++x) {
      const size_t i = records.index(x, y);
      if (refining_.has_surrogates)
        wanted.surrogates[i] = surrogates_wanted(view, x, y, refining_.options);
      const WantedSamples samples =
          samples_wanted(view, x, y, wanted.surrogates[i] > 0, refining_.first_spp,
                         refining_.most.in_pixel, refining_.options);
      wanted.samples[i] = samples.count;
      wanted.effort_divisor[i] = samples.effort_divisor;
    }
  };
  constexpr int rows_at_a_time = 8;
  const int bands = (r.height() + rows_at_a_time - 1) / rows_at_a_time;
  parallel_for(size_t(bands), options_.threads, [&](size_t band) {
    const int y0 = r.y0 + int(band) * rows_at_a_time, y1 = std::min(y0 + rows_at_a_time, r.y1);
    const PixelLooks looks(film_, refining_.has_surrogates, records.window, y0, y1);
    for (int y = y0; y < y1; ++y) row({looks, records, edges, typical}, y);
  });
  constexpr int surrogates_in_mean = 4096;
  for (const PixelRect& tile : plan_.tiles) {
    if (refining_.most.in_mean < refining_.most.in_pixel) keep_in_bounds(tile, wanted);
    if (refining_.has_surrogates) keep_in_bounds(tile, surrogates_in_mean, wanted.surrogates);
  }
  return wanted;
}

// Limits the mean number over a tile. Pixels may exceed the mean as long as others want less; the
// largest wishes are cut to a common value.
void Rendering::keep_in_bounds(const PixelRect& tile, int mean, std::vector<int>& wanted) const {
  std::vector<int*> most_last;
  for (const Pixel2& p : pixels_in_order(tile))
    most_last.push_back(&wanted[refining_.records->index(p.x, p.y)]);
  std::sort(most_last.begin(), most_last.end(), [](const int* a, const int* b) { return *a < *b; });
  int64_t left = int64_t(most_last.size()) * mean;
  for (size_t i = 0; i < most_last.size(); ++i) {
    *most_last[i] = int(std::min<int64_t>(*most_last[i], left / int64_t(most_last.size() - i)));
    left -= *most_last[i];
  }
}

// Limits viewing rays. Pixels that get fewer rays than wanted get a smaller effort divisor.
void Rendering::keep_in_bounds(const PixelRect& tile, FurtherRays& wanted) const {
  const std::vector<Pixel2> pixels = pixels_in_order(tile);
  std::vector<int> asked;
  for (const Pixel2& p : pixels)
    asked.push_back(wanted.samples[refining_.records->index(p.x, p.y)]);
  keep_in_bounds(tile, refining_.most.in_mean, wanted.samples);
  for (size_t k = 0; k < pixels.size(); ++k) {
    const size_t i = refining_.records->index(pixels[k].x, pixels[k].y);
    for (int n = wanted.samples[i]; n < asked[k] && wanted.effort_divisor[i] > 1; n *= 2)
      wanted.effort_divisor[i] /= 2;
  }
}

// Adds surrogate samples to the pixels of a tile. Returns true.
bool Rendering::add_surrogates(const PixelRect& tile, Work& w) {
  constexpr size_t rays_at_a_time = 1024;
  // independent of the samples
  const uint64_t seed = hash_of(options_.seed, stream::surrogate_rays);
  const auto send = [&] {
    const CheckContext context(&w, w.rays.size(), name_of_ray);
    w.radiance.reset(w.rays.size());
    w.radiance.known.assign(w.rays.size(), {});
    integrator_.surrogate_radiance(w.rays, *w.scratch, w.radiance, w.counters);
    for (size_t i = 0; i < w.rays.size(); ++i) {
      w.radiance.known[i].direct += edge_correction(w, i);
      film_.add_surrogate(w.pixels[i].x, w.pixels[i].y, w.radiance, i,
                          camera_.depth(w.radiance.position[i]));
    }
    w.rays.clear();
    w.pixels.clear();
  };
  for (const Pixel2& p : pixels_in_order(tile)) {
    const auto all = size_t(refining_.wanted->surrogates[refining_.records->index(p.x, p.y)]);
    for (size_t first = 0; first < all;) {
      const size_t count = std::min(all - first, rays_at_a_time - w.rays.size());
      add_viewing_rays(camera_, p, uint32_t(first), uint32_t(count), seed, w.rays);
      w.pixels.resize(w.rays.size(), p);
      if (w.rays.size() >= rays_at_a_time) send();
      first += count;
    }
  }
  send();
  return true;
}

// Returns the mean luminance of the whole picture without its brightest twentieth, which holds
// visible lamps. It traces few rays, which enter neither the picture nor its statistics.
double Rendering::typical_luminance() {
  if (refining_.typical) return *refining_.typical;
  constexpr int most = 16;  // rays along each side
  Work& w = work_[0];
  if (!w.scratch) w.scratch = integrator_.make_scratch();
  w.rays.clear();
  w.pixels.clear();
  // independent of the picture's own samples
  const uint64_t seed = hash_of(options_.seed, stream::typical_luminance);
  const int width = plan_.image.width(), height = plan_.image.height();
  const int nx = std::min(most, width), ny = std::min(most, height);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      w.pixels.push_back({i * width / nx, j * height / ny});
      add_viewing_rays(camera_, w.pixels.back(), 0, 1, seed, w.rays);
    }
  // Gather records exist only within the window; without pixels, crops and whole pictures agree.
  w.rays.pixels.clear();
  w.rays.places.clear();
  const CheckContext context(&w, w.rays.size(), name_of_ray);
  w.radiance.reset(w.rays.size());
  Counters uncounted;
  w.rays.request.is_coarse = true;
  integrator_.radiance(w.rays, *w.scratch, w.radiance, uncounted);
  w.rays.request.is_coarse = false;
  std::vector<double> values;
  for (size_t i = 0; i < w.rays.size(); ++i) {
    const Rgb l = w.radiance.direct[i] + w.radiance.indirect[i];
    values.push_back(is_finite(l) ? double(luminance(l)) : 0);
  }
  refining_.typical = usual_luminance(std::move(values));
  return *refining_.typical;
}

}  // namespace troffer
