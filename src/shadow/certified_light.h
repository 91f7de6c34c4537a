// Direct light of a cluster of receivers by certified visibility: the driver of all stages.
// Visibility is proved by geometry where possible. Coverage masks settle penumbrae, and rays decide
// only where no facet list is complete. Light is in sr of projected solid angle. Stages for each
// source:
//   1. unoccluded light                                     shadow_cluster.h
//   2. facets in the shaft between cluster and source; if
//      there are too many, one of the two is halved         gather_facets.h
//   3. source cells over which the light varies little      settle_part.h, cut_cells.h
//   4. certificates: facets that hide nothing are dropped;
//      the cell is dark if one facet hides all of it, lit if
//      none is left; the cluster is halved if this helps    settle_cell.h
//   5. masks of the remaining facets                        mask_cell.h, coverage_mask.h
// and for all sources together
//   6. residual rays through open samples                   residual_rays.h
// A sphere is replaced by the disk that its outline spans, one per receiver; steps 3 and 4 are
// skipped. Textured lights and glossy surfaces are integrated over points drawn from the masks.
// Cells and lists depend only on geometry and on rays of earlier clusters, so the estimate is
// unbiased. References: docs/method/certified.md.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "shadow/residual_rays.h"
#include "shadow/settle_part.h"

namespace troffer {

// Working memory and counters of certified_light, one per thread. Nothing that a call leaves here
// changes the answers of the next call.
struct CertifiedMemory {
  std::vector<float> unoccluded;      // per receiver, of the current source, sr
  std::vector<float> all_unoccluded;  // unoccluded light of all requests, one after the other, sr
  std::vector<uint32_t> order;        // requests, strongest first
  std::vector<float> light;           // per receiver: brightness × visible light so far, sr
  std::vector<float> done;  // per receiver: brightness × unoccluded light of requests so far
  std::vector<float> seen, rest, floor;  // per receiver: Promise of the current source
  std::vector<uint32_t> wanted_points;   // per receiver: number of points for its integrand
  std::vector<uint32_t> members;         // receivers that the source reaches
  std::vector<CellSum> sums;             // per receiver
  GatherMemory gather;
  PartMemory part;
  std::vector<float> total;       // per receiver: brightness × unoccluded light of all requests
  std::vector<float> allowed;     // per receiver: error allowed to its rays
  bool is_cast_in_parts = false;  // true if the cluster's rays are cast in several batches
  RayQueue queue;
  RayMemory rays;
  std::vector<SourceVisibility> answers;  // answers of the current source
  std::vector<SourceVisibility> waiting;  // answers of requests that wait for rays
  double far_open = 0.5;                  // estimated share of the light from infinity that arrives
  // parts of sources at infinity that the last call did not answer; the caller samples them
  std::vector<UnsettledPart> left;
  CertifiedCounters counters;
};

// Receives the finished answers of one request: answers[i] belongs to receiver i of the cluster.
using TakeAnswers =
    std::function<void(uint32_t request, std::span<const SourceVisibility> answers)>;

// Answers each request once: first those that need no ray, strongest first, then those that wait
// for rays, which are cast together. integrand: null if all receivers want visibility only. The
// result depends only on the cluster, the requests and their FoundFacets. The rays add the facets
// that they hit to FoundFacets.
void certified_light(const ShadowCluster& cluster, std::span<const LightRequest> requests,
                     ShadowIntegrand* integrand, ShadowScene& scene,
                     const CertifiedOptions& options, CertifiedMemory& memory,
                     const TakeAnswers& take);

}  // namespace troffer
