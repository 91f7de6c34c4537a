// Number of viewing rays that a pixel needs, from the variances seen around it. Used by refinement.
// Variances are of luminance.
#pragma once

namespace troffer {

// Variance of one sample's luminance, by cause, estimated around the pixel.
struct SampleSpread {
  double chance = 0;   // independent of the position in the pixel
  double placed = 0;   // by position, in a pixel that an edge divides
  double thin = 0;     // by position, for features too small for stratification
  double clutter = 0;  // from features that the neighbours' samples may have missed
};

// Returns the number of samples with which a pixel reaches the error `allowed`, a luminance.
// Stratified samples err by n^-3/4 at an edge. They err by n^-1/2 due to independent variance, or
// by n^-(1 + evenness)/2 if that is stratified, too (PixelSampling). most_even: above the square of
// this, the number is in proportion to the standard deviation instead of the variance, which
// minimizes the picture's error for a given number of rays; 0: never.
double samples_for(const SampleSpread& spread, double allowed, double most_even, double evenness);

}  // namespace troffer
