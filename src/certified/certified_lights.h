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
#include <vector>

#include "certified/certified_sources.h"
#include "certified/drawn_lights.h"
#include "certified/environment_rays.h"
#include "certified/shadow_world.h"
#include "certified/source_integrand.h"
#include "certified/waiting_hits.h"
#include "shadow/certified_light.h"
#include "shadow/receiver_clusters.h"

namespace troffer {

// Scratch memory of one thread.
struct CertifiedLightsScratch {
  CertifiedLightsScratch(const CertifiedOptions& o, ShadowWorld w, SourceIntegrand i)
      : options(o), world(std::move(w)), integrand(std::move(i)) {}
  WaitingHits hits;
  SampleRequest request;  // request of the current batch
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
  // `gloss_points` is passed to CertifiedSources.
  CertifiedLights(const PreparedScene& scene, const DrawingBudget& budget, uint32_t gloss_points)
      : scene_(scene), sources_(scene, budget.draws > 0, gloss_points), budget_(budget) {}

  const CertifiedSources& sources() const { return sources_; }
  // Calls CertifiedSources::set_occluders().
  void set_occluders(const Occluders& occluders) { sources_.set_occluders(occluders); }

  // Starts a batch: discards the facets found in the last one, so that results do not depend on
  // earlier batches of the thread.
  void forget(CertifiedLightsScratch& s) const { s.found.assign(sources_.all().size(), {}); }
  // Adds the light of all sources at s.hits to `out`, then empties s.hits.
  void illuminate(CertifiedLightsScratch& s, RadianceBatch& out, Counters& counters) const;

 private:
  // Sets s.is_closed_off. Returns true if no hit can receive environment light.
  bool find_closed_off(CertifiedLightsScratch& s) const;

  const PreparedScene& scene_;
  CertifiedSources sources_;
  DrawingBudget budget_;
};

}  // namespace troffer
