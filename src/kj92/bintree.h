// The bintree of 1992: adaptive sampling of one source from one point, and reuse of the pattern at
// the next point. The tree knows only (u,v) in [0,1)² and the answers to its rays, so it works for
// any parametrised source. Each tree belongs to one thread at a time.
// A tree asks in rounds: pending() returns the rays that it wants, supply() takes their answers and
// decides what to ask next. The rays of many trees can thus be traced together. sample_source and
// resample_source below run the rounds of one tree. The first round is large; later rounds have a
// few rays.
// The estimate is biased, because the number and places of rays depend on earlier results.
// References: [1] Kok & Jansen, "Adaptive Sampling of Area Light Sources in Ray Tracing Including
//   Diffuse Interreflection", Eurographics '92, §3 and §4. [rule n], [reuse]:
//   docs/method/bintree.md.
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

// Settings of one bintree; the numbers in brackets are rules of docs/method/bintree.md.
struct BintreeOptions {
  // Initial rays, spread evenly [rule 1]. Rounded up to a power of two; at least 1.
  int initial_rays = 8;
  // Allowed standard error of the mean, relative to the unoccluded light [rule 2]: the root's
  // variance must fall below (allowed_variance × unoccluded)². The variance is estimated as if rays
  // were independent. A source that is half in shadow then needs a quarter over the square of this
  // number: 100 rays at 0.05. At 0.01 the second stop or the cap usually ends the sampling. 0:
  // refines all cells evenly up to most_rays, which is full stratified sampling.
  float allowed_variance = 0.01f;
  // Levels that a leaf may be above its neighbour [rule 4]. Two levels halve a cell both ways.
  int level_difference = 1;
  // Second stop [rule 5]: the mean stayed within an interval of this width, relative to the
  // unoccluded light, over the last mean_change_iterations (1 to 16), and at least enough_rays were
  // cast. 0: never.
  float mean_change = 0.004f;
  int mean_change_iterations = 8;
  int enough_rays = 32;
  // Largest number of rays for one point. Initial rays are halved until they fit.
  int most_rays = 128;
  // [reuse] Draws new positions in the cells of a reused pattern. If false, keeps the old
  // positions.
  bool renews_jitter = true;
};

// Answer to one ray. Its value is kernel if visible, else 0; the estimate is Σ cell area × value.
// With kernel = 1 it is the visible share of the source. Any other kernel (textured radiance,
// geometry term, both) must not be negative. Its mean over the square is the `unoccluded` passed to
// start() and resample().
struct ShadowRayResult {
  bool is_visible = false;
  float kernel = 1;
};

// Reason why sampling stopped; finest: a leaf at the deepest level would have to be split.
enum class BintreeStop : uint8_t { none, variance, mean, cap, finest };

struct BintreeEstimate {
  float mean = 0;      // mean of visibility × kernel over the square
  float variance = 0;  // variance of the mean, estimated by the tree
  uint32_t rays = 0;   // cast for this point
  BintreeStop stop = BintreeStop::none;
};

// Bintree of one source. Call start() or resample(), then answer pending() by supply() until it is
// empty.
class Bintree {
 public:
  explicit Bintree(const BintreeOptions& options = {});

  // Starts at a point without a pattern. stream: seed of the jitter, a hash of pixel, sample and
  // source. initial_rays 0: the number in the options.
  void start(uint64_t stream, float unoccluded = 1, int initial_rays = 0);
  // [reuse] Starts at the next point with the present pattern. All its leaves become pending.
  void resample(uint64_t stream, float unoccluded = 1);

  // Returns the mean over the square of the kernels in `results`, one per ray of pending(). Call it
  // before supply(), where the unoccluded light is known only from the first round.
  float mean_of_pending(std::span<const ShadowRayResult> results) const;
  // Replaces the value passed to start() or resample(). leniency multiplies the errors that the
  // stops allow, for light that is only a small part of the total.
  void set_unoccluded(float unoccluded, float leniency = 1) { allowed_ = {unoccluded, leniency}; }

  // Returns the end points (u,v) of the wanted rays; empty when done. Valid until the next call.
  std::span<const Vec2> pending() const { return pending_uv_; }
  // Takes the answers: results[i] belongs to pending()[i]. Then stops, or splits leaves and asks
  // for more rays.
  void supply(std::span<const ShadowRayResult> results);

  // [reuse] Simplifies the pattern for the next point. Call after the last answer. The estimate
  // does not change.
  void shrink();

  const BintreeEstimate& estimate() const { return estimate_; }
  // Returns Σ cell area × kernel over all leaves, also hidden ones. mean / kernel_mean is a ratio
  // estimate.
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
    std::array<float, 16> ring{};  // values of the last iterations
    size_t iterations = 0;
  } means_;
  size_t leaves_ = 1;
  int initial_level_ = 0;
  struct Allowed {
    float unoccluded = 1, leniency = 1;
  } allowed_;  // reference for allowed errors
  BintreeEstimate estimate_;
};

// Answers rounds until the tree is done. query(std::span<const Vec2> uv, std::span<ShadowRayResult>
// results) sets results[i] for uv[i]. `results` is memory that is kept between calls.
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

// Samples the source from one point, without a pattern.
template <class Query>
const BintreeEstimate& sample_source(Bintree& tree, std::vector<ShadowRayResult>& results,
                                     uint64_t stream, Query&& query, float unoccluded = 1) {
  tree.start(stream, unoccluded);
  return answer_all(tree, results, std::forward<Query>(query));
}

// Samples the source from the next point: shrinks the pattern, resamples it, and refines it
// [reuse].
template <class Query>
const BintreeEstimate& resample_source(Bintree& tree, std::vector<ShadowRayResult>& results,
                                       uint64_t stream, Query&& query, float unoccluded = 1) {
  tree.shrink();
  tree.resample(stream, unoccluded);
  return answer_all(tree, results, std::forward<Query>(query));
}

}  // namespace troffer
