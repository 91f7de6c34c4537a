// Adaptive refinement of the image: which pixels deserve further viewing rays.
//
// After a first pass with the same number of rays in every pixel, a pixel is refined where its
// colour, the object seen, or the pattern in which it sees a source differ from a neighbour's; and
// on, until the standard error of its mean is small.
// References: [1] Painter & Sloan, "Antialiased Ray Tracing by Adaptive Progressive Refinement",
//   SIGGRAPH 1989. [2] Kok & Jansen, Eurographics '92, §5.
#pragma once

#include <vector>

#include "integrate/shadow_record.h"
#include "render/film.h"

namespace troffer {

struct RefinementOptions {
  // Differences of luminance over the sum of both, or over the image's mean where that is more.
  float contrast = 0.05f;
  // Light about which two patterns disagree, over the pixel's luminance.
  float pattern_contrast = 0.05f;
  // Standard error of the mean at which a refined pixel is left alone, over the larger of its
  // luminance and the image's mean.
  float error = 0.01f;
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
  // The pixel's own record and those of its four neighbours within the window.
  NeighbourRecords around(int x, int y) const;
};

// Whether the first pass calls for more rays in a pixel. mean: luminance of the image.
bool needs_refinement(const Film& film, const PixelRecords& records, int x, int y, double mean,
                      const RefinementOptions& options);
// Whether a pixel that is being refined needs still more.
bool needs_more(const PixelEstimate& pixel, double mean, const RefinementOptions& options);

}  // namespace troffer
