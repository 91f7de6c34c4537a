// Light of flat sources at matte surfaces by certified visibility: many hits at a stroke, exact
// where nothing hides a source, by coverage masks in penumbrae (docs/certified.md).
//
// Hits are clustered; for each cluster and source, reflectance / pi × radiance × unoccluded
// projected solid angle × visible share is added. Unbiased.
#pragma once

#include <cstdint>
#include <vector>

#include "integrate/shadow_world.h"
#include "integrate/walk.h"
#include "shadow/certified.h"
#include "shadow/certified_cluster.h"

namespace troffer {

// Matte hits that wait for light: plain arrays of one length.
struct MatteHits {
  std::vector<ShadowReceiver> receivers;
  std::vector<Vec3> positions, horizons;  // of the receivers, as clustering wants them
  std::vector<Rgb> weights;               // throughput × reflectance / pi
  std::vector<uint32_t> indices;          // of the viewing rays
  std::vector<uint8_t> is_direct;         // the light counts as direct
  std::vector<uint8_t> is_first;          // the viewing ray's first surface

  size_t size() const { return receivers.size(); }
  void clear();
  // `reflectance` of a Lambertian surface at v; the light counts as direct or not.
  void add(const Walk& walk, const Vertex& v, Rgb reflectance, bool direct);
};

// Memory of one thread.
struct FlatLightsScratch {
  FlatLightsScratch(const CertifiedOptions& options, ShadowWorld w)
      : estimator(options), world(std::move(w)) {}
  MatteHits hits;
  CertifiedEstimator estimator;
  ShadowWorld world;
  std::vector<FoundFacets> found;  // per source: what this batch has learnt
  ReceiverClusters clusters;
  std::vector<ShadowReceiver> receivers;  // of one cluster
  std::vector<SourceVisibility> answers;
};

class FlatLights {
 public:
  explicit FlatLights(const PreparedScene& scene);

  // The emitter is dealt with here, whole; others have a round or textured piece, or too many.
  bool has(uint32_t emitter) const { return has_emitter_[emitter]; }
  bool is_empty() const { return sources_.empty(); }

  // What a batch learns is forgotten at its beginning, so that it does not matter what a thread did
  // before.
  void forget(FlatLightsScratch& s) const { s.found.assign(sources_.size(), {}); }
  // Adds the light of all sources at s.hits to `out`, and empties s.hits.
  void illuminate(FlatLightsScratch& s, RadianceBatch& out, Counters& counters) const;

 private:
  struct Source {
    FlatSource shape;
    Rgb radiance;
    uint64_t stream;
  };
  bool add_emitter(const PreparedScene& scene, uint32_t emitter);
  void add_answers(const Source& source, std::span<const uint32_t> members,
                   const FlatLightsScratch& s, RadianceBatch& out, Counters& counters) const;

  std::vector<Source> sources_;
  std::vector<bool> has_emitter_;
  float reach_ = 1;  // metres by which hits of a cluster on a curved surface may lie apart
};

}  // namespace troffer
