// Direct light of all area and environment lights at many hits at once, by certified visibility.
// CertifiedDirect drives it.
//
// Hits are grouped into clusters. For each cluster and source, a certificate gives exact light, a
// coverage mask answers penumbrae, and shadow rays answer incomplete facet lists. Matte hits
// receive reflectance / pi × radiance × unoccluded projected solid angle × visible share. At other
// hits the BRDF is integrated over the visible part of the source.
//
// Where lights are many, most are sampled at random instead; so are lights without certificates
// (drawn_lights.h). Unbiased. Method: docs/method/certified.md.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "certified/drawn_lights.h"
#include "certified/environment_rays.h"
#include "certified/light_groups.h"
#include "certified/shadow_world.h"
#include "certified/source_integrand.h"
#include "certified/waiting_hits.h"
#include "shadow/certified_light.h"
#include "shadow/receiver_clusters.h"
#include "shadow/source_pieces.h"
#include "trace/closed_shells.h"

namespace troffer {

// Scratch memory of one thread.
struct CertifiedLightsScratch {
  CertifiedLightsScratch(const CertifiedOptions& o, ShadowWorld w, SourceIntegrand i)
      : options(o), world(std::move(w)), integrand(std::move(i)) {}
  WaitingHits hits;
  SampleRequest request;  // of the current batch
  CertifiedOptions options;
  ShadowWorld world;
  SourceIntegrand integrand;
  std::vector<FoundFacets> found;  // per source: facets found during this batch
  ReceiverClusters clusters;
  CertifiedCluster cluster;
  ClusterLights chosen;
  std::vector<uint32_t> requested;    // source index of each request of the cluster
  std::vector<uint32_t> drawing;      // hits of the cluster, for draw()
  std::vector<uint32_t> first, rest;  // hits certified as a cost probe, and the remaining hits
  DrawnLightsScratch drawn;
  EnvironmentRays far_rays;
  EnvironmentShare far;  // share of environment light that arrives at the batch's hits
  std::vector<uint8_t> is_closed_off;  // per hit; 1: provably enclosed by an opaque shell
};

// Immutable after set_occluders(); any number of threads may call illuminate(), each with a scratch
// of its own.
class CertifiedLights {
 public:
  // gloss_points: points per source at which glossy BRDFs and textured radiance are evaluated.
  CertifiedLights(const PreparedScene& scene, const DrawingBudget& budget, uint32_t gloss_points);
  CertifiedLights(const CertifiedLights&) = delete;
  CertifiedLights& operator=(const CertifiedLights&) = delete;

  // True if this class computes all light of `light`, by certificates or by sampling.
  bool has(uint32_t light) const { return has_light_[light] || is_drawn_[light]; }
  // True if the light is always sampled: a mesh of too many pieces that lie in no common plane, or
  // a light without a certificate shape (light.h).
  bool is_drawn(uint32_t light) const { return is_drawn_[light]; }
  bool is_empty() const { return groups_.size() == 0 && far_.cells->all().empty(); }
  const NominalSourceDensity& competition() const { return competition_; }
  // Returns the source that covers `point` on a light primitive, seen from its front or its back;
  // null if none does.
  const CertifiedSource* source_of(uint32_t primitive, bool is_back, const Vec3& point) const;
  // Returns the sky patch of an environment light in `direction`; null if there is none.
  const CertifiedSource* source_towards(uint32_t primitive, const Vec3& direction) const;

  // Prepares environment lights. Call before the first hits; `occluders` must outlive this object.
  // Does nothing if the scene has no environment lights.
  void set_occluders(const Occluders& occluders);

  // Starts a batch: discards the facets found in the last one, so that results do not depend on
  // what a thread did before.
  void forget(CertifiedLightsScratch& s) const { s.found.assign(sources_.size(), {}); }
  // Adds the light of all sources at s.hits to `out`, then empties s.hits.
  void illuminate(CertifiedLightsScratch& s, RadianceBatch& out, Counters& counters) const;

 private:
  void add_source(const CertifiedSource& source, std::span<const uint32_t> primitives);
  bool add_light(const PreparedScene& scene, uint32_t light);
  bool add_flat_light(const PreparedScene& scene, uint32_t light,
                      const std::vector<SourcePiece>& pieces);
  void add_drawn_lights(const PreparedScene& scene);
  void add_far_lights(const PreparedScene& scene);
  void illuminate_cluster(std::span<const uint32_t> members, CertifiedLightsScratch& s,
                          RadianceBatch& out, Counters& counters) const;
  EnvironmentSamplerInputs far_draws(const CertifiedLightsScratch& s) const {
    return {scene_, competition_, s.hits, far_.points, *far_.occluders};
  }
  // Sets s.is_closed_off. Returns true if no hit can receive environment light.
  bool find_closed_off(CertifiedLightsScratch& s) const;
  void count_closed_off(std::span<const uint32_t> members, const CertifiedLightsScratch& s,
                        RadianceBatch& out, Counters& counters) const;
  bool is_proof_of_far_worth(std::span<const uint32_t> members, const CertifiedLightsScratch& s,
                             const RadianceBatch& out) const;
  bool may_be_proved_far(std::span<const uint32_t> members, const CertifiedLightsScratch& s) const;
  void set_requests(CertifiedLightsScratch& s, bool has_far) const;
  void draw(std::span<const uint32_t> members, CertifiedLightsScratch& s, RadianceBatch& out,
            Counters& counters) const;
  std::span<const float> certify(std::span<const uint32_t> members, bool has_far,
                                 CertifiedLightsScratch& s, RadianceBatch& out,
                                 Counters& counters) const;
  void set_draws(std::span<const uint32_t> members, uint32_t effort_divisor,
                 CertifiedLightsScratch& s) const;
  void certify_or_draw(std::span<const uint32_t> members, CertifiedLightsScratch& s,
                       RadianceBatch& out, Counters& counters) const;
  void add_answers(uint32_t request, std::span<const uint32_t> members,
                   std::span<const SourceVisibility> answers, CertifiedLightsScratch& s,
                   RadianceBatch& out, Counters& counters) const;

  const PreparedScene& scene_;
  std::vector<CertifiedSource> sources_;
  LightGroups groups_;
  NominalSourceDensity competition_;
  std::vector<bool> has_light_, is_drawn_;
  // Per primitive: the last source that covers part of it, or -1. before_: per source, the
  // preceding source on the same primitive, or -1.
  std::vector<int32_t> source_of_front_, source_of_back_, before_;
  struct Far {
    const SkyPatches* cells = nullptr;  // of the prepared scene
    uint32_t first_source = 0;          // index of the first sky patch; sky patches end sources_
    const Occluders* occluders = nullptr;
    LargeFacets scene;          // the scene's largest facets
    EnvironmentSampler points;  // sampler of environment lights, used without proofs
    ClosedShells shells;        // closed opaque surfaces, which keep environment light out
    // rays found no environment light where other lights shine (not proved)
    bool seems_shut_out = false;
    // Per primitive: frame around its portal, which blocks light that passes beside the portal.
    std::vector<std::vector<FacetToAdd>> frames;
    double frame_reach = 0;  // extent of the frames beyond the portals' sides, metres
    Vec3 centre;             // centre of the scene and of the sky cube
    float reach = 0;         // metres from `centre` within which patch directions are exact
  } far_;
  DrawingBudget budget_;
  float reach_ = 1;  // largest extent of a cluster on a curved surface, metres
};

}  // namespace troffer
