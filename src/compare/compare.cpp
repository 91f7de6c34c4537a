#include "compare/compare.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "base/error.h"
#include "base/parallel.h"
#include "compare/flip.h"
#include "image/tone_map.h"

namespace troffer {

namespace {

// Sums over one row. Rows are added in order, so that the result does not depend on threads.
struct RowSums {
  double image = 0, reference = 0, squares = 0, flip = 0;
  uint64_t steps = 0;  // differences of 8-bit values
  size_t pixels = 0;

  void add(const RowSums& o) {
    image += o.image;
    reference += o.reference;
    squares += o.squares;
    flip += o.flip;
    steps += o.steps;
    pixels += o.pixels;
  }
};

}  // namespace

Comparison compare_images(const Image& image, const Image& reference, const std::string& image_name,
                          int threads) {
  const auto size = [](const Image& i) {
    return std::to_string(i.width) + "x" + std::to_string(i.height);
  };
  if (image.width != reference.width || image.height != reference.height)
    throw InputError(image_name, 0, 0,
                     "size is " + size(image) + ", the reference's is " + size(reference));
  const std::vector<uint8_t> image8 = srgb8(image, {}, threads);
  const std::vector<uint8_t> reference8 = srgb8(reference, {}, threads);
  const std::vector<float> flip = flip_errors(image, reference, default_pixels_per_degree, threads);

  const auto width = size_t(image.width);
  std::vector<RowSums> rows(static_cast<size_t>(image.height));
  parallel_for(rows.size(), threads, [&](size_t y) {
    for (size_t i = y * width; i < (y + 1) * width; ++i) {
      const Rgb a = image.pixels[i], b = reference.pixels[i];
      if (!is_finite(a) || !is_finite(b)) continue;
      for (size_t c = 0; c < 3; ++c) {
        const double va = double(a[c]), vb = double(b[c]);
        rows[y].image += va;
        rows[y].reference += vb;
        rows[y].squares += (va - vb) * (va - vb);
        rows[y].steps += uint64_t(std::abs(int(image8[3 * i + c]) - int(reference8[3 * i + c])));
      }
      rows[y].flip += double(flip[i]);
      ++rows[y].pixels;
    }
  });
  RowSums sums;
  for (const RowSums& row : rows) sums.add(row);
  if (sums.pixels == 0) throw InputError(image_name, 0, 0, "no finite pixel to compare");

  const double n = 3 * double(sums.pixels);
  Comparison result;
  result.mean_image = sums.image / n;
  result.mean_reference = sums.reference / n;
  result.average_difference = double(sums.steps) / n;
  result.rmse = std::sqrt(sums.squares / n);
  if (result.rmse > 0) result.relative_rmse = result.rmse / std::abs(result.mean_reference);
  result.flip = sums.flip / double(sums.pixels);
  result.compared_pixels = sums.pixels;
  result.non_finite_pixels = image.pixels.size() - sums.pixels;
  return result;
}

}  // namespace troffer
