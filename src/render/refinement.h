// Adaptive refinement of the image: which pixels deserve further viewing rays, and how many.
//
// The first pass gives every pixel the same number of rays. How many more a pixel gets is decided
// once, by what its own samples have no part in: its neighbours' samples of the first pass, and an
// EdgeMap. (A pixel that is refined because its own rays differ has met something bright more often
// than not; those whose rays have missed it stay as they are, and the picture comes out too dark.)
// So the mean of every pixel stays that of its samples: unbiased where they are.
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
  // Difference of luminance between the two neighbours at opposite sides, over the sum of both, or
  // over the image's mean where that is more.
  float contrast = 0.05f;
  // Light about which two patterns disagree, over the pixel's luminance.
  float pattern_contrast = 0.05f;
  // Standard error of the mean that is to be reached, over the larger of the luminance around and
  // the image's mean.
  float error = 0.01f;
  // Pixels get further rays where no edge is to be seen, too, if their neighbours vary.
  bool is_everywhere = false;
  // What neighbours vary by is noise, much the same in all of them: its mean counts.
  bool is_noise = false;
  double evenness = 0;  // of it: PixelSampling
  // More rays than this squared are in proportion to the pixel's standard deviation, not to its
  // variance: so many rays leave the picture the least error. 0: all by the variance.
  float most_even = 0;
  uint32_t most_effort_divisor = 1;  // SampleRequest::most_effort_divisor
  // Pixels that are glanced at get so many rays at least: where a glance knows what shines, but not
  // what is lit, thin things that are lit would be left to the first few.
  int least_with_surrogates = 0;
};

// One record for each pixel of the window, row by row: that of its last viewing ray.
struct PixelRecords {
  PixelRect window;
  std::vector<ShadowRecord> records;
  std::vector<uint8_t> has_edge;  // the pixel's own viewing rays met different surfaces

  explicit PixelRecords(const PixelRect& w)
      : window(w), records(size_t(w.width()) * size_t(w.height())), has_edge(records.size(), 0) {}
  size_t index(int x, int y) const {
    return size_t(y - window.y0) * size_t(window.width()) + size_t(x - window.x0);
  }
  // Notes the next viewing ray of a pixel; is_first: the first one of it.
  void note(int x, int y, ShadowRecord&& record, bool is_first);
  // All that is kept of a pixel, as bytes.
  void save(int x, int y, std::vector<uint8_t>& out) const;
  // … as save() has left it; false where there is too little, or what no pixel can be.
  bool load(int x, int y, ByteReader& in);
  // The pixel's own record and those of its four neighbours within the window.
  NeighbourRecords around(int x, int y) const;
};

// What samples have said of the pixels of some rows, worked out once: decisions look at each pixel
// some fifty times.
class PixelLooks {
 public:
  struct Look {
    PixelEstimate estimate;
    KnownSums known;  // Film::known(); nothing where the film keeps none
  };
  // How far from a pixel decisions look.
  static constexpr int reach = 3;

  // Of pixels of the film's window `window`, rows from y0 to before y1 and those in reach of them.
  PixelLooks(const Film& film, bool has_known, const PixelRect& window, int y0, int y1);
  const Look& at(int x, int y) const {
    return looks_[size_t(y - rect_.y0) * size_t(rect_.width()) + size_t(x - rect_.x0)];
  }

 private:
  PixelRect rect_;
  std::vector<Look> looks_;
};

// What the decision about a pixel looks at.
struct RefinementView {
  const PixelLooks& looks;  // of the pixel's row
  const PixelRecords& records;
  const EdgeMap& edges;
  double typical = 0;  // luminance of the image
};

// How many rays a pixel should get that only look at what is known (Integrator::glance): none, or
// a power of two, at most most_surrogates.
constexpr int most_surrogates = 16'384;
int surrogates_wanted(const RefinementView& view, int x, int y, const RefinementOptions& options);

struct WantedSamples {
  int count = 0;
  uint32_t effort_divisor = 1;  // SampleRequest::most_effort_divisor, of those after the first
};

// How many viewing rays a pixel should have, between `first` (what it has) and `most`;
// has_surrogates: it will have some.
WantedSamples samples_wanted(const RefinementView& view, int x, int y, bool has_surrogates,
                             int first, int most, const RefinementOptions& options);

}  // namespace troffer
