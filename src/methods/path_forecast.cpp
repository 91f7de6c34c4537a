#include "methods/path_forecast.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "base/streams.h"
#include "transport/allowed_error.h"
#include "transport/costs.h"
#include "transport/purposes.h"

namespace troffer {

namespace {

constexpr uint32_t pixels_looked_at = 1024;
// Sets per test pixel and paths per set. Sets are independent; the paths within one are stratified.
constexpr uint32_t sets = 2, paths_of_set = 4;
// Least cost of a picture by cells, in rays of paths: per pixel, and for finding cells. Measured:
// the times of a few scenes, rounded down. A pixel costs more for errors below `coarse_error`. For
// larger ones it costs no less, because cells then err by far less than they may.
constexpr double rays_of_pixel = 80, coarse_error = 0.1, growth = 0.65, rays_of_search = 1.5e5;
double least_of_pixel(double error) {
  return rays_of_pixel * std::pow(std::max(coarse_error / error, 1.0), growth);
}
// Limits of the number of first rays of a pixel. They estimate its noise, for which fewer are too
// few.
constexpr int least_first = 8, most_first = 64;
// Other numbers of light samples are tested only for pictures that cost this many times the test
// paths. By judgement: the tests are then a small part of the work.
constexpr double fewest_tests = 16;
// Share of the picture's cost that learning lights may take. By judgement, likewise.
constexpr double share_to_learn = 1.0 / 64;
constexpr int tiles_across = 8;  // test pixels are grouped by 8 × 8 parts of the picture

// Returns the place of test pixel i in the unit square that stands for the picture.
Vec2 place_looked_at(uint64_t stream, uint32_t i) {
  return SobolGroup(stream, purpose_camera, i).get2(0);
}

// Returns the viewing rays of all test pixels: for each, one set of paths after the other.
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

// Luminance of each path; 0 where it is not finite.
std::vector<double> luminances(const Integrator& paths, const ViewingRays& rays,
                               Counters& counters) {
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

// Means over the test pixels in one part of the picture.
struct Tile {
  double luminance = 0, pixels = 0;
  double variance = 0;         // variance of one path
  double variance_of_set = 0;  // variance of the mean of a set
};

// Groups test pixels by part of the picture. A single pixel's pair does not show its noise: where
// few paths bring light, most pairs see nothing and would ask for no more rays.
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

// Returns the usual luminance of the picture (usual_luminance()).
double typical_of(const std::vector<Tile>& tiles) {
  std::vector<double> luminances;
  for (const Tile& t : tiles) luminances.push_back(t.luminance);
  return usual_luminance(std::move(luminances));
}

// Returns the exponent that n stratified paths gain over independent ones: their mean has a
// variance of n^-(1+evenness). Sets of four are few to extrapolate from, so only half of it is
// believed.
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

// Sets how many viewing rays pixels take, on average and in proportion to their noise.
void set_rays(const std::vector<Tile>& tiles, double error, int most, PathForecast& f) {
  std::vector<double> wanted;  // by each test pixel
  for (const Tile& t : tiles)
    wanted.insert(wanted.end(), size_t(t.pixels),
                  std::pow(t.variance / sqr(allowed_error(error, t.luminance, f.typical)),
                           1 / (1 + f.evenness)));
  f.proportion = proportion_of_samples(wanted, f.evenness);
  double sum = 0;
  for (const double w : wanted)
    sum += std::min(f.proportion * share_of_samples(w, f.evenness), double(most));
  f.viewing_rays = std::max(sum / double(wanted.size()), double(least_first));
}

// Results of test paths that all take the same number of light samples.
struct Tested {
  std::vector<Tile> tiles;
  double cost = 0;  // of a path
};

Tested test_paths(const PathsToTest& paths, const LightSampling& lights, const ViewingRays& rays,
                  uint64_t stream, Counters& counters) {
  Counters own;
  Tested t;
  t.tiles = tiles_of(stream, luminances(*paths(lights), rays, own));
  t.cost = cost_of(own) / double(rays.size());
  counters += own;
  return t;
}

// Returns the variance over the squared allowed error, summed over all test pixels, and the cost.
PathTest summed(const Tested& t, double error, double typical) {
  PathTest sum{0, t.cost};
  for (const Tile& tile : t.tiles)
    sum.variance +=
        tile.pixels * tile.variance / sqr(allowed_error(error, tile.luminance, typical));
  return sum;
}

}  // namespace

uint32_t cheapest_light_samples(const PathTest& one, const PathTest& few) {
  constexpr double k = few_light_samples;
  const double shared = std::max((one.variance - few.variance) * k / (k - 1), 0.0),
               rest = std::max(one.variance - shared, 0.0),
               sample = std::max((few.cost - one.cost) / (k - 1), 0.0);
  const auto work = [&](uint32_t n) { return (rest + shared / n) * (one.cost + sample * (n - 1)); };
  uint32_t best = 1;
  for (uint32_t n = 2; n <= most_light_samples; n *= 2)
    if (work(n) < work(best)) best = n;
  return best;
}

PathForecast forecast_paths(const PathsToTest& paths, const LightsToLearn& learn,
                            const PictureView& view, double error, int most, uint64_t seed,
                            Counters& counters) {
  const uint64_t stream = hash_of(seed, stream::path_forecast);
  const ViewingRays rays = sets_of_rays(view, stream);
  const double pixels = double(view.image.width()) * double(view.image.height());
  const auto test = [&](const LightSampling& l) {
    return test_paths(paths, l, rays, stream, counters);
  };
  Tested one = test({});
  PathForecast least;
  least.typical = typical_of(one.tiles);
  // If so few paths see nothing in most of the picture, the forecast is infinite.
  least.viewing_rays = std::numeric_limits<double>::infinity();
  least.rays = std::numeric_limits<double>::infinity();
  const auto consider = [&](const Tested& tested, const LightSampling& lights) {
    PathForecast f;
    f.typical = least.typical;
    f.lights = lights;
    f.evenness = evenness_of(tested.tiles, error, f.typical);
    set_rays(tested.tiles, error, most, f);
    f.rays = tested.cost * f.viewing_rays * pixels;
    const bool is_less = f.rays < least.rays;
    if (is_less) least = f;
    return is_less;
  };
  if (least.typical > 0) consider(one, {});
  const double tested = one.cost * double(rays.size());
  if (least.rays > fewest_tests * tested && std::isfinite(least.rays)) {
    if (learn) {
      const LightSampling learned{1, learn(share_to_learn * least.rays, counters)};
      Tested by_learned = test(learned);
      if (consider(by_learned, learned)) one = std::move(by_learned);
    }
    LightSampling lights = least.lights;
    lights.samples_at_first = few_light_samples;
    const Tested few = test(lights);
    const uint32_t n = cheapest_light_samples(summed(one, error, least.typical),
                                              summed(few, error, least.typical));
    lights.samples_at_first = n;
    if (n > 1) consider(n == few_light_samples ? few : test(lights), lights);
  }
  least.rays_for_cells = least.rays - least_of_pixel(error) * pixels - rays_of_search;
  return least;
}

PixelSampling sampling_by_paths(const PathForecast& forecast, double error, int most) {
  PixelSampling s;
  s.first = least_first;
  while (s.first < most_first && 4 * s.first < forecast.viewing_rays) s.first *= 2;
  s.most = most;
  s.error = error;
  s.evenness = forecast.evenness;
  s.proportion = forecast.proportion;
  s.typical = forecast.typical;
  return s;
}

}  // namespace troffer
