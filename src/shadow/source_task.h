// One source against one cluster: what every stage between the two wants to know.
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

// Points of a source, as seen from a receiver, and what is sent on from there, coordinate by
// coordinate.
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

// What is sent on to a receiver through points of a source, per unit of projected solid angle:
// radiance × BRDF, where either varies. request: the source's number in the cluster's list.
class ShadowIntegrand {
 public:
  virtual ~ShadowIntegrand() = default;
  // At how many points of the whole source; 0: not at all, the receiver wants its visibility.
  virtual uint32_t points(uint32_t request, uint32_t member) = 0;
  virtual void evaluate(uint32_t request, uint32_t member, std::span<const Vec3> points,
                        std::span<Rgb> values) = 0;
  // Whether the receiver's points of this source are better looked at all at a stroke: then as many
  // as the mask has.
  virtual bool is_smooth(uint32_t /*request*/, uint32_t /*member*/) const { return false; }
  // … and varies over the source so slowly that a few of them are enough.
  virtual bool is_low_variance(uint32_t /*request*/, uint32_t /*member*/) const { return false; }
  virtual void evaluate_many(uint32_t /*request*/, uint32_t /*member*/, PointArrays& /*points*/) {}
};

// What is known of a scene before sources that are far away: facets that may hide much of them. Of
// such a source, parts that facets are too dense before are left to whoever asked.
struct FarScene {
  std::vector<FacetToAdd> large;
};

// A source whose light a cluster wants: one of the two shapes.
struct LightRequest {
  const FlatSource* flat = nullptr;
  const SphereSource* sphere = nullptr;
  uint64_t stream = 0;            // hash that tells its random numbers from others'
  float brightness = 1;           // luminance of its radiance
  FoundFacets* found = nullptr;   // what earlier clusters have learnt; this one adds to it
  const FarScene* far = nullptr;  // of a flat source at infinity
  // … what hides it besides the scene's facets, and hides no other source.
  std::span<const FacetToAdd> frame{};
  // Receivers that this cluster is one of several of: rays straight to the source are as many for
  // all of them. None: the cluster's own.
  std::span<const ShadowReceiver> batch{};
};

// What the masks of one of n sources may err by, and may cost. Where receivers see the light `seen`
// of sources that came before, in sr of this one, and o of this one, together s, the variance may
// be error² s max(o, s / 2n), or error² floor² where that is more: over all sources, in any
// order, 1.5 times error² of the square of all light at most.
struct Promise {
  float error = 0;                 // relative to the light that arrives; 0: nothing is asked
  double budget = 0;               // facets over which a receiver's masks may go
  std::span<const float> seen{};   // per receiver
  std::span<const float> rest{};   // … and what those that come after would send, nothing hidden
  std::span<const float> floor{};  // … and the least that errors are compared with, / √n
  double sources = 1;              // n
  double far_open = 0.5;           // what share of all far sources' light arrives, about
  double longest_list = 0;         // facets that are worth gathering before the source
};

struct SourceTask {
  const CertifiedOptions& options;
  const ShadowCluster& cluster;
  LightRequest request;
  uint32_t number;                          // of the request
  std::span<const float> unoccluded;        // per receiver, of the whole source, sr
  ShadowIntegrand* integrand;               // null: nobody has one
  std::span<const uint32_t> wanted_points;  // per receiver, of the integrand
  Promise promise{};

  bool is_disk() const { return request.flat != nullptr && request.flat->is_disk; }
  // Unoccluded light of polygons knows every horizon, that of round shapes that of the normal only:
  // the receiver's own one hides.
  bool does_horizon_hide() const {
    return cluster.has_own_horizons && (request.sphere != nullptr || is_disk());
  }
};

// A part of a far source that its answer leaves out.
struct LeftPart {
  uint32_t request;
  FlatCell cell;
  std::vector<float> unoccluded;  // per receiver, sr
};

// Where the stages put what they find.
struct SourceResults {
  std::span<CellSum> sums;  // per receiver
  RayQueue& rays;           // what only rays can tell
  CertifiedCounters& counters;
  std::vector<LeftPart>* left = nullptr;  // null: nothing may be left
};

}  // namespace troffer
