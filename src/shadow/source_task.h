// Input and output of the stages of certified visibility for one source and one cluster.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/rgb.h"
#include "base/vec.h"
#include "shadow/certified_options.h"
#include "shadow/cut_cells.h"
#include "shadow/found_facets.h"
#include "shadow/pair_answer.h"
#include "shadow/ray_queue.h"
#include "shadow/shadow_cluster.h"
#include "shadow/shadow_source.h"

namespace troffer {

// Points of a source relative to a receiver, and the values there, as separate coordinates.
struct PointArrays {
  std::vector<float> x, y, z;  // from the receiver, metres
  std::vector<float> r, g, b;

  size_t size() const { return x.size(); }
  void clear() {
    x.clear();
    y.clear();
    z.clear();
  }
};

// Interface to a textured light or glossy surface: the light that a receiver reflects from points
// of a source, per unit of projected solid angle (radiance × BRDF). request: index of the source in
// the cluster's requests; member: index of the receiver.
class ShadowIntegrand {
 public:
  virtual ~ShadowIntegrand() = default;
  // Returns the number of points on the whole source; 0 if the receiver wants its visibility only.
  virtual uint32_t points(uint32_t request, uint32_t member) = 0;
  // Sets values[i] for points[i] in world space.
  virtual void evaluate(uint32_t request, uint32_t member, std::span<const Vec3> points,
                        std::span<Rgb> values) = 0;
  // True if all open samples of a mask should be evaluated together, by evaluate_many.
  virtual bool is_smooth(uint32_t /*request*/, uint32_t /*member*/) const { return false; }
  // True if, in addition, the integrand varies so slowly that a few samples are enough.
  virtual bool is_low_variance(uint32_t /*request*/, uint32_t /*member*/) const { return false; }
  // Sets r, g, b of all points.
  virtual void evaluate_many(uint32_t /*request*/, uint32_t /*member*/, PointArrays& /*points*/) {}
};

// The scene as seen from sources at infinity: large facets, which may hide much of them.
struct LargeFacets {
  std::vector<FacetToAdd> large;
};

// A source whose light a cluster requests: either flat or a sphere.
struct LightRequest {
  const FlatSource* flat = nullptr;
  const SphereSource* sphere = nullptr;
  uint64_t stream = 0;               // hash that is unique to the source, for random numbers
  float brightness = 1;              // luminance of its radiance
  FoundFacets* found = nullptr;      // results of earlier clusters; this one adds to it
  const LargeFacets* far = nullptr;  // for flat sources at infinity, else null
  // Facets that hide this source only, in addition to the scene's.
  std::span<const FacetToAdd> frame{};
  // All receivers of the batch that this cluster belongs to. They share the number of direct rays.
  // Empty: the cluster's own receivers.
  std::span<const ShadowReceiver> batch{};
};

// Error and cost limits for the masks of one of n sources. Let a receiver see the light `seen` of
// earlier sources, in sr of this source, and o of this one, s in total. The variance may be error²
// s max(o, s / 2n), or error² floor² if that is more. Over all sources, in any order, this sums to
// at most 1.5 error² times the squared total light.
struct MaskBudget {
  float error = 0;                // relative to the light that arrives; 0: no limit
  double budget = 0;              // facets in the masks of one receiver
  std::span<const float> seen{};  // per receiver: light of earlier sources
  std::span<const float> rest{};  // per receiver: unoccluded light of later sources
  std::span<const float> floor{};  // per receiver: least light that errors are relative to, over √n
  double sources = 1;              // n
  double far_open = 0.5;           // estimated share of the light from infinity that arrives
  double longest_list = 0;         // facets that are worth gathering for the source
};

// One source and one cluster.
struct SourceTask {
  const CertifiedOptions& options;
  const ShadowCluster& cluster;
  LightRequest request;
  uint32_t number;                          // index of the request
  std::span<const float> unoccluded;        // per receiver, of the whole source, sr
  ShadowIntegrand* integrand;               // null if no receiver has an integrand
  std::span<const uint32_t> wanted_points;  // per receiver, for the integrand
  MaskBudget promise{};

  bool is_disk() const { return request.flat != nullptr && request.flat->is_disk; }
  // True if a receiver's own horizon acts as an occluder. The unoccluded light of polygons accounts
  // for each horizon, that of round sources only for the horizon of the normal.
  bool does_horizon_hide() const {
    return cluster.has_own_horizons && (request.sphere != nullptr || is_disk());
  }
};

// A part of a source at infinity that the answers leave out, for the caller to sample.
struct UnsettledPart {
  uint32_t request;
  FlatCell cell;
  std::vector<float> unoccluded;  // per receiver, sr
};

// Output of the stages.
struct SourceResults {
  std::span<CellSum> sums;  // per receiver
  RayQueue& rays;           // rays for samples without a proof
  CertifiedCounters& counters;
  std::vector<UnsettledPart>* left = nullptr;  // null: no part may be left out
};

}  // namespace troffer
