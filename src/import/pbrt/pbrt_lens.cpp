#include "import/pbrt/pbrt_lens.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "import/file.h"

namespace troffer {

namespace {

constexpr uint64_t max_lens_file_bytes = uint64_t(1) << 20;
constexpr double metres_per_mm = 1e-3;
constexpr size_t numbers_per_surface = 4;

}  // namespace

PbrtLens read_pbrt_lens(const std::string& path, double aperture_mm) {
  const std::string text = read_text_file(path, max_lens_file_bytes);
  PbrtTokenizer tokens(path, text);
  std::vector<double> numbers;
  for (PbrtToken token = tokens.next(); token.kind != PbrtTokenKind::end; token = tokens.next()) {
    if (token.kind != PbrtTokenKind::number || !std::isfinite(token.number))
      fail_at(tokens.place(token), "expected a number in a lens file");
    numbers.push_back(token.number);
  }
  if (numbers.empty() || numbers.size() % numbers_per_surface != 0)
    throw InputError(path, 0, 0, "a lens has four numbers for each surface");
  // Traces a paraxial ray that enters at height 1: its height, and its slope times the index [2].
  double height = 1, slope = 0, index = 1, at_stop = 1, stop_mm = aperture_mm;
  for (size_t i = 0; i < numbers.size(); i += numbers_per_surface) {
    const double radius = numbers[i], thickness = numbers[i + 1];
    const double behind = numbers[i + 2] > 0 ? numbers[i + 2] : 1;
    if (radius == 0) {
      at_stop = height;
      stop_mm = std::min(aperture_mm, numbers[i + 3]);
    } else {
      slope -= height * (behind - index) / radius;
      index = behind;
    }
    if (i + numbers_per_surface < numbers.size()) height += slope / index * thickness;
  }
  PbrtLens lens;
  lens.focal_length = -index / slope * metres_per_mm;
  lens.pupil_radius = std::max(stop_mm, 0.0) / 2 / std::abs(at_stop) * metres_per_mm;
  if (!(lens.focal_length > 0) || !std::isfinite(lens.focal_length) ||
      !std::isfinite(lens.pupil_radius))
    throw InputError(path, 0, 0, "the lens does not focus");
  return lens;
}

}  // namespace troffer
