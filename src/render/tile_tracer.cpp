#include "render/tile_tracer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/ablation.h"
#include "base/error.h"
#include "base/random.h"
#include "base/streams.h"
#include "transport/allowed_error.h"
#include "transport/costs.h"

namespace troffer {

namespace {

constexpr size_t rays_at_a_time = 1024;
constexpr double cost_of_cheaper = 8;  // a ray of Integrator::cheaper(), before any is tested

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

// Renumbers further rays, so that integrators treat them like first ones: sample numbers begin
// again after each block of first ones, with another random stream. Their places in the pixel stay.
void TileTracer::number_like_first(ViewingRays& rays) const {
  const auto first = uint32_t(further_.first_spp());
  for (size_t i = 0; i < rays.size(); ++i) {
    rays.streams[i] =
        hash_combine(rays.streams[i], stream::further_like_first + rays.samples[i] / first);
    rays.samples[i] %= first;
  }
}

// Returns the correction of LightOutlines for a ray.
Rgb TileTracer::edge_correction(const TileWork& w, size_t ray) const {
  return further_.outlines().edge_correction(w.pixels[ray].x, w.pixels[ray].y, w.rays.places[ray],
                                             w.radiance.known[ray].direct);
}

// Computes the radiance of the collected rays.
void TileTracer::compute(const FurtherWay& way, TileWork& w) {
  const CheckContext context(&w, w.rays.size(), name_of_ray);
  if (way.is_like_first) number_like_first(w.rays);
  w.radiance.reset(w.rays.size());
  if (further_.is_refined()) w.radiance.records.assign(w.rays.size(), {});
  if (further_.has_surrogates()) w.radiance.known.assign(w.rays.size(), {});
  if (!way.is_cheaper) {
    integrator_.radiance(w.rays, *w.scratch, w.radiance, w.counters);
  } else {
    if (!w.cheaper) w.cheaper = integrator_.cheaper()->make_scratch();
    integrator_.cheaper()->radiance(w.rays, *w.cheaper, w.radiance, w.counters);
    if (further_.has_surrogates()) {
      w.known.reset(w.rays.size());
      w.known.known.assign(w.rays.size(), {});
      integrator_.surrogate_radiance(w.rays, *w.scratch, w.known, w.counters);
      w.radiance.known.swap(w.known.known);
    }
  }
  if (!further_.has_surrogates()) return;
  for (size_t i = 0; i < w.rays.size(); ++i) {
    const Rgb even = edge_correction(w, i);
    w.radiance.edge_correction.push_back(even);
    w.radiance.direct[i] += even;
    w.radiance.known[i].direct += even;
  }
}

// Traces the collected rays, if any, into the film.
void TileTracer::trace(const FurtherWay& way, TileWork& w) {
  if (w.rays.size() == 0) return;
  compute(way, w);
  for (size_t i = 0; i < w.rays.size(); ++i) {
    const auto [x, y] = w.pixels[i];
    const bool is_first = film_.estimate(x, y).samples == 0;
    const float depth = camera_.depth(w.radiance.position[i]);
    if (!film_.add(x, y, w.radiance, i, depth)) ++w.counters.nan_samples;
    if (further_.is_recording())
      further_.records()->note(x, y, std::move(w.radiance.records[i]), is_first);
  }
}

void TileTracer::first_pass(const PixelRect& tile, uint32_t count, TileWork& w) {
  for (const Pixel2& p : pixels_in_order(tile)) add_rays(p, count, w);
  trace({}, w);
}

void TileTracer::further_pass(const PixelRect& tile, int first, TileWork& w) {
  for (const Pixel2& p : pixels_in_order(tile)) {
    const int count = std::min(samples_per_pass, int(further_.at(p.x, p.y).samples) - first);
    if (count <= 0) continue;
    add_rays(p, uint32_t(count), w);
    w.rays.neighbours.resize(w.rays.size(), further_.records()->around(p.x, p.y));
  }
  trace({}, w);
}

// Returns pixels that stand for the further rays of a tile: each for an equal number of them. Empty
// if the tile wants none.
std::vector<Pixel2> TileTracer::pixels_to_test(const PixelRect& tile, double wanted) const {
  std::vector<Pixel2> pixels;
  double so_far = 0;
  for (const Pixel2& p : pixels_in_order(tile)) {
    so_far += further_rays_planned(p);
    while (pixels.size() < test_pixels &&
           so_far >= (double(pixels.size()) + 0.5) / test_pixels * wanted)
      pixels.push_back(p);
  }
  return pixels;
}

double TileTracer::further_rays_planned(const Pixel2& p) const {
  return double(further_.at(p.x, p.y).samples) - further_.first_spp();
}

TestPixel TileTracer::test_pixel(const Pixel2& p, const TileWork& w) const {
  const PixelEstimate e = film_.estimate(p.x, p.y);
  const bool has_known = further_.at(p.x, p.y).surrogates > 0;
  return {has_known ? e.rest : e.luminance,
          allowed_error(options_.error, e.luminance,
                        std::max(double(w.rays.request.typical_luminance), 1e-30)),
          further_rays_planned(p), double(e.samples)};
}

// Traces test rays of one way: `count` of each pixel, from number `first` on.
void TileTracer::test(const std::vector<Pixel2>& pixels, uint32_t first, uint32_t count,
                      TestedWay& tested, TileWork& w) {
  const uint64_t seed = hash_of(options_.seed, stream::further_test);
  w.rays.clear();
  w.pixels.clear();
  for (const Pixel2& p : pixels) {
    add_viewing_rays(camera_, p, uint32_t(further_.first_spp()) + first, count, seed, w.rays);
    w.pixels.resize(w.rays.size(), p);
  }
  w.rays.request.effort_divisor = tested.way.effort_divisor;
  const double before = cost_of(w.counters), rays = double(first) * double(pixels.size());
  compute(tested.way, w);
  w.rays.request.effort_divisor = 1;
  tested.cost_of_ray =
      (tested.cost_of_ray * rays + cost_of(w.counters) - before) / (rays + double(w.rays.size()));
  for (size_t i = 0; i < w.rays.size(); ++i) {
    const Rgb all = w.radiance.direct[i] + w.radiance.indirect[i];
    double value = is_finite(all) ? double(luminance(all)) : 0;
    if (further_.at(w.pixels[i].x, w.pixels[i].y).surrogates > 0)
      value -= double(luminance(w.radiance.known[i].direct + w.radiance.known[i].indirect));
    tested.luminances[i / count].push_back(value);
  }
  w.rays.clear();
  w.pixels.clear();
}

// Tests ways at a few pixels of a tile, as long as a test costs little beside the least that the
// tile's further rays may cost. cost_of_first: of a first ray.
FurtherChoice TileTracer::choose_way(const PixelRect& tile, double cost_of_first, TileWork& w) {
  constexpr double share = 1.0 / 16;           // of the cost of all further rays, for each test
  constexpr uint32_t most_rays_of_pixel = 64;  // in a test
  double wanted = 0;
  for (const Pixel2& p : pixels_in_order(tile)) wanted += further_rays_planned(p);
  FurtherChoice best{further_ways.front()};
  if (!further_.has_surrogates() || !(wanted > 0) || is_left_out<"further ways">()) return best;
  const std::vector<Pixel2> pixels = pixels_to_test(tile, wanted);
  std::vector<TestPixel> before;
  double planned = 0;
  for (const Pixel2& p : pixels) {
    before.push_back(test_pixel(p, w));
    planned += before.back().planned / test_pixels;
  }
  const double pixels_of_tile = wanted / planned;
  std::vector<TestedWay> tested;
  best = choose_further_way(before, cost_of_first, tested, further_.most_even());
  for (size_t k = further_ways.size(); k-- > 0;) {
    const FurtherWay& way = further_ways[k];
    if (way.is_cheaper && integrator_.cheaper() == nullptr) continue;
    const double budget = share * best.cost * pixels_of_tile,
                 expected =
                     way.is_cheaper ? cost_of_cheaper : cost_of_first / double(way.effort_divisor);
    if (budget < expected * test_pixels * test_rays_of_pixel) continue;
    TestedWay& t = tested.emplace_back(TestedWay{way, 0, {}});
    test(pixels, 0, test_rays_of_pixel, t, w);
    const auto rays =
        uint32_t(std::min(budget / (t.cost_of_ray * test_pixels), double(most_rays_of_pixel)));
    if (rays > 2 * test_rays_of_pixel)
      test(pixels, test_rays_of_pixel, rays - test_rays_of_pixel, t, w);
    best = choose_further_way(before, cost_of_first, tested, further_.most_even());
  }
  return best;
}

bool TileTracer::further_rays(const PixelRect& tile, TileWork& w) {
  const double cost_of_first =
      (cost_of(w.before) - cost_of_surrogate * double(w.before.surrogates)) /
      std::max(double(w.before.viewing_rays), 1.0);
  const FurtherChoice choice = choose_way(tile, cost_of_first, w);
  const auto send = [&] {
    trace(choice.way, w);
    w.rays.clear();
    w.pixels.clear();
  };
  std::vector<Pixel2> pixels = pixels_in_order(tile);
  // Two uncertain plans are averaged: the pixel's own, from few rays around it, and the tile's,
  // from few test pixels.
  const auto wanted = [&](const Pixel2& p) {
    constexpr double most = 1 << 16;
    const double first = further_.first_spp(), own = further_.at(p.x, p.y).samples - first,
                 rays = choice.way.is_like_first ? own * choice.times
                                                 : 0.5 * (own * choice.times + choice.rays);
    return uint32_t(std::min(first + std::ceil(rays), most));
  };
  std::stable_sort(pixels.begin(), pixels.end(), [&](const Pixel2& a, const Pixel2& b) {
    return further_.error_scale(wanted(a)) < further_.error_scale(wanted(b));
  });
  SampleRequest& request = w.rays.request;
  request.effort_divisor = choice.way.effort_divisor;
  const auto end = [&](bool is_whole) {
    send();
    request.error_scale = 1;
    request.effort_divisor = 1;
    return is_whole;
  };
  for (const Pixel2& p : pixels) {
    const float scale = further_.error_scale(wanted(p));
    if (scale != request.error_scale) send();
    request.error_scale = scale;
    film_.expect_samples(p.x, p.y, wanted(p));
    int left = int(wanted(p)) - further_.first_spp();
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
  // Few single paths would miss most of a picture's light.
  if (const double of_forecast = integrator_.sampling().typical; of_forecast > 0)
    return of_forecast;
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
