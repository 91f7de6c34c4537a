// Computes the visible share of every pair with very many rays, exact at the source's rim, and
// keeps it in files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pairs.h"

namespace troffer::bench {

// Settings of the reference.
struct ReferenceOptions {
  uint32_t rays = 16384;    // Owen-Sobol rays of each replicate: a power of two
  uint32_t replicates = 2;  // independently scrambled sets, at least 2; their spread gives the
                            // error
  std::string folder;       // folder of kept references; empty: none
};

// Quality of a reference.
struct Reference {
  double rms_error = 0;   // estimated error of a pair's visible share
  double mean_error = 0;  // standard error of the mean over all counted pairs
  bool was_kept = false;  // read from a file
};

// Sets pairs.reference, on all cores. A ray is hidden if anything lies between the hit and the
// source's plane. Occluders too close to the plane for single-precision rays are tested in double
// precision, triangle by triangle. Triangles that do not rise above the source's plane by more than
// 2e-6 of the largest coordinate count as lying in it: the source itself, the ceiling around it.
// Throws EnvironmentError if the file cannot be written.
Reference make_reference(Pairs& pairs, const ReferenceOptions& options);

}  // namespace troffer::bench
