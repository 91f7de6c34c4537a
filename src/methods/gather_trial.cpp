#include "methods/gather_trial.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/random.h"
#include "base/streams.h"
#include "base/units.h"
#include "transport/allowed_error.h"
#include "transport/costs.h"
#include "transport/purposes.h"

namespace troffer {

namespace {

constexpr int side = GatherRecords::tile_side;
// A trial looks at no more than this share of the picture, unless one window is more.
constexpr double most_share = 0.125;
// Viewing rays per pixel that a trial traces. More would tell little about a pixel's variance.
constexpr int most_tried = 16;

int tried_rays(const GatherTrialInput& in) {
  return std::min(in.viewing_rays, most_tried);
}

// Rows and columns of windows, spread evenly over the picture.
struct Windows {
  int across = 1, down = 1;
  int count() const { return across * down; }
};
Windows windows_of(const PixelWindow& image) {
  const double pixels = double(image.width()) * image.height(), most = most_share * pixels;
  for (const Windows w : {Windows{3, 2}, Windows{2, 2}, Windows{2, 1}})
    if (w.count() * side * side <= most) return w;
  return {};
}

// The window is one tile of the gathers, so that its fits have their usual neighbours.
PixelWindow window_of(const PixelWindow& image, const Windows& windows, int i) {
  const auto first = [](int n, int k, int of) {
    return std::min((2 * k + 1) * n / (2 * of), n - side) / side * side;
  };
  const int x = first(image.width(), i % windows.across, windows.across),
            y = first(image.height(), i / windows.across, windows.down);
  return {x, y, x + side, y + side};
}

// Returns first viewing rays of all pixels of a window.
ViewingRays rays_of(const PictureView& view, const GatherTrialInput& in) {
  ViewingRays rays;
  rays.request.is_picture = true;
  rays.request.typical_luminance = float(in.cached.typical);
  for (int y = view.window.y0; y < view.window.y1; ++y)
    for (int x = view.window.x0; x < view.window.x1; ++x) {
      const uint64_t stream =
          hash_of(in.options.seed, uint64_t(x), uint64_t(y), stream::gather_trial);
      for (int k = 0; k < tried_rays(in); ++k) {
        const Vec2 place = SobolGroup(stream, purpose_camera, uint32_t(k)).get2(0);
        rays.rays.push_back(view.ray(float(x) + place.x, float(y) + place.y));
        rays.streams.push_back(stream);
        rays.samples.push_back(uint32_t(k));
        rays.pixels.push_back({x, y});
        rays.places.push_back(place);
      }
    }
  return rays;
}

// Returns the variance of one ray of each pixel over its squared allowed error, without the known
// part of its light, which surrogate samples resolve.
std::vector<double> own_wanted(const RadianceBatch& seen, const GatherTrialInput& in) {
  const auto n = size_t(tried_rays(in));
  const auto luminance_of = [](const Rgb& l) { return is_finite(l) ? double(luminance(l)) : 0; };
  std::vector<double> own;
  for (size_t first = 0; first + n <= seen.direct.size(); first += n) {
    double all = 0, sum = 0, squares = 0;
    for (size_t i = first; i < first + n; ++i) {
      const double light = luminance_of(seen.direct[i] + seen.indirect[i]),
                   rest = light - luminance_of(seen.known[i].direct + seen.known[i].indirect);
      all += light / double(n);
      sum += rest;
      squares += sqr(rest);
    }
    const double of_pixel = squares - sqr(sum) / double(n),
                 variance = std::max(of_pixel, 0.0) / double(std::max<size_t>(n - 1, 1));
    own.push_back(variance / sqr(allowed_error(in.error, all, in.cached.typical)));
  }
  return own;
}

// Appends, for each pixel of a window, the number of rays that it alone would take. The few rays of
// one pixel may miss what varies in it, so each is judged with its neighbours.
void add_wanted(const std::vector<double>& own, std::vector<double>& wanted) {
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      double sum = 0, pixels = 0;
      for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, side - 1); ++ny)
        for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, side - 1); ++nx, ++pixels)
          sum += own[size_t(ny * side + nx)];
      wanted.push_back(sum / pixels);
    }
}

// Returns the mean cost of a pixel's further viewing rays for the same error as that of cached
// paths. Every tile of the picture takes all of them in one way: like first ones, which cost
// `of_first` each, or as cached paths, which vary more.
double cost_of_further(const std::vector<double>& wanted, double of_first,
                       const GatherTrialInput& in) {
  constexpr size_t of_tile = side / 2;
  const double pixels = double(in.view.image.width()) * in.view.image.height(),
               of_cached = in.cached.rays / pixels / in.cached.viewing_rays,
               proportion = proportion_of_samples(wanted, 0);
  std::vector<double> like_first(wanted.size() / sqr(of_tile)), cached(like_first.size());
  for (size_t i = 0; i < wanted.size(); ++i) {
    const double rays = proportion * share_of_samples(wanted[i], 0);
    if (rays <= in.viewing_rays) continue;
    const size_t x = i % size_t(side), row = i / size_t(side),
                 tile = row / of_tile * 2 + x / of_tile;
    like_first[tile] += (rays - in.viewing_rays) * of_first;
    cached[tile] += std::max(rays, in.cached.viewing_rays) * of_cached;
  }
  double sum = 0;
  for (size_t t = 0; t < cached.size(); ++t) sum += std::min(like_first[t], cached[t]);
  return sum / double(wanted.size());
}

}  // namespace

GatherTrial try_gathers(const GatherTrialInput& in, const StopFlag& stop, Counters& counters) {
  GatherOptions options = in.options;
  options.is_trial = true;
  options.group = nullptr;  // every process makes the same trial
  const PixelWindow& image = in.view.image;
  const Windows windows = windows_of(image);
  const double pixels = double(image.width()) * image.height(),
               looked_at = windows.count() * side * side;
  GatherTrial trial;
  if (image.width() < side || image.height() < side) return trial;
  double of_gathers = 0, of_first = 0;
  std::vector<double> wanted;
  for (int i = 0; i < windows.count(); ++i) {
    PictureView view = in.view;
    view.window = window_of(image, windows, i);
    Counters gathering, first;
    std::shared_ptr<const GatherRecords> records =
        GatherRecords::make(in.cells, view, options, nullptr, stop, gathering);
    if (!records) return trial;
    in.reflected.set_records(std::move(records));
    const ViewingRays rays = rays_of(view, in);
    const std::unique_ptr<IntegratorScratch> scratch = in.gathers.make_scratch();
    RadianceBatch out;
    out.reset(rays.size());
    out.known.assign(rays.size(), {});
    in.gathers.radiance(rays, *scratch, out, first);
    of_gathers += cost_of(gathering);
    of_first += cost_of(first);
    counters += gathering;
    counters += first;
    add_wanted(own_wanted(out, in), wanted);
  }
  trial.of_gathers = of_gathers / looked_at * pixels;
  const double of_viewing_ray = of_first / looked_at / tried_rays(in);
  trial.of_first = of_viewing_ray * in.viewing_rays * pixels;
  trial.cost =
      trial.of_gathers + trial.of_first + pixels * cost_of_further(wanted, of_viewing_ray, in);
  return trial;
}

}  // namespace troffer
