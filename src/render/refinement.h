// Adaptive refinement: decides which pixels get further viewing rays or surrogate samples, and how
// many. Rendering calls it once after the first pass, which gives every pixel the same number of
// rays.
//
// The decision about a pixel uses its neighbours' samples and an EdgeMap, but not its own samples.
// A pixel whose own rays differ has more often than not met something bright. If it alone were
// refined, pixels whose rays missed the bright thing would stay as they are, and the picture would
// be too dark [3]. Leaving own samples out keeps the mean of every pixel unbiased.
// References: [1] Painter & Sloan, "Antialiased Ray Tracing by Adaptive Progressive Refinement",
//   SIGGRAPH 1989. [2] Kok & Jansen, Eurographics '92, §5. [3] Kirk & Arvo, "Unbiased Sampling
//   Techniques for Image Synthesis", SIGGRAPH 1991 (the bias of samples that decide about
//   themselves).
#pragma once

#include <vector>

#include "base/own_file.h"
#include "render/edge_map.h"
#include "render/film.h"
#include "transport/shadow_record.h"

namespace troffer {

struct RefinementOptions {
  // Threshold on the difference in luminance between two neighbours on opposite sides. Relative to
  // the sum of both, or to the image's mean if that is more.
  float contrast = 0.05f;
  // Threshold on the light about which two patterns disagree, relative to the pixel's luminance.
  float pattern_contrast = 0.05f;
  // Standard error of the mean to be reached, relative to the luminance around or the image's mean,
  // whichever is larger.
  float error = 0.01f;
  // Pixels without a visible edge get further rays, too, if their neighbours vary.
  bool is_everywhere = false;
  // Neighbours vary by noise, much the same in all of them, so their mean variance counts.
  bool is_noise = false;
  double evenness = 0;    // convergence of that noise (PixelSampling)
  double proportion = 0;  // PixelSampling::proportion
  // Above most_even² rays, the count is proportional to the pixel's standard deviation instead of
  // its variance. This minimizes the picture's error for a given number of rays. 0: never.
  float most_even = 0;
  // Least number of rays of pixels with surrogate samples. If known radiance has emission but no
  // reflected light, surrogates do not show sub-pixel features that are only lit.
  int least_with_surrogates = 0;
};

// Shadow records of a window, one per pixel, row by row: that of the pixel's last viewing ray.
struct PixelRecords {
  PixelRect window;
  std::vector<ShadowRecord> records;
  std::vector<uint8_t> has_edge;  // the pixel's own viewing rays met different surfaces

  explicit PixelRecords(const PixelRect& w)
      : window(w), records(size_t(w.width()) * size_t(w.height())), has_edge(records.size(), 0) {}
  size_t index(int x, int y) const {
    return size_t(y - window.y0) * size_t(window.width()) + size_t(x - window.x0);
  }
  // Stores the record of the next viewing ray of a pixel; is_first: it is the pixel's first.
  void note(int x, int y, ShadowRecord&& record, bool is_first);
  // Appends all data of a pixel.
  void save(int x, int y, std::vector<uint8_t>& out) const;
  // Restores a pixel from the bytes of save(). Returns false if there are too few or the values are
  // impossible.
  bool load(int x, int y, ByteReader& in);
  // Returns the pixel's own record and those of its four neighbours within the window.
  NeighbourRecords around(int x, int y) const;
};

// Estimates of the pixels of some rows, computed once: decisions read each pixel about fifty times.
class PixelLooks {
 public:
  struct Look {
    PixelEstimate estimate;
    KnownSums known;  // Film::known(); empty if the film keeps none
  };
  // Distance in pixels within which decisions read others.
  static constexpr int reach = 3;

  // Computes rows y0 to y1 - 1 of the film's `window`, and those within `reach` of them.
  PixelLooks(const Film& film, bool has_known, const PixelRect& window, int y0, int y1);
  const Look& at(int x, int y) const {
    return looks_[size_t(y - rect_.y0) * size_t(rect_.width()) + size_t(x - rect_.x0)];
  }

 private:
  PixelRect rect_;
  std::vector<Look> looks_;
};

// Input of the decision about a pixel.
struct RefinementView {
  const PixelLooks& looks;  // rows around the pixel
  const PixelRecords& records;
  const EdgeMap& edges;
  double typical = 0;  // typical luminance of the image
};

// Returns the number of surrogate samples that a pixel should get (Integrator::surrogate_radiance):
// none, or a power of two up to most_surrogates.
constexpr int most_surrogates = 16'384;
int surrogates_wanted(const RefinementView& view, int x, int y, const RefinementOptions& options);

// Returns the number of viewing rays that a pixel should have in total, from `first`, which it has,
// to `most`. has_surrogates: it will have surrogate samples.
int samples_wanted(const RefinementView& view, int x, int y, bool has_surrogates, int first,
                   int most, const RefinementOptions& options);

}  // namespace troffer
