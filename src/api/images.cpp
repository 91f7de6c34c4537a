// Images of the public interface: read, write, compare.
#include "api/values.h"
#include "base/error.h"
#include "compare/compare.h"
#include "image/read_image.h"
#include "image/write_image.h"
#include "troffer/image.h"

namespace troffer::api {

Image read_image(const std::string& path) {
  const troffer::Image read = troffer::read_image(path);
  static_assert(sizeof(Rgb) == 3 * sizeof(float));
  const float* const first = read.pixels.empty() ? nullptr : &read.pixels.data()->r;
  return {read.width, read.height, std::vector<float>(first, first + 3 * read.pixels.size())};
}

void write_image(const std::string& path, const Image& image, const DisplayOptions& display) {
  const troffer::Image pixels = image_of(image);
  WriteOptions options;
  options.display = display_of(display, pixels);
  troffer::write_image(path, pixels, options);
}

ImageDifference compare_images(const Image& image, const Image& reference) {
  const Comparison c =
      troffer::compare_images(image_of(image), image_of(reference), std::string("image"));
  return {c.mean_image,    c.mean_reference, c.average_difference, c.rmse,
          c.relative_rmse, c.flip,           c.compared_pixels,    c.non_finite_pixels};
}

}  // namespace troffer::api
