#include "methods/path_forecast.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "methods/path.h"
#include "transport/allowed_error.h"
#include "transport/purposes.h"

namespace troffer {

namespace {

constexpr uint32_t pixels_looked_at = 1024;
// Of each, two independent sets of as many paths, which are spread evenly within a set.
constexpr uint32_t sets = 2, paths_of_set = 4;
// About the least that cells take for a picture, in rays of paths, for each pixel, and for the rays
// that look for cells: chosen low, from the times of a few scenes. For smaller errors pixels take
// more; in coarse pictures what cells make errs by far less than it may.
constexpr double rays_of_pixel = 80, coarse_error = 0.1, growth = 0.65, rays_of_search = 1.5e5;
double least_of_pixel(double error) {
  return rays_of_pixel * std::pow(std::max(coarse_error / error, 1.0), growth);
}
// First rays of a pixel tell of its noise, and more than these few are needed for that.
constexpr int least_first = 8, most_first = 64;
constexpr int tiles_across = 8;  // of the picture, and as many upwards

// A pixel that is looked at, within the unit square that the picture stands for.
Vec2 place_looked_at(uint64_t stream, uint32_t i) {
  return SobolGroup(stream, purpose_camera, i).get2(0);
}

// Two sets of paths through each of some pixels, one after the other.
ViewingRays sets_of_rays(const PictureView& view, uint64_t stream) {
  ViewingRays rays;
  const auto width = float(view.image.width()), height = float(view.image.height());
  for (uint32_t i = 0; i < pixels_looked_at; ++i) {
    const Vec2 pixel = place_looked_at(stream, i);
    for (uint64_t k = 0; k < sets; ++k)
      for (uint32_t j = 0; j < paths_of_set; ++j) {
        rays.streams.push_back(hash_of(stream, uint64_t{i}, k));
        rays.samples.push_back(j);
        const Vec2 within = SobolGroup(rays.streams.back(), purpose_camera, j).get2(0);
        rays.rays.push_back(view.ray(std::floor(pixel.x * width) + within.x,
                                     std::floor(pixel.y * height) + within.y));
      }
  }
  return rays;
}

std::string name_of_forecast_ray(const void*, size_t i) {
  return "path " + std::to_string(i) + " of a forecast";
}

// Luminances, as the paths bring them.
std::vector<double> luminances(const PreparedScene& scene, const ViewingRays& rays,
                               Counters& counters) {
  const PathIntegrator paths(scene, {});
  const std::unique_ptr<IntegratorScratch> scratch = paths.make_scratch();
  RadianceBatch out;
  out.reset(rays.size());
  const CheckContext context(&rays, rays.size(), name_of_forecast_ray);
  paths.radiance(rays, *scratch, out, counters);
  std::vector<double> values;
  for (size_t i = 0; i < rays.size(); ++i) {
    const Rgb l = out.direct[i] + out.indirect[i];
    values.push_back(is_finite(l) ? double(luminance(l)) : 0);
  }
  return values;
}

// Means over the pixels that are looked at in one part of the picture.
struct Tile {
  double luminance = 0, pixels = 0;
  double variance = 0;         // of one path
  double variance_of_set = 0;  // of the mean of a set
};

// Pixels' own pairs do not tell their noise: where light comes by few of the paths, most pairs see
// nothing at all, and would want no more.
std::vector<Tile> tiles_of(uint64_t stream, const std::vector<double>& values) {
  std::vector<Tile> tiles(size_t(tiles_across * tiles_across));
  for (uint32_t i = 0; i < pixels_looked_at; ++i) {
    const Vec2 at = place_looked_at(stream, i) * float(tiles_across);
    Tile& tile = tiles[size_t(at.y) * tiles_across + size_t(at.x)];
    const double* a = &values[size_t{i} * sets * paths_of_set];
    const double* b = a + paths_of_set;
    double sum_a = 0, sum_b = 0;
    for (uint32_t j = 0; j < paths_of_set; ++j) {
      sum_a += a[j], sum_b += b[j];
      tile.variance += sqr(a[j] - b[j]) / 2 / paths_of_set;
    }
    tile.luminance += (sum_a + sum_b) / (sets * paths_of_set);
    tile.variance_of_set += sqr((sum_a - sum_b) / paths_of_set) / 2;
    ++tile.pixels;
  }
  std::erase_if(tiles, [](const Tile& t) { return t.pixels == 0; });
  for (Tile& t : tiles) {
    t.luminance /= t.pixels;
    t.variance /= t.pixels;
    t.variance_of_set /= t.pixels;
  }
  return tiles;
}

// Luminance that is usual in the picture.
double typical_of(const std::vector<Tile>& tiles) {
  std::vector<double> luminances;
  for (const Tile& t : tiles) luminances.push_back(t.luminance);
  return usual_luminance(std::move(luminances));
}

// How much better than independent ones n paths of a pixel are: their mean has a variance of
// n^-(1 + evenness). Extrapolated from a few, so that less is believed than they tell.
double evenness_of(const std::vector<Tile>& tiles, double error, double typical) {
  constexpr double believed = 0.5, most_evenness = 0.35;
  double independent = 0, even = 0;
  for (const Tile& t : tiles) {
    const double allowed = allowed_error(error, t.luminance, typical);
    independent += t.pixels * t.variance / sqr(allowed) / paths_of_set;
    even += t.pixels * t.variance_of_set / sqr(allowed);
  }
  if (!(even > 0) || !(independent > even)) return 0;
  return std::min(believed * std::log(independent / even) / std::log(double(paths_of_set)),
                  most_evenness);
}

// Viewing rays that a pixel wants on average.
double rays_wanted(const std::vector<Tile>& tiles, double error, double typical, double evenness,
                   int most) {
  double wanted = 0, pixels = 0;
  for (const Tile& t : tiles) {
    const double allowed = allowed_error(error, t.luminance, typical);
    wanted +=
        t.pixels * std::min(std::pow(t.variance / sqr(allowed), 1 / (1 + evenness)), double(most));
    pixels += t.pixels;
  }
  return wanted / pixels;
}

}  // namespace

PathForecast forecast_paths(const PreparedScene& scene, const PictureView& view, double error,
                            int most, uint64_t seed, Counters& counters) {
  Counters own;
  const uint64_t stream = hash_of(seed, uint64_t{0x7061'7468});
  const ViewingRays rays = sets_of_rays(view, stream);
  const std::vector<Tile> tiles = tiles_of(stream, luminances(scene, rays, own));
  counters += own;
  PathForecast f;
  const double typical = typical_of(tiles);
  // Most of the picture may show nothing to so few paths.
  f.viewing_rays = std::numeric_limits<double>::infinity();
  if (typical > 0) {
    f.evenness = evenness_of(tiles, error, typical);
    f.viewing_rays =
        std::max(rays_wanted(tiles, error, typical, f.evenness, most), double(least_first));
  }
  const double pixels = double(view.image.width()) * double(view.image.height());
  const auto traced = double(own.viewing_rays + own.extension_rays + own.shadow_rays);
  f.rays = traced / double(rays.size()) * f.viewing_rays * pixels;
  f.rays_for_cells = f.rays - least_of_pixel(error) * pixels - rays_of_search;
  return f;
}

PixelSampling sampling_by_paths(const PathForecast& forecast, double error, int most) {
  PixelSampling s;
  s.first = least_first;
  while (s.first < most_first && 4 * s.first < forecast.viewing_rays) s.first *= 2;
  s.most = most;
  s.error = error;
  s.evenness = forecast.evenness;
  return s;
}

}  // namespace troffer
