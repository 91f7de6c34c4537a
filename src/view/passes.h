// A picture by passes, each finer than the one before and with noise of its own, and their mean.
#pragma once

#include <cstdint>
#include <vector>

#include "image/image.h"
#include "methods/methods.h"

namespace troffer {

struct Pass {
  int shrink = 1;       // of the picture's sides
  double error = 0.05;  // asked, where the method takes one
  int spp = 4;
  double weight = 1;  // in the mean
};

// For a method that takes an error: at half the size, whole, and then by half the error until it is
// what is asked for. For others: by ever more samples, 512 in all.
std::vector<Pass> passes_to(const Method& method, double error);

// The mean of passes of one size, and what it errs by. Starts anew where the size changes.
class PassMean {
 public:
  // error: the standard error of each pixel's luminance, in r; empty: not known.
  void add(const Image& picture, const Image& error, double weight);
  Image mean() const;
  // Likewise, passes taken as independent.
  Image error() const;
  // Root of the mean square of error(), over the mean luminance.
  double relative_error() const;

 private:
  Image sum_, variance_;
  double weight_ = 0;
};

}  // namespace troffer
