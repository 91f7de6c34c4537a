// Light straight from sources by certified visibility: many hits at a stroke, exact where nothing
// hides a source, by coverage masks in penumbrae, by rays where lists of occluders are not complete
// (docs/certified.md).
//
// Hits are clustered; for each cluster and source, reflectance / pi × radiance × unoccluded
// projected solid angle × visible share is added at matte hits, and an integral over the visible
// part elsewhere. Of many lights most are drawn at random instead, and so are those without
// certificates at matte hits (drawn_lights.h). Unbiased.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "certified/drawn_lights.h"
#include "certified/far_rays.h"
#include "certified/light_groups.h"
#include "certified/shadow_world.h"
#include "certified/source_integrand.h"
#include "certified/waiting_hits.h"
#include "shadow/certified_light.h"
#include "shadow/receiver_clusters.h"
#include "shadow/source_pieces.h"
#include "trace/closed_shells.h"

namespace troffer {

// Memory of one thread.
struct CertifiedLightsScratch {
  CertifiedLightsScratch(const CertifiedOptions& o, ShadowWorld w, SourceIntegrand i)
      : options(o), world(std::move(w)), integrand(std::move(i)) {}
  WaitingHits hits;
  SampleRequest request;  // of the batch
  CertifiedOptions options;
  ShadowWorld world;
  SourceIntegrand integrand;
  std::vector<FoundFacets> found;  // per source: what this batch has learnt
  ReceiverClusters clusters;
  CertifiedCluster cluster;
  LightsOfCluster chosen;
  std::vector<uint32_t> requested;    // sources of the cluster's requests
  std::vector<uint32_t> drawing;      // hits of the cluster
  std::vector<uint32_t> first, rest;  // … that are certified to see what that takes, and others
  DrawnLightsScratch drawn;
  FarRays far_rays;
  FarShare far;                        // of the light of far sources, what arrives at the hits
  std::vector<uint8_t> is_closed_off;  // per hit, surely: from all that is far away
};

class CertifiedLights {
 public:
  // gloss_points: of each source at which gloss and textures are looked at.
  CertifiedLights(const PreparedScene& scene, const DrawingBudget& budget, uint32_t gloss_points);
  CertifiedLights(const CertifiedLights&) = delete;
  CertifiedLights& operator=(const CertifiedLights&) = delete;

  // The light is dealt with here, whole, by certificates or because it is drawn. The latter are
  // meshes of too many pieces that lie in no common plane, or have no certificate shape (light.h).
  bool has(uint32_t light) const { return has_light_[light] || is_drawn_[light]; }
  bool is_drawn(uint32_t light) const { return is_drawn_[light]; }
  bool is_empty() const { return groups_.size() == 0 && far_.cells->all().empty(); }
  const LobeCompetition& competition() const { return competition_; }
  // The source that a point on a piece of a light belongs to, seen from its front or its back;
  // null if none.
  const CertifiedSource* source_of(uint32_t primitive, bool is_back, const Vec3& point) const;
  // The one of a light at infinity in a direction; null if none.
  const CertifiedSource* source_towards(uint32_t primitive, const Vec3& direction) const;

  // Before the first hits, where there are lights at infinity; they must stay.
  void set_occluders(const Occluders& occluders);

  // What a batch learns is forgotten at its beginning, so that it does not matter what a thread did
  // before.
  void forget(CertifiedLightsScratch& s) const { s.found.assign(sources_.size(), {}); }
  // Adds the light of all sources at s.hits to `out`, and empties s.hits.
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
  FarPointDraws far_draws(const CertifiedLightsScratch& s) const {
    return {scene_, competition_, s.hits, far_.points, *far_.occluders};
  }
  // False: some hit may get light from far away.
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
  LobeCompetition competition_;
  std::vector<bool> has_light_, is_drawn_;
  // Per primitive, the last source that covers some of it; per source, one before that covers some
  // of the same primitive; -1: none.
  std::vector<int32_t> source_of_front_, source_of_back_, before_;
  struct Far {
    const FarCells* cells = nullptr;  // of the scene
    uint32_t first_source = 0;        // those of the cells are the last ones
    const Occluders* occluders = nullptr;
    FarScene scene;            // what hides much of them
    FarPoints points;          // … where proofs are not worth while
    ClosedShells shells;       // … and what none of it gets into
    bool is_shut_out = false;  // … nor, as it seems, anything that other lights shine on
    // Of portals, what hides their lights beside them; by the primitives they belong to.
    std::vector<std::vector<FacetToAdd>> frames;
    double frame_reach = 0;  // metres by which they go on beyond their sides
    Vec3 centre;             // of the scene, about which the cells stand
    float reach = 0;         // metres from there within which their directions are exact
  } far_;
  DrawingBudget budget_;
  float reach_ = 1;  // metres by which hits of a cluster on a curved surface may lie apart
};

}  // namespace troffer
