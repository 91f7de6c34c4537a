// The methods under test. Each answers all pairs on one thread. If no sampled point can send light,
// the visible share is one half.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "certified/certified_direct.h"
#include "kj92/bintree.h"
#include "pairs.h"

namespace troffer::bench {

// A method's answers, as plain arrays over pairs, and their cost.
struct Answers {
  // Visible share; 0 if no light can arrive. Estimates may be negative and count so in means.
  std::vector<float> visible;
  std::vector<float> variance;  // estimated variance of `visible`; 0 if the method gives none
  // only set by certified
  std::vector<float> unoccluded;  // sr
  std::vector<ShadowAnswer> kinds;
  CertifiedCounters counters;

  uint64_t rays = 0;
  double seconds = 0;  // processor time of this thread, s, which other programs do not affect

  void reset(size_t pairs);
};

// Returns the processor time of this thread, s.
double thread_seconds();

// Casts n Owen-Sobol rays to every source; the visible share is the ratio of the open weights to
// all weights. single: one ray at a time; packets: 16 at a time, which for n >= 32 go to a compact
// part of the source.
enum class Traversal { single, packets };
void run_fixed(const Pairs& pairs, uint32_t n, Traversal traversal, uint64_t seed, Answers& out);

// Runs the bintree of 1992 over every source. The rays of a hit's trees are traced together, round
// by round, and the sources share the allowed error as in rendering (kj92/tree_sampling.h). With
// coherence a tree's pattern is reused at the tile's next hit on the same object.
void run_kj92(const Pairs& pairs, const BintreeOptions& options, bool has_coherence, uint64_t seed,
              Answers& out);

// Runs certified visibility in the same way as certified/certified_lights.cpp.
void run_certified(const Pairs& pairs, const CertifiedOptions& options, uint64_t seed,
                   Answers& out);

}  // namespace troffer::bench
