// From a cluster of receivers to the light of sources that it sees: the driver of certified
// visibility. Shadow flags are proved by geometry, masks stand where a shadow's boundary passes,
// and rays only for what no list of facets settles. One stage after the other, for each source:
//   1. what it would send if nothing hid it                       shadow_cluster.h
//   2. the facets in the shaft between the two; too many: the
//      cluster or the source is halved, a few times at most       gather_facets.h
//   3. the source in cells over which its light varies little     settle_part.h, cut_cells.h
//   4. facets proved to hide nothing of a cell are dropped, one
//      proved to hide all of it makes it dark; none left: lit;
//      the cluster is halved while that shortens lists            settle_cell.h
//   5. per receiver and cell a mask of the facets left            mask_cell.h, coverage_mask.h
// and for all sources together
//   6. where lists are not complete, rays through open samples    residual_rays.h
// A sphere is the disk that its outline spans, one for each receiver, without steps 3 and 4. What
// is not Lambert's term times a constant radiance is integrated over points drawn from the mask.
// Cells and lists depend on geometry and on rays of earlier clusters, never on what is estimated
// with them, so that the estimate is unbiased: see docs/certified.md.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "shadow/residual_rays.h"
#include "shadow/settle_part.h"

namespace troffer {

// Memory alone, one for each thread, and what has been counted: nothing that a call leaves here
// changes the next one's answers.
struct CertifiedMemory {
  std::vector<float> unoccluded;         // per receiver, of the source at hand
  std::vector<float> all_unoccluded;     // … of all requests, one after the other
  std::vector<uint32_t> order;           // of requests
  std::vector<float> light;              // per receiver: brightness × what has been seen so far
  std::vector<float> done;               // … what has been asked for so far, nothing hidden
  std::vector<float> seen, rest, floor;  // per receiver: of the promise at hand
  std::vector<uint32_t> wanted_points;   // per receiver
  std::vector<uint32_t> members;         // whom the source lights
  std::vector<CellSum> sums;             // per receiver
  GatherMemory gather;
  PartMemory part;
  std::vector<float> total;       // per receiver: brightness × unoccluded light of all requests
  std::vector<float> allowed;     // per receiver: error allowed to its rays
  bool is_cast_in_parts = false;  // the rays of the cluster, some sources after the others
  RayQueue queue;
  RayMemory rays;
  std::vector<SourceVisibility> answers;  // of the source at hand, or of all that wait for rays
  std::vector<SourceVisibility> waiting;
  double far_open = 0.5;  // the share of far sources' light that arrives, about
  std::vector<LeftPart> left;  // of far sources, of the last call: their answers leave these out
  CertifiedCounters counters;
};

// Takes the finished answers of one request: answers[i] is that of receiver i of the cluster.
using TakeAnswers =
    std::function<void(uint32_t request, std::span<const SourceVisibility> answers)>;

// Answers each request once, the strongest first: those that need no ray, then those that wait for
// rays, which are cast for many of them together. integrand: null if all receivers want
// visibility alone. Deterministic in the cluster, the requests and what these have found, which is
// read first and added to at the end.
void certified_light(const ShadowCluster& cluster, std::span<const LightRequest> requests,
                     ShadowIntegrand* integrand, ShadowScene& scene,
                     const CertifiedOptions& options, CertifiedMemory& memory,
                     const TakeAnswers& take);

}  // namespace troffer
