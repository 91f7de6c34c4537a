// Request of a caller for the samples of one batch, in addition to their rays. Methods without an
// error budget (path, fixed, kj92) ignore it.
#pragma once

#include <cstdint>

namespace troffer {

struct SampleRequest {
  // True for pixels of a picture: neighbours share an error budget, and errors are judged against
  // `typical_luminance`. False for measuring points and for preparation.
  bool is_picture = false;
  // Mean luminance of the picture; light far below it may have a larger relative error. 0: unknown.
  float typical_luminance = 0;
  // Factor on the error budget of one ray; above 1 where a pixel averages many.
  float error_scale = 1;
  // Divisor of the number of light samples and gather rays of each viewing ray: a power of two up
  // to most_effort_divisor. Above 1 where the rays of a pixel meet different things, so that more
  // viewing rays are the better use of time.
  static constexpr uint32_t most_effort_divisor = 16;
  uint32_t effort_divisor = 1;
  // True if only the mean over many rays counts: each may err by a third of its light.
  bool is_coarse = false;
};

}  // namespace troffer
