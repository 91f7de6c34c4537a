// The methods under test, each for all pairs on one thread. Where no point that was drawn can send
// light they say one half.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "certified/certified_direct.h"
#include "kj92/bintree.h"
#include "pairs.h"

namespace troffer::bench {

// What a method says of every pair, plain arrays over pairs, and what it took.
struct Answers {
  // Share; 0 where no light can arrive. Estimates may be under 0, and must stay so in means.
  std::vector<float> visible;
  std::vector<float> variance;  // of `visible`, as the method believes; 0 where it does not say
  // certified alone; empty for others
  std::vector<float> unoccluded;  // sr
  std::vector<ShadowAnswer> kinds;
  CertifiedCounters counters;

  uint64_t rays = 0;
  double seconds = 0;  // processor time of this thread: a busy machine does not spoil it

  void reset(size_t pairs);
};

// Processor time of this thread, seconds.
double thread_seconds();

// n Owen-Sobol rays to every source, ratio of the open to all weights. single: one ray after the
// other; packets: 16 at a time, for n >= 32 such that a packet goes to a compact part of the
// source.
enum class Traversal { single, packets };
void run_fixed(const Pairs& pairs, uint32_t n, Traversal traversal, uint64_t seed, Answers& out);

// The bintree of 1992 over every source, rays of a hit's trees traced together round by round, the
// allowed error shared by the sources as in rendering (kj92/tree_sampling.h), ratio estimate.
// With coherence a tree's pattern is reused at the tile's next hit on the same object.
void run_kj92(const Pairs& pairs, const BintreeOptions& options, bool has_coherence, uint64_t seed,
              Answers& out);

// Certified visibility as certified/certified_lights.cpp drives it.
void run_certified(const Pairs& pairs, const CertifiedOptions& options, uint64_t seed,
                   Answers& out);

}  // namespace troffer::bench
