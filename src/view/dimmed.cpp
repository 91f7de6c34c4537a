#include "view/dimmed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/error.h"

namespace troffer {

DimmerSettings parse_dimmers(const std::string& text, size_t count) {
  DimmerSettings settings(count, Rgb{1});
  if (text.empty()) return settings;
  constexpr float most = 1000;
  const char* p = text.c_str();
  for (size_t i = 0; i < count; ++i)
    for (size_t c = 0; c < 3; ++c) {
      char* end = nullptr;
      const float v = std::strtof(p, &end);
      const bool is_last = i + 1 == count && c == 2;
      const char after = c < 2 ? ',' : is_last ? '\0' : ';';
      if (end == p || *end != after || !(v >= 0 && v <= most))
        throw UsageError("dimmers: each needs three factors");
      settings[i][c] = v;
      p = end + (is_last ? 0 : 1);
    }
  return settings;
}

bool are_all_one(const DimmerSettings& settings) {
  return std::all_of(settings.begin(), settings.end(),
                     [](const Rgb& s) { return s.r == 1 && s.g == 1 && s.b == 1; });
}

Image dimmed_picture(const LayerBoard& board, const DimmerSettings& settings) {
  const auto whole = board.get("whole");
  if (!whole) throw UsageError("there is no picture yet");
  if (are_all_one(settings)) return whole->image;
  // A single luminaire has no layer of its own.
  if (settings.size() == 1) {
    Image image = whole->image;
    for (Rgb& p : image.pixels) p = p * settings[0];
    return image;
  }
  Image sum;
  uint64_t view = 0;
  for (size_t i = 0; i < settings.size(); ++i) {
    const auto layer = board.get("dimmer" + std::to_string(i));
    if (!layer || (i > 0 && layer->view != view))
      throw UsageError("the pictures of single luminaires are not ready yet");
    const Image& from = layer->image;
    if (i == 0) {
      sum = Image(from.width, from.height);
      view = layer->view;
    }
    if (from.width != sum.width || from.height != sum.height)
      throw UsageError("the pictures of single luminaires are not all ready yet");
    for (size_t k = 0; k < sum.pixels.size(); ++k) sum.pixels[k] += from.pixels[k] * settings[i];
  }
  return sum;
}

std::vector<Measurement> dimmed_measurements(const MeasuringAnswer& answer,
                                             const DimmerSettings& settings) {
  std::vector<Measurement> sums(answer.values.empty() ? 0 : answer.values[0].size());
  const bool is_whole = answer.values.size() != settings.size();
  for (size_t p = 0; p < sums.size(); ++p) {
    double variance = 0;
    for (size_t i = 0; i < answer.values.size(); ++i) {
      const Measurement& m = answer.values[i][p];
      const Rgb dimmed = is_whole ? m.irradiance : m.irradiance * settings[i];
      const float before = luminance(m.irradiance);
      const double factor = before > 0 ? double(luminance(dimmed) / before) : 0;
      sums[p].irradiance += dimmed;
      sums[p].illuminance_lx += factor * m.illuminance_lx;
      variance += sqr(factor * m.standard_error);
    }
    sums[p].standard_error = std::sqrt(variance);
  }
  return sums;
}

}  // namespace troffer
