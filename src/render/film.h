// Film: sums of samples per pixel, from which all layers of a picture are made. Rendering adds
// viewing rays and surrogate samples; refinement reads the estimated errors. Radiance is linear RGB
// in the scene's units; errors are standard errors of luminance. film_state.cpp saves and loads it.
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

// A rectangle of pixels; x1 and y1 are exclusive.
struct PixelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
};

// Current estimate for a pixel.
struct PixelEstimate {
  uint32_t samples = 0;
  double luminance = 0, standard_error = 0;  // mean and standard error of the pixel
  // Mean difference between samples and their known radiance, and its standard error. Equal to the
  // values above if no known radiance is kept (Film::expect_surrogates).
  double rest = 0, error_of_rest = 0;
  // Part of the variance of one sample that does not depend on its position in the pixel.
  double independent_variance = 0;
};

// Sums of known radiance: at surrogate samples (Integrator::surrogate_radiance) or at samples.
struct KnownSums {
  Rgb direct, indirect;
  float luminance = 0, squares = 0;  // squares of luminance
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

// Sums of all pixels of a window. Surrogate samples are a control variate: a pixel is the mean
// known radiance over surrogates and samples, plus the mean difference between samples and their
// known radiance. Both kinds are distributed alike in the pixel, so this is unbiased. It removes
// most noise at edges, since surrogates are many.
class Film {
 public:
  // Returns the memory of a film with this many pixels, in bytes.
  static double bytes(double pixels, const std::vector<Aov>& aovs, bool has_surrogates);

  // `window`: the pixels kept, in coordinates of the whole image. `origin`: origin of the scene,
  // added to the positions in layers.
  Film(const PixelRect& window, const std::vector<Aov>& aovs, const Vec3d& origin = {});

  // Adds sample i of a batch to pixel (x, y). Threads may add to different pixels concurrently. The
  // samples of one pixel must come in a fixed order, so that sums are reproducible. Samples that
  // are not finite count as black; returns false for them.
  bool add(int x, int y, const RadianceBatch& batch, size_t i, float depth);

  // Sets the convergence of stratified samples (PixelSampling), for estimated_error() of methods
  // without error estimates.
  void set_evenness(double evenness) { evenness_ = evenness; }
  // Keeps known radiance of samples. Call before the first sample.
  void expect_surrogates() { known_.resize(pixels_.size()); }
  // Adds surrogate sample i of a batch. If a pixel has surrogates, its layers of first hits come
  // from them alone.
  void add_surrogate(int x, int y, const RadianceBatch& batch, size_t i, float depth);
  // Announces the pixel's final sample count. The error estimate then compares blocks of samples:
  // blocks are better stratified than single samples. Call before the fifth sample.
  void expect_samples(int x, int y, uint32_t count);
  // Returns the sums of known radiance at samples.
  const KnownSums& known(int x, int y) const { return known_[index(x, y)].samples; }

  // Returns the estimate for a pixel; (x, y) as in add().
  PixelEstimate estimate(int x, int y) const;
  // Returns the pixel's radiance by the samples so far, or nothing without samples.
  std::optional<Rgb> radiance(int x, int y) const;

  // Returns the standard error of the pixel's luminance, as in layer `error`.
  double estimated_error(int x, int y) const { return estimated_error(index(x, y)); }

  // Returns the picture, then the AOVs in the order given.
  std::vector<Layer> layers() const;

  // Appends all data of a pixel; returns their size in bytes.
  void save(int x, int y, std::vector<uint8_t>& out) const;
  size_t bytes_of_pixel() const;
  // Restores a pixel from the bytes of save(); `in` must have bytes_of_pixel() left. Returns false
  // if the values are impossible.
  bool load(int x, int y, ByteReader& in);
  // Returns the number of surrogate samples.
  uint32_t surrogates(int x, int y) const {
    return known_.empty() ? 0 : known_[index(x, y)].surrogates.count;
  }

 private:
  static constexpr uint32_t first_block_size = 4, surrogates_of_block = 16;
  struct Pixel {
    Vec3d direct, indirect;
    double sum_luminance = 0, sum_luminance_squared = 0;
    // variance of the samples' direct light, as estimated by the method
    double source_variance = 0;
    double shared_error = 0;  // RadianceBatch::shared_error, summed
    double drawn_error = 0;   // RadianceBatch::drawn_error, summed
    // luminance without an error estimate by the method
    double untold = 0, without_error_squared = 0;
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
  // Known radiance of one pixel.
  struct Known {
    KnownSums samples, surrogates;
    Rgb edge_correction;                  // RadianceBatch::evened, over samples
    float rest = 0, squares_of_rest = 0;  // luminance of samples minus known radiance
    // The same by blocks of block_size samples: the unfinished block, the sum of whole blocks, and
    // the sum of their squares.
    uint32_t block_size = first_block_size;
    float block = 0, blocks = 0, squares_of_blocks = 0;
    // Luminance of surrogates by blocks of surrogates_of_block: the unfinished block, and the sum
    // of squares of whole ones.
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
  std::vector<Known> known_;          // empty unless expect_surrogates() was called
};

// Returns the estimated error of a picture as a display shows it: root mean square of its pixels'
// errors over its mean luminance, where all luminances from four times the usual one on are white
// (allowed_error.h). Otherwise a lamp in view would make all errors seem small. The error of a
// pixel brighter than white counts relative to its own luminance, as if it were just white.
double picture_error(const Film& film, const PixelRect& window);
// The same for pixels with these luminances and errors. There is at least one.
double picture_error(const std::vector<double>& luminances, const std::vector<double>& errors);

}  // namespace troffer
