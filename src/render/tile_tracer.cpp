#include "render/tile_tracer.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "base/error.h"
#include "base/random.h"
#include "base/streams.h"
#include "transport/allowed_error.h"

namespace troffer {

namespace {

constexpr size_t rays_at_a_time = 1024;

}  // namespace

std::string name_of_ray(const void* work, size_t i) {
  const TileWork& w = *static_cast<const TileWork*>(work);
  return "pixel (" + std::to_string(w.pixels[i].x) + "," + std::to_string(w.pixels[i].y) +
         "), sample " + std::to_string(w.rays.samples[i]);
}

void TileTracer::begin(TileWork& w) const {
  if (!w.scratch) w.scratch = integrator_.make_scratch();
  w.rays.clear();
  w.pixels.clear();
}

// Adds the next `count` viewing rays of a pixel.
void TileTracer::add_rays(const Pixel2& p, uint32_t count, TileWork& w) const {
  add_viewing_rays(camera_, p, film_.estimate(p.x, p.y).samples, count, options_.seed, w.rays);
  w.pixels.resize(w.rays.size(), p);
}

// Returns the correction of LightOutlines for a ray.
Rgb TileTracer::edge_correction(const TileWork& w, size_t ray) const {
  return further_.outlines().edge_correction(w.pixels[ray].x, w.pixels[ray].y, w.rays.places[ray],
                                             w.radiance.known[ray].direct);
}

// Traces the collected rays, if any.
void TileTracer::trace(TileWork& w) {
  const CheckContext context(&w, w.rays.size(), name_of_ray);
  if (w.rays.size() == 0) return;
  w.radiance.reset(w.rays.size());
  if (further_.is_refined()) w.radiance.records.assign(w.rays.size(), {});
  if (further_.has_surrogates()) w.radiance.known.assign(w.rays.size(), {});
  integrator_.radiance(w.rays, *w.scratch, w.radiance, w.counters);
  for (size_t i = 0; i < w.rays.size(); ++i) {
    const auto [x, y] = w.pixels[i];
    if (further_.has_surrogates()) {
      const Rgb even = edge_correction(w, i);
      w.radiance.edge_correction.push_back(even);
      w.radiance.direct[i] += even;
      w.radiance.known[i].direct += even;
    }
    const bool is_first = film_.estimate(x, y).samples == 0;
    const float depth = camera_.depth(w.radiance.position[i]);
    if (!film_.add(x, y, w.radiance, i, depth)) ++w.counters.nan_samples;
    if (further_.is_recording())
      further_.records()->note(x, y, std::move(w.radiance.records[i]), is_first);
  }
}

void TileTracer::first_pass(const PixelRect& tile, uint32_t count, TileWork& w) {
  for (const Pixel2& p : pixels_in_order(tile)) add_rays(p, count, w);
  trace(w);
}

void TileTracer::further_pass(const PixelRect& tile, int first, TileWork& w) {
  for (const Pixel2& p : pixels_in_order(tile)) {
    const int count = std::min(samples_per_pass, int(further_.at(p.x, p.y).samples) - first);
    if (count <= 0) continue;
    add_rays(p, uint32_t(count), w);
    w.rays.neighbours.resize(w.rays.size(), further_.records()->around(p.x, p.y));
  }
  trace(w);
}

bool TileTracer::further_rays(const PixelRect& tile, TileWork& w) {
  const auto send = [&] {
    trace(w);
    w.rays.clear();
    w.pixels.clear();
  };
  const auto request_of = [&](const Pixel2& p) {
    const WantedPixel& wanted = further_.at(p.x, p.y);
    return std::pair(wanted.effort_divisor, further_.error_scale(wanted.samples));
  };
  std::vector<Pixel2> pixels = pixels_in_order(tile);
  std::stable_sort(pixels.begin(), pixels.end(),
                   [&](const Pixel2& a, const Pixel2& b) { return request_of(a) < request_of(b); });
  SampleRequest& request = w.rays.request;
  const auto end = [&](bool is_whole) {
    send();
    request.error_scale = 1;
    request.effort_divisor = 1;
    return is_whole;
  };
  for (const Pixel2& p : pixels) {
    if (request_of(p) != std::pair(request.effort_divisor, request.error_scale)) send();
    std::tie(request.effort_divisor, request.error_scale) = request_of(p);
    const uint32_t wanted = further_.at(p.x, p.y).samples;
    film_.expect_samples(p.x, p.y, wanted);
    int left = int(wanted) - further_.first_spp();
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

void TileTracer::surrogates(const PixelRect& tile, TileWork& w) {
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
    const size_t all = further_.at(p.x, p.y).surrogates;
    for (size_t first = 0; first < all;) {
      const size_t count = std::min(all - first, rays_at_a_time - w.rays.size());
      add_viewing_rays(camera_, p, uint32_t(first), uint32_t(count), seed, w.rays);
      w.pixels.resize(w.rays.size(), p);
      if (w.rays.size() >= rays_at_a_time) send();
      first += count;
    }
  }
  send();
}

double TileTracer::typical_luminance(const PixelRect& image, TileWork& w) const {
  constexpr int most = 16;  // rays along each side
  begin(w);
  // independent of the picture's own samples
  const uint64_t seed = hash_of(options_.seed, stream::typical_luminance);
  const int width = image.width(), height = image.height();
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
  return usual_luminance(std::move(values));
}

}  // namespace troffer
