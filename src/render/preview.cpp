#include "render/preview.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "base/random.h"
#include "base/streams.h"
#include "render/camera.h"
#include "render/first_sight.h"
#include "render/gap_filler.h"
#include "render/tile.h"
#include "transport/purposes.h"

namespace troffer {

namespace {

constexpr uint32_t paths_of_block = 4;
constexpr double interval_per_showing = 10;

// The window in square blocks of pixels; those at its right and lower border may be smaller.
struct Blocks {
  PixelRect window;
  int side = 1;
  int across() const { return (window.width() + side - 1) / side; }
  int down() const { return (window.height() + side - 1) / side; }
};

// Adds rays spread over a block.
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

// Results per block: mean light and albedo of its paths, and the sum of the normals.
struct Values {
  Image light, albedo;
  std::vector<Vec3> normals;  // zero if nothing was hit
};

// Returns false if it was stopped.
bool sample(const Integrator& integrator, const ViewingCamera& camera, const Blocks& blocks,
            const RenderOptions& options, const StopFlag& stop, Values& values) {
  struct Work {
    std::unique_ptr<IntegratorScratch> scratch;
    ViewingRays rays;
    RadianceBatch radiance;
    Counters counters;
  };
  const uint64_t seed = hash_of(options.seed, stream::preview, uint64_t(blocks.side));
  std::vector<Work> work(size_t(thread_count(options.threads)));
  values = {Image(blocks.across(), blocks.down()), Image(blocks.across(), blocks.down()), {}};
  values.normals.assign(values.light.pixels.size(), Vec3{});
  // The unit between checks for a stop, small for a quick response when the user turns the view.
  constexpr int blocks_at_once = 32;
  const auto across = size_t((blocks.across() + blocks_at_once - 1) / blocks_at_once);
  parallel_for_slots(across * size_t(blocks.down()), options.threads, [&](size_t n, size_t slot) {
    if (stop.load(std::memory_order_relaxed)) return;
    const size_t row = n / across;
    const int first = int(n % across) * blocks_at_once;
    const int end = std::min(first + blocks_at_once, blocks.across());
    Work& w = work[slot];
    if (!w.scratch) w.scratch = integrator.make_scratch();
    w.rays.clear();
    w.rays.cone = camera.cone(1);
    for (int i = first; i < end; ++i) add_block_rays(camera, blocks, i, int(row), seed, w.rays);
    w.radiance.reset(w.rays.size());
    integrator.radiance(w.rays, *w.scratch, w.radiance, w.counters);
    for (size_t i = 0; i < w.rays.size(); ++i) {
      const Rgb l = w.radiance.direct[i] + w.radiance.indirect[i];
      if (!is_finite(l)) continue;
      const size_t at = row * size_t(blocks.across()) + size_t(first) + i / paths_of_block;
      values.light.pixels[at] += l * (1.0f / float(paths_of_block));
      values.albedo.pixels[at] += w.radiance.albedo[i] * (1.0f / float(paths_of_block));
      values.normals[at] += w.radiance.normal[i];
    }
  });
  return !stop.load(std::memory_order_relaxed);
}

// Smooths the incident light (light / albedo) over neighbours with similar normals. Blocks that
// emit, or whose noise is far above the mean, do not mix with others.
Image smoothed(const Values& v) {
  constexpr float dark = 0.02f;
  constexpr double shining = 16;
  constexpr int reach = 2;
  const int width = v.light.width, height = v.light.height;
  Image arriving(width, height), out(width, height);
  double sum = 0;
  for (size_t i = 0; i < arriving.pixels.size(); ++i) {
    arriving.pixels[i] = v.light.pixels[i] / (v.albedo.pixels[i] + Rgb{dark});
    sum += double(luminance(arriving.pixels[i]));
  }
  const auto limit = float(shining * sum / double(arriving.pixels.size()));
  const auto weight = [&](size_t i, size_t j) {
    if ((luminance(arriving.pixels[i]) > limit) != (luminance(arriving.pixels[j]) > limit))
      return 0.0f;
    const float both = length(v.normals[i]) * length(v.normals[j]);
    if (!(both > 0)) return i == j ? 1.0f : 0.0f;
    return std::pow(std::max(0.0f, dot(v.normals[i], v.normals[j]) / both), 16.0f);
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const size_t i = size_t(y) * size_t(width) + size_t(x);
      Rgb mean;
      float weights = 0;
      for (int b = std::max(0, y - reach); b <= std::min(height - 1, y + reach); ++b)
        for (int a = std::max(0, x - reach); a <= std::min(width - 1, x + reach); ++a) {
          const size_t j = size_t(b) * size_t(width) + size_t(a);
          const float w = weight(i, j);
          mean += arriving.pixels[j] * w;
          weights += w;
        }
      out.pixels[i] =
          weights > 0 ? mean / weights * (v.albedo.pixels[i] + Rgb{dark}) : v.light.pixels[i];
    }
  return out;
}

// Interpolates linearly between the centres of blocks.
Image spread(const Image& values, const Blocks& blocks) {
  Image image(blocks.window.width(), blocks.window.height());
  struct Between {
    int low, high;
    float share;  // weight of `high`
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

}  // namespace

void Preview::sight(const Scene& scene, const Camera& camera, const RenderOptions& options,
                    bool waits_for_images) {
  constexpr size_t few_triangles = 200'000;
  if (triangle_count(scene) <= few_triangles && !waits_for_images) return;
  const ImageSize size = image_size(camera, options.width, options.height);
  const PixelRect window = wanted_window(options, size.width, size.height);
  constexpr double most_pixels = 1 << 26;  // larger pictures are refused later (check_options)
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
      Clock::now() + std::chrono::duration_cast<Clock::duration>(
                         std::chrono::duration<double>(pace_.look_seconds));
  Values values;
  for (int side = (longest + pace_.first_blocks - 1) / pace_.first_blocks; side > 0; side /= 2) {
    const Clock::time_point start = Clock::now();
    const Blocks blocks{window_, side};
    if (!sample(*paths, viewing, blocks, options, stop, values)) break;
    const bool is_first = image_.pixels.empty();
    image_ = spread(smoothed(values), blocks);
    // The next step has four times as many blocks.
    const Clock::time_point done = Clock::now();
    const bool is_last = side == 1 || done + 4 * (done - start) > end;
    if (is_first || is_last) show(image_);
    if (is_last) break;
  }
}

void Preview::go_on_from(const Image& coarse, const PixelRect& window) {
  window_ = window;
  image_ = coarse;
  next_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                             std::chrono::duration<double>(pace_.interval));
}

void Preview::show(const Image& image) {
  const Clock::time_point start = Clock::now();
  show_(image);
  const std::chrono::duration<double> took = Clock::now() - start;
  const std::chrono::duration<double> pause =
      std::max(std::chrono::duration<double>(pace_.interval), interval_per_showing * took);
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
