// Splits a picture into passes, each finer than the one before and with independent noise, and
// averages them. Painter uses it.
#pragma once

#include <cstdint>
#include <vector>

#include "image/image.h"
#include "methods/methods.h"

namespace troffer {

// Settings of one pass.
struct Pass {
  int shrink = 1;       // divisor of the picture's width and height
  double error = 0.05;  // asked error, for methods that take one
  int spp = 4;
  double weight = 1;  // weight in the mean
};

// Returns the passes for a method. Methods that take an error start at half size, continue at full
// size, and halve the error until it meets the asked one. Other methods double their samples, 512
// in all.
std::vector<Pass> passes_to(const Method& method, double error);

// Mean of passes of one size, and its error. It starts again if the size changes.
class PassMean {
 public:
  // error: standard error of each pixel's luminance, in r; empty: unknown.
  void add(const Image& picture, const Image& error, double weight);
  Image mean() const;
  // Standard error of the mean's luminance, in r; passes count as independent.
  Image error() const;
  // Returns the root mean square of error(), over the mean luminance.
  double relative_error() const;

 private:
  Image sum_, variance_;
  double weight_ = 0;
};

}  // namespace troffer
