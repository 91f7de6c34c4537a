#include "render/preview.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "base/random.h"
#include "integrate/purposes.h"
#include "render/camera.h"
#include "render/first_sight.h"
#include "render/tile.h"

namespace troffer {

namespace {

constexpr int first_blocks = 64;  // along the longer side
constexpr uint32_t paths_of_block = 4;
constexpr std::chrono::duration<double> time_to_look{0.8};
// Pictures follow each other at this interval, or more slowly where writing takes long.
constexpr std::chrono::duration<double> interval{2.0};
constexpr double interval_per_writing = 10;

// The window in square blocks of pixels, those at its right and lower border smaller.
struct Blocks {
  PixelRect window;
  int side = 1;
  int across() const { return (window.width() + side - 1) / side; }
  int down() const { return (window.height() + side - 1) / side; }
};

// Rays through a block, spread over it.
void add_block_rays(const ViewingCamera& camera, const Blocks& blocks, int i, int j, uint64_t seed,
                    ViewingRays& rays) {
  const uint64_t stream = hash_of(seed, uint64_t(i), uint64_t(j));
  const int x = blocks.window.x0 + i * blocks.side, y = blocks.window.y0 + j * blocks.side;
  const Vec2 size{float(std::min(blocks.side, blocks.window.x1 - x)),
                  float(std::min(blocks.side, blocks.window.y1 - y))};
  for (uint32_t s = 0; s < paths_of_block; ++s) {
    const SobolGroup random(stream, purpose_camera, s);
    const Vec2 at = random.get2(0);
    const Vec2 raster{float(x) + at.x * size.x, float(y) + at.y * size.y};
    rays.rays.push_back(camera.ray(raster, random.get2(2)));
    rays.streams.push_back(stream);
    rays.samples.push_back(s);
    rays.pixels.push_back({int32_t(raster.x), int32_t(raster.y)});
  }
}

// One value for each block; false where it was stopped.
bool sample(const Integrator& integrator, const ViewingCamera& camera, const Blocks& blocks,
            const RenderOptions& options, const StopFlag& stop, Image& values) {
  struct Work {
    std::unique_ptr<IntegratorScratch> scratch;
    ViewingRays rays;
    RadianceBatch radiance;
    Counters counters;
  };
  const uint64_t seed = hash_of(options.seed, uint64_t{0x6c6f'6f6b}, uint64_t(blocks.side));
  std::vector<Work> work(size_t(thread_count(options.threads)));
  values = Image(blocks.across(), blocks.down());
  parallel_for_slots(size_t(blocks.down()), options.threads, [&](size_t row, size_t slot) {
    if (stop.load(std::memory_order_relaxed)) return;
    Work& w = work[slot];
    if (!w.scratch) w.scratch = integrator.make_scratch();
    w.rays.clear();
    w.rays.cone = camera.cone(1);
    for (int i = 0; i < blocks.across(); ++i)
      add_block_rays(camera, blocks, i, int(row), seed, w.rays);
    w.radiance.reset(w.rays.size());
    integrator.radiance(w.rays, *w.scratch, w.radiance, w.counters);
    for (size_t i = 0; i < w.rays.size(); ++i) {
      const Rgb l = w.radiance.direct[i] + w.radiance.indirect[i];
      if (is_finite(l))
        values.at(int(i / paths_of_block), int(row)) += l * (1.0f / float(paths_of_block));
    }
  });
  return !stop.load(std::memory_order_relaxed);
}

// Linear between the middles of blocks.
Image spread(const Image& values, const Blocks& blocks) {
  Image image(blocks.window.width(), blocks.window.height());
  struct Between {
    int low, high;
    float share;  // of high
  };
  const auto between = [&](int pixel, int count) {
    const float at = (float(pixel) + 0.5f) / float(blocks.side) - 0.5f;
    const int low = int(std::floor(at));
    return Between{std::clamp(low, 0, count - 1), std::clamp(low + 1, 0, count - 1),
                   at - float(low)};
  };
  for (int y = 0; y < image.height; ++y) {
    const Between v = between(y, values.height);
    for (int x = 0; x < image.width; ++x) {
      const Between u = between(x, values.width);
      const auto row = [&](int j) {
        return values.at(u.low, j) * (1 - u.share) + values.at(u.high, j) * u.share;
      };
      image.at(x, y) = row(v.low) * (1 - v.share) + row(v.high) * v.share;
    }
  }
  return image;
}

// Paths, of the light that the picture is to show.
std::unique_ptr<Integrator> paths_for(const PreparedScene& scene, const RenderOptions& options) {
  MethodSettings settings = method_settings(options);
  const bool is_direct = options.method.row().is_direct_only || options.indirect == Indirect::none;
  settings.indirect = Indirect::automatic;
  if (options.method != Method::path) settings.depth = is_direct ? 1 : -1;
  return make_integrator(scene, Method::path, settings, nullptr, nullptr);
}

}  // namespace

void Preview::sight(const Scene& scene, const Camera& camera, const RenderOptions& options) {
  constexpr size_t few_triangles = 200'000;
  if (triangle_count(scene) <= few_triangles) return;
  const ImageSize size = image_size(camera, options.width, options.height);
  const PixelRect window = wanted_window(options, size.width, size.height);
  constexpr double most_pixels = 1 << 26;  // more may be refused soon (check_options)
  if (double(window.width()) * window.height() > most_pixels) return;
  const ViewingCamera viewing(camera, size.width, size.height);
  show(first_sight(scene, viewing, window, options.threads));
}

void Preview::look(const PreparedScene& scene, const Camera& camera, const RenderOptions& options,
                   const StopFlag& stop) {
  const ImageSize size = image_size(camera, options.width, options.height);
  const ViewingCamera viewing(camera, size.width, size.height);
  window_ = wanted_window(options, size.width, size.height);
  const std::unique_ptr<Integrator> paths = paths_for(scene, options);
  const int longest = std::max(window_.width(), window_.height());
  const Clock::time_point end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(time_to_look);
  Image values;
  for (int side = (longest + first_blocks - 1) / first_blocks; side > 0; side /= 2) {
    const Clock::time_point start = Clock::now();
    const Blocks blocks{window_, side};
    if (!sample(*paths, viewing, blocks, options, stop, values)) break;
    const bool is_first = image_.pixels.empty();
    image_ = spread(values, blocks);
    // The next one has four times as many blocks.
    const Clock::time_point done = Clock::now();
    const bool is_last = side == 1 || done + 4 * (done - start) > end;
    if (is_first || is_last) show(image_);
    if (is_last) break;
  }
}

void Preview::show(const Image& image) {
  const Clock::time_point start = Clock::now();
  show_(image);
  const std::chrono::duration<double> took = Clock::now() - start;
  const auto pause = std::max(interval, interval_per_writing * took);
  const std::lock_guard lock(mutex_);
  next_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(pause);
}

void Preview::update(const Film& film, const PixelRect& tile) {
  Image shown;
  {
    const std::lock_guard lock(mutex_);
    if (image_.pixels.empty()) return;
    for (int y = std::max(tile.y0, window_.y0); y < std::min(tile.y1, window_.y1); ++y)
      for (int x = std::max(tile.x0, window_.x0); x < std::min(tile.x1, window_.x1); ++x)
        if (const std::optional<Rgb> l = film.radiance(x, y))
          image_.at(x - window_.x0, y - window_.y0) = *l;
    if (is_showing_ || Clock::now() < next_) return;
    is_showing_ = true;
    shown = image_;
  }
  show(shown);
  const std::lock_guard lock(mutex_);
  is_showing_ = false;
}

}  // namespace troffer
