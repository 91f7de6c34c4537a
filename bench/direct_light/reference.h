// The visible share of every pair by very many rays, exact at the source's rim, kept in files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pairs.h"

namespace troffer::bench {

struct ReferenceOptions {
  uint32_t rays = 16384;    // Owen-Sobol, of each replicate: a power of two
  uint32_t replicates = 2;  // independently scrambled, at least 2; their spread tells the error
  std::string folder;       // where they are kept; empty: nowhere
};

struct Reference {
  double rms_error = 0;   // of a pair's visible share, estimated
  double mean_error = 0;  // standard error of the mean over all counted pairs
  bool was_kept = false;  // read from a file
};

// Sets pairs.reference. A ray is hidden if anything lies on it before the source's plane, however
// close to it: what is too close for a ray in single precision is looked at in double precision,
// triangle by triangle. Only triangles that do not rise above the source's plane by more than
// 2e-6 of the largest coordinate are taken to lie in it: the source itself, the ceiling about it.
// On all cores. Throws EnvironmentError if the file cannot be written.
Reference make_reference(Pairs& pairs, const ReferenceOptions& options);

}  // namespace troffer::bench
