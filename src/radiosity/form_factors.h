// Light from one shooter, a light or a patch, to sample points: unoccluded irradiance and
// visibility. Irradiance is in W/m² or lx.
//
// Unoccluded irradiance: the exact terms of light/irradiance.h, summed over the shooter's pieces. A
// flat piece more than 12 radii away counts as a point (relative error below 1 %). Shooters of more
// than 24 pieces, which are curved, use [1]'s disc approximation at the ray ends instead.
//
// Visibility: the ratio of two sums over rays [2], sum(f V / p) / sum(f / p). A piece is chosen by
// the power that it sends, and a ray end on it by solid angle. Each ray is weighted with the
// radiosity of the element at its end, relative to the patch's mean. A point in a narrow gap before
// the dark end of a patch therefore receives nothing from its bright end.
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
  // The number of rays keeps the error of visibility, 1/2 n^(-3/4) of the unoccluded irradiance,
  // below `tolerance` times `reference`. If the first quarter (at least 4 rays) agree, the others
  // are not traced.
  float tolerance = 0.003f;
  float reference = 1;  // luminance of a typical irradiance
  // Above `whole_from` times `reference` of unoccluded irradiance, at least `whole_rays` rays are
  // traced, all of them, so that thin occluders are found.
  int whole_rays = 0;
  float whole_from = 0;
};

struct Transfer {
  Rgb unoccluded;        // irradiance, W/m² or lx, multiplied by `share`
  float visibility = 0;  // 0 to 1
  float share = 1;       // mean relative radiosity of the parts at the ray ends
};

// End point of a ray, for callers that need to know where the light came from.
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

// Computes transfers[i] for receivers[i]. Random numbers derive from `stream` and first_index + i.
// Returns the number of rays.
size_t transfer(const Shooter& shooter, std::span<const ElementPoint> receivers,
                const Tracer& tracer, const RayBudget& budget, uint64_t stream, size_t first_index,
                std::span<Transfer> transfers, TransferScratch& scratch);

// Same for a subset of points: transfers[i] equals the result of transfer() for points[indices[i]],
// called for all points from index 0.
size_t transfer_to(const Shooter& shooter, std::span<const ElementPoint> points,
                   std::span<const uint32_t> indices, const Tracer& tracer, const RayBudget& budget,
                   uint64_t stream, std::span<Transfer> transfers, TransferScratch& scratch);

// Returns the maximum number of rays of a transfer with this unoccluded luminance.
int rays_wanted(const RayBudget& budget, float unoccluded);

}  // namespace troffer
