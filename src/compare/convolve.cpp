#include "compare/convolve.h"

#include <algorithm>

#include "base/parallel.h"

namespace troffer {

PixelPlane convolve_rows(const PixelPlane& in, const Kernel& kernel, int threads) {
  PixelPlane out(in.width, in.height);
  const int radius = int(kernel.size() / 2), width = in.width;
  parallel_for(size_t(in.height), threads, [&](size_t line) {
    const float* row = in.row(int(line));
    std::vector<float> padded(size_t(width + 2 * radius));
    for (int x = -radius; x < width + radius; ++x)
      padded[size_t(x + radius)] = row[std::clamp(x, 0, width - 1)];
    float* sum = out.row(int(line));
    for (size_t i = 0; i < kernel.size(); ++i) {
      const float weight = kernel[i];
      const float* shifted = padded.data() + i;
      for (int x = 0; x < width; ++x) sum[x] += weight * shifted[x];
    }
  });
  return out;
}

PixelPlane convolve_columns(const PixelPlane& in, const Kernel& kernel, int threads) {
  PixelPlane out(in.width, in.height);
  const int radius = int(kernel.size() / 2), width = in.width;
  parallel_for(size_t(in.height), threads, [&](size_t line) {
    float* sum = out.row(int(line));
    for (int i = -radius; i <= radius; ++i) {
      const float weight = kernel[size_t(radius + i)];
      const float* row = in.row(std::clamp(int(line) + i, 0, in.height - 1));
      for (int x = 0; x < width; ++x) sum[x] += weight * row[x];
    }
  });
  return out;
}

}  // namespace troffer
