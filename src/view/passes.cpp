#include "view/passes.h"

#include <algorithm>
#include <cmath>

#include "base/vec.h"

namespace troffer {

std::vector<Pass> passes_to(const Method& method, double error) {
  constexpr int few_samples = 4, most_samples = 256;
  std::vector<Pass> passes;
  if (!needs_cells(method, Indirect::automatic)) {
    for (int spp = few_samples; spp <= most_samples; spp *= 2) {
      if (spp == few_samples) passes.push_back({2, error, spp, double(spp)});
      passes.push_back({1, error, spp, double(spp)});
    }
    return passes;
  }
  // The first pass sets the size of cells, so it must not be much coarser than the last.
  constexpr double coarse = 0.05;
  double at = std::max(coarse, error);
  passes.push_back({2, at, few_samples, 1 / (at * at)});
  for (;; at = std::max(at / 2, error)) {
    passes.push_back({1, at, few_samples, 1 / (at * at)});
    if (at <= error) return passes;
  }
}

void PassMean::add(const Image& picture, const Image& error, double weight) {
  if (sum_.width != picture.width || sum_.height != picture.height) {
    sum_ = variance_ = Image(picture.width, picture.height);
    weight_ = 0;
  }
  weight_ += weight;
  const auto w = float(weight);
  for (size_t i = 0; i < picture.pixels.size(); ++i) {
    sum_.pixels[i] += picture.pixels[i] * w;
    if (!error.pixels.empty()) variance_.pixels[i].r += sqr(w * error.pixels[i].r);
  }
}

Image PassMean::mean() const {
  Image mean = sum_;
  for (Rgb& p : mean.pixels) p = p / float(weight_);
  return mean;
}

Image PassMean::error() const {
  Image error = variance_;
  for (Rgb& p : error.pixels) p.r = std::sqrt(p.r) / float(weight_);
  return error;
}

double PassMean::relative_error() const {
  double squares = 0, light = 0;
  for (size_t i = 0; i < sum_.pixels.size(); ++i) {
    squares += double(variance_.pixels[i].r);
    light += double(luminance(sum_.pixels[i]));
  }
  const auto pixels = double(sum_.pixels.size());
  return light > 0 ? std::sqrt(squares / pixels) / (light / pixels) : 0;
}

}  // namespace troffer
