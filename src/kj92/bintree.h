// Adaptive sampling of one source from one point, and the reuse of its pattern at the next point:
// the bintree of 1992. A pure algorithm: it sees nothing of the source but (u,v) in [0,1)² and
// nothing of the scene but the answers to its rays, so it works for any parametrised source, and a
// tree may belong to any thread.
//
// A tree asks in rounds: pending() are the rays it wants now, supply() takes their answers and says
// what it wants next. So rays of many trees can be traced together; for one tree, sample_source and
// resample_source below do the rounds. The first round is large (the initial rays, or the whole
// pattern of the last point), later ones have a ray or a few.
//
// The estimate is biased: where rays go, and when they stop, depends on what rays found.
// References: [1] Kok & Jansen, "Adaptive Sampling of Area Light Sources in Ray Tracing Including
//   Diffuse Interreflection", Eurographics '92, §3 and §4. [rule n], [reuse]: docs/bintree.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/random.h"
#include "kj92/bintree_nodes.h"
#include "kj92/bintree_rules.h"

namespace troffer {

struct BintreeOptions {
  // Rays cast in any case, spread evenly [rule 1]; rounded up to a power of two, at least 1.
  int initial_rays = 8;
  // Allowed standard error of the mean, relative to the unoccluded contribution [rule 2]: the
  // variance of the root's mean must fall under (allowed_variance × unoccluded)². That variance is
  // estimated as if rays were independent: half in shadow, a source needs a quarter over the
  // square of this, 100 rays at 0.05; at 0.01 mostly the second stop or the cap ends it. 0: refine
  // all cells evenly until most_rays, whatever rays find: full stratified sampling.
  float allowed_variance = 0.01f;
  // Levels that a leaf may be above a leaf beside it [rule 4]; 2 levels halve a cell both ways.
  int level_difference = 1;
  // Stop where the mean stayed within an interval of this width, relative to the unoccluded
  // contribution, over the last mean_change_iterations iterations [rule 5], 1 … 16, once
  // enough_rays are cast. 0: never.
  float mean_change = 0.004f;
  int mean_change_iterations = 8;
  int enough_rays = 32;
  // Cap on the rays of one point; initial rays are halved until they fit.
  int most_rays = 128;
  // [reuse] New positions in the old cells when a pattern is reused, instead of the old positions.
  bool renews_jitter = true;
};

// Answer to one ray. The value of a ray is kernel where visible, 0 where not; the estimate is
// Σ cell area × value. kernel = 1 gives the visible share of the source. Another kernel (radiance
// of a texture, geometry term, both) weighs visibility; it should not be negative, and its mean
// over the square is the `unoccluded` that start() and resample() are told.
struct ShadowRayResult {
  bool is_visible = false;
  float kernel = 1;
};

enum class BintreeStop : uint8_t { none, variance, mean, cap, finest };

struct BintreeEstimate {
  float mean = 0;      // of visibility × kernel over the square
  float variance = 0;  // of the mean, as the tree believes
  uint32_t rays = 0;   // cast at this point
  BintreeStop stop = BintreeStop::none;
};

class Bintree {
 public:
  explicit Bintree(const BintreeOptions& options = {});

  // Begins at a point with nothing known. `stream` seeds the jitter: a hash of pixel, sample and
  // source. `initial_rays` 0: as in the options.
  void start(uint64_t stream, float unoccluded = 1, int initial_rays = 0);
  // [reuse] Begins at the next point with the pattern that is there: all its leaves are pending.
  void resample(uint64_t stream, float unoccluded = 1);

  // For points where what a source would send unoccluded is known from the first round alone:
  // before the first answers, the mean over the square of a kernel given at pending().
  float mean_of_pending(std::span<const ShadowRayResult> results) const;
  // … and what start() or resample() were told is replaced. `leniency` multiplies what the stops
  // allow, for light that is a small part of what is seen.
  void set_unoccluded(float unoccluded, float leniency = 1) { allowed_ = {unoccluded, leniency}; }

  // Where the rays end that are wanted now; empty when done. Valid until the next call.
  std::span<const Vec2> pending() const { return pending_uv_; }
  // results[i] answers pending()[i]. Then decides: stop, or split and ask for more.
  void supply(std::span<const ShadowRayResult> results);

  // [reuse] After the last answer: removes what showed nothing, for the next point. The estimate
  // stays that of the point.
  void shrink();

  const BintreeEstimate& estimate() const { return estimate_; }
  // Σ cell area × kernel, of all leaves, hidden ones too: mean / this is a ratio estimate.
  float kernel_mean() const;
  const BintreeNodes& nodes() const { return nodes_; }
  const BintreeOptions& options() const { return options_; }
  int initial_level() const { return initial_level_; }
  size_t leaves() const { return leaves_; }

 private:
  bool is_variance_met() const;
  bool is_mean_settled() const;
  bool is_cap_reached() const;
  BintreeStop stop_reason() const;
  void begin(float unoccluded);
  void refine();
  void ask();

  BintreeOptions options_;
  BintreeNodes nodes_;
  Random random_{0};
  BintreePending pending_;
  std::vector<Vec2> pending_uv_;
  std::vector<int32_t> scratch_;
  struct Means {
    std::array<float, 16> ring{};  // of the last iterations
    size_t iterations = 0;
  } means_;
  size_t leaves_ = 1;
  int initial_level_ = 0;
  struct Allowed {
    float unoccluded = 1, leniency = 1;
  } allowed_;  // what errors are measured by
  BintreeEstimate estimate_;
};

// Asks until done. query(std::span<const Vec2> uv, std::span<ShadowRayResult> results) answers
// results[i] for uv[i]. `results` is memory for the answers, kept between calls.
template <class Query>
const BintreeEstimate& answer_all(Bintree& tree, std::vector<ShadowRayResult>& results,
                                  Query&& query) {
  while (!tree.pending().empty()) {
    results.resize(tree.pending().size());
    query(tree.pending(), std::span<ShadowRayResult>(results));
    tree.supply(results);
  }
  return tree.estimate();
}

// One point by itself.
template <class Query>
const BintreeEstimate& sample_source(Bintree& tree, std::vector<ShadowRayResult>& results,
                                     uint64_t stream, Query&& query, float unoccluded = 1) {
  tree.start(stream, unoccluded);
  return answer_all(tree, results, std::forward<Query>(query));
}

// The next point [reuse]: shrinks the last point's pattern, resamples it, refines it.
template <class Query>
const BintreeEstimate& resample_source(Bintree& tree, std::vector<ShadowRayResult>& results,
                                       uint64_t stream, Query&& query, float unoccluded = 1) {
  tree.shrink();
  tree.resample(stream, unoccluded);
  return answer_all(tree, results, std::forward<Query>(query));
}

}  // namespace troffer
