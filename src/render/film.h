// Sums of samples per pixel, from which every layer is made.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/own_file.h"
#include "base/vec.h"
#include "image/image.h"
#include "render/render.h"

namespace troffer {

// A rectangle of pixels, x1 and y1 exclusive.
struct PixelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
};

// What is known of a pixel.
struct PixelEstimate {
  uint32_t samples = 0;
  double luminance = 0, standard_error = 0;  // of the pixel
  // Of samples by themselves, without what is known of them (Film::add_known): the mean, and its
  // standard error.
  double rest = 0, error_of_rest = 0;
  // How much of the variance of one sample is chance of its own, whatever its place in the pixel.
  double independent_variance = 0;
};

// What glances at a pixel (Integrator::glance) have seen, or what is known of its samples.
struct KnownSums {
  Rgb direct, indirect;
  float luminance = 0, squares = 0;  // of luminance
  uint32_t count = 0;

  void add(const KnownRadiance& k) {
    const float y = troffer::luminance(k.direct + k.indirect);
    direct += k.direct;
    indirect += k.indirect;
    luminance += y;
    squares += y * y;
    ++count;
  }
};

// A pixel with glances is the mean of what is known at these and at its samples, plus the mean of
// how far its samples differ from what is known of them: a control variate. The same in the mean,
// for glances lie in the pixel as samples do; what is known of many rays takes the noise from where
// edges are.
class Film {
 public:
  // Bytes that a film of this many pixels takes.
  static double bytes(double pixels, const std::vector<Aov>& aovs, bool has_surrogates);

  // `window`: the pixels kept, in coordinates of the whole image. `origin`: the scene's, added to
  // positions that are shown.
  Film(const PixelRect& window, const std::vector<Aov>& aovs, const Vec3d& origin = {});

  // Adds sample i of a batch to pixel (x, y). Different pixels may be added to concurrently; one
  // pixel's samples must come in a fixed order for the sums to be reproducible. Samples that are
  // not finite count as black; returns whether it was finite.
  bool add(int x, int y, const RadianceBatch& batch, size_t i, float depth);

  // Of samples whose method does not tell what they err by (PixelSampling): for estimated_error().
  void set_evenness(double evenness) { evenness_ = evenness; }
  // From now on, what batches know of samples is kept. Before the first sample.
  void expect_surrogates() { known_.resize(pixels_.size()); }
  // Layers of first hits are those of glances where there are any, as light is.
  void add_surrogate(int x, int y, const RadianceBatch& batch, size_t i, float depth);
  // So many samples will the pixel have, of which it has no more than the first four yet: how far
  // they differ is told by larger blocks of them, which are spread more evenly.
  void expect_samples(int x, int y, uint32_t count);
  // Of samples.
  const KnownSums& known(int x, int y) const { return known_[index(x, y)].samples; }

  // (x, y) as in add().
  PixelEstimate estimate(int x, int y) const;
  // Of the picture, by the samples so far; nothing without any.
  std::optional<Rgb> radiance(int x, int y) const;

  // Standard error of the pixel's luminance: that of the layer `error`.
  double estimated_error(int x, int y) const { return estimated_error(index(x, y)); }

  // The picture, then the AOVs in the order given.
  std::vector<Layer> layers() const;

  // All that is kept of a pixel, as bytes, and how many.
  void save(int x, int y, std::vector<uint8_t>& out) const;
  size_t bytes_of_pixel() const;
  // The pixel as save() has left it; `in` has bytes_of_pixel() left. False where it says what no
  // pixel can be.
  bool load(int x, int y, ByteReader& in);
  // … of glances.
  uint32_t surrogates(int x, int y) const {
    return known_.empty() ? 0 : known_[index(x, y)].surrogates.count;
  }

 private:
  static constexpr uint32_t first_block_size = 4, surrogates_of_block = 16;
  struct Pixel {
    Vec3d direct, indirect;
    double sum_luminance = 0, sum_luminance_squared = 0;
    double source_variance = 0;  // of the samples' direct light, as far as the method tells it
    double shared_error = 0;     // … of their indirect light, likewise
    double drawn_error = 0;      // … a draw of it
    double untold = 0, without_error_squared = 0;  // luminance of light of which it does not tell
    uint32_t samples = 0;
    bool has_source_variance = false, has_whole_error = false;
  };
  struct Light {
    Vec3d direct, indirect;
  };
  struct FirstHit {  // sums over samples that hit something
    Vec3d albedo, normal, position, sources;
    double depth = 0, shadow_rays = 0;
    uint32_t hits = 0;
    void add(const RadianceBatch& batch, size_t i, float at_depth);
    void forget_hits();
  };
  // Of one pixel.
  struct Known {
    KnownSums samples, surrogates;
    Rgb evened;                           // RadianceBatch::evened, of samples
    float rest = 0, squares_of_rest = 0;  // luminance of samples, less what is known
    // … summed over blocks of so many samples; the sums of whole blocks, and their squares
    uint32_t block_size = first_block_size;
    float block = 0, blocks = 0, squares_of_blocks = 0;
    // Luminance that glances have seen, over blocks of surrogates_of_block: the one that is not
    // whole yet, and the squares of those that are.
    float surrogate_block = 0, squares_of_surrogate_blocks = 0;
    void add_rest(float value, uint32_t so_far);
    void add_surrogate(const KnownRadiance& seen);
  };
  size_t index(int x, int y) const {
    return size_t(y - window_.y0) * size_t(window_.width()) + size_t(x - window_.x0);
  }
  PixelEstimate estimate_of(size_t i) const;
  Light light_of(size_t i) const;
  static double standard_error(const Pixel& p);
  double estimated_error(size_t i) const;
  static double independent_variance(const Pixel& p);
  double variance_beyond(size_t i, double independent) const;
  double variance_of_surrogates(size_t i) const;
  Layer make_layer(Aov aov) const;

  PixelRect window_;
  std::vector<Aov> aovs_;
  Vec3d origin_;
  double evenness_ = 0;
  std::vector<Pixel> pixels_;
  std::vector<FirstHit> first_hits_;  // empty if no AOV needs it
  std::vector<Known> known_;          // empty where nothing is known before light is sampled
};

}  // namespace troffer
