// Many lights: for a cluster of hits, sources that could give little of its light are represented
// by a few of them, chosen at random in proportion to what they could give at most.
//
// With bounds b_i on the unoccluded light of the weak sources, T their sum and K drawn sources,
// each with the weight T / (K b_i), the estimate is unbiased, and as every term lies between 0 and
// T / K its variance is at most T² / 4K: with T = 2 sqrt(K) E, at most E². Which sources are weak,
// and which are drawn, depends on geometry and on a hash, never on what is visible.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "integrate/source_integrand.h"

namespace troffer {

// A ball that holds a cluster's receivers; `normal`: the common one, or zero; `depth`: metres by
// which, where there is one, they lie below the centre at most.
struct ClusterBall {
  Vec3 centre;
  float radius = 0;
  Vec3 normal;
  float depth = 0;
};

// An upper bound on the projected solid angle of the source, nothing hidden, from any receiver in
// the ball, sr; 0 where no receiver can see its front. `estimate`: about that of one at the centre.
float unoccluded_bound(const CertifiedSource& source, const ClusterBall& ball, float& estimate);

struct ChosenSource {
  uint32_t source;
  uint32_t draws = 0;  // 0: treated for itself
  float weight = 1;    // drawn: what it stands for, as a multiple of its own light
  bool is_drawn() const { return draws > 0; }
};

// Memory, and the result.
struct WeakSourcesScratch {
  std::vector<float> bounds;
  std::vector<uint32_t> order;
  std::vector<ChosenSource> chosen;
  std::vector<uint32_t> weak;  // ascending
};

// Sets scratch.weak to the weak sources and scratch.chosen to those to look at: the others in
// ascending order, then the drawn ones. error: allowed standard error of this choice, relative to
// the unoccluded light of all sources. random: of the cluster.
void choose_sources(std::span<const CertifiedSource> sources, const ClusterBall& ball, float error,
                    uint64_t random, WeakSourcesScratch& scratch);

}  // namespace troffer
