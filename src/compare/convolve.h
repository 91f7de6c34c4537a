// Convolution of one channel with short kernels along rows and columns. FLIP uses it for its
// separable filters. Results do not depend on the number of threads.
#pragma once

#include <cstddef>
#include <vector>

namespace troffer {

// One float per pixel, row-major.
struct PixelPlane {
  int width = 0, height = 0;
  std::vector<float> values;

  PixelPlane() = default;
  PixelPlane(int w, int h) : width(w), height(h), values(size_t(w) * size_t(h)) {}
  float* row(int y) { return values.data() + size_t(y) * size_t(width); }
  const float* row(int y) const { return values.data() + size_t(y) * size_t(width); }
};

// Kernel with an odd number of taps 2r + 1; the middle one has offset 0.
using Kernel = std::vector<float>;

// out(x,y) = sum_i kernel[r + i] in(x + i, y), and the same along columns; kernels are not
// mirrored. Pixels beyond the border repeat the border pixel.
PixelPlane convolve_rows(const PixelPlane& in, const Kernel& kernel, int threads);
PixelPlane convolve_columns(const PixelPlane& in, const Kernel& kernel, int threads);

}  // namespace troffer
