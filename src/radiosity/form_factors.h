// Light from one shooter - a light or a patch - to sample points: its unoccluded irradiance, and
// the share of it that gets through.
//
// Unoccluded: the exact terms of light/irradiance.h, summed over the shooter's pieces; from more
// than 12 radii away a flat piece counts as a point (relative error under 1 %). Shooters of more
// than 24 pieces, which are curved, take [1]'s disc approximation at their rays' ends instead.
// Visibility: the ratio of two sums over rays [2], sum(f V / p) / sum(f / p), the rays' ends being
// chosen by solid angle within a piece and pieces by what they send. A ray brings the radiosity of
// the element at its end, relative to the patch's mean: what lies in a narrow gap before the dark
// end of a patch gets nothing from its bright end.
// References: [1] Wallace, Elmquist & Haines, "A Ray Tracing Algorithm for Progressive Radiosity",
//   SIGGRAPH 1989, §3. [2] Heitz, Hill & McGuire, "Combining Analytic Direct Illumination and
//   Stochastic Shadows", I3D 2018.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/shooter.h"
#include "trace/tracer.h"

namespace troffer {

struct RayBudget {
  int max_rays = 64;
  // Rays to one shooter are as many as keep the error of visibility, 1/2 n^(-3/4) of the unoccluded
  // irradiance, under `tolerance` times `reference`; where the first quarter (at least 4) agree,
  // the rest is not cast.
  float tolerance = 0.003f;
  float reference = 1;  // luminance of a typical irradiance
  // Where the unoccluded irradiance is above `whole_from` times `reference`, at least `whole_rays`
  // rays are cast and none is left out when the first agree: thin occluders are seen.
  int whole_rays = 0;
  float whole_from = 0;
};

struct Transfer {
  Rgb unoccluded;        // irradiance, W/m² or lx; with the shares of parts at the rays' ends
  float visibility = 0;  // 0 … 1
  float share = 1;       // of the parts at the rays' ends, in `unoccluded`
};

// Rays' ends, for those who want to know where light came from.
struct RayRecord {
  uint32_t receiver;
  Vec3 end;
  float weight;
  bool is_visible;
};

struct TransferScratch {
  std::vector<RayRecord>* records = nullptr;  // if set, all rays are appended
  std::vector<Vec3> ends;
  std::vector<Ray> rays;
  std::vector<uint64_t> streams;
  std::vector<uint32_t> samples;
  std::vector<float> numbers;
  std::vector<float> weights, shares;
  std::vector<uint8_t> is_occluded;
  PaneFactors factors;
  std::vector<double> piece_irradiance;
  struct Job {
    uint32_t receiver;
    int first, count, wanted;
    bool is_whole;
    size_t ray;
    double visible, sum, sum_without_shares;
  };
  std::vector<Job> jobs, next_jobs;
  std::vector<uint32_t> indices;
  std::vector<Transfer> transfers;
};

// transfers[i] for receivers[i]. Random numbers derive from `stream` and first_index + i. Returns
// the number of rays.
size_t transfer(const Shooter& shooter, std::span<const ElementPoint> receivers,
                const Tracer& tracer, const RayBudget& budget, uint64_t stream, size_t first_index,
                std::span<Transfer> transfers, TransferScratch& scratch);

// The same for some of the points: transfers[i] is what the call above, for all points from index
// 0, gives to points[indices[i]].
size_t transfer_to(const Shooter& shooter, std::span<const ElementPoint> points,
                   std::span<const uint32_t> indices, const Tracer& tracer, const RayBudget& budget,
                   uint64_t stream, std::span<Transfer> transfers, TransferScratch& scratch);

// How many rays a transfer of so much unoccluded luminance gets at most.
int rays_wanted(const RayBudget& budget, float unoccluded);

}  // namespace troffer
