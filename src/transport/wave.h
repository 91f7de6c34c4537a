// Hits of one wave of walks, as arrays for DirectLight and IndirectLight, and the emission that
// walks have hit. WaveIntegrator fills both; path tracing and gather rays use the same types.
#pragma once

#include <cstdint>
#include <vector>

#include "transport/batch.h"
#include "transport/radiosity_place.h"
#include "transport/surface_scattering.h"
#include "transport/walk.h"

namespace troffer {

// Hits at which light is to be computed, as arrays of one length; some may be empty as noted. At
// most a few dozen, so that their data stay in the caches.
struct WaveHits {
  std::vector<Walk> walks;  // walks that have arrived; integrators may leave notes in them
  std::vector<Hit> hits;    // empty for sensors, which no ray has hit
  std::vector<Vertex> vertices;
  std::vector<Bsdf> bsdfs;                     // for methods that use whole BSDFs; else empty
  std::vector<SurfaceScattering> scatterings;  // for methods that split them; else empty
  // Probability that the walk continues, over the probability that a light is sampled; empty: 1.
  std::vector<float> continuation_ratio;
  // Positions of the hits on the radiosity mesh; empty until RadiosityLight::places fills them.
  std::vector<RadiosityPlace> places;
  const ViewingRays* viewing = nullptr;  // rays of the batch; null for sensors

  size_t size() const { return walks.size(); }
  const Bsdf& bsdf(size_t i) const { return scatterings.empty() ? bsdfs[i] : scatterings[i].whole; }
  // Appends hit i of another wave of the same method.
  void take(const WaveHits& other, size_t i) {
    walks.push_back(other.walks[i]);
    if (!other.hits.empty()) hits.push_back(other.hits[i]);
    vertices.push_back(other.vertices[i]);
    if (!other.bsdfs.empty()) bsdfs.push_back(other.bsdfs[i]);
    if (!other.scatterings.empty()) scatterings.push_back(other.scatterings[i]);
    if (!other.continuation_ratio.empty())
      continuation_ratio.push_back(other.continuation_ratio[i]);
  }
  void clear() {
    walks.clear();
    hits.clear();
    vertices.clear();
    bsdfs.clear();
    scatterings.clear();
    continuation_ratio.clear();
    places.clear();
    viewing = nullptr;
  }
};

// True if light from sources at the walk's vertex counts as direct: at the first surface, seen
// directly or by way of mirrors and clear glass.
inline bool is_direct_at(const Walk& walk) {
  return walk.scatterings == 0;
}

// Emission that walks have hit, on surfaces or at infinity.
struct SeenEmission {
  std::vector<const Walk*> walks;
  std::vector<const Vertex*> vertices;  // vertex of the hit; null if the ray has left the scene
  std::vector<Rgb> radiance;
  std::vector<uint32_t> at_infinity;  // light primitive, if the ray has left the scene
  // MIS weight against the sampling of sources at the previous vertex; set by DirectLight::weigh
  std::vector<float> weights;

  size_t size() const { return walks.size(); }
  void clear() {
    walks.clear();
    vertices.clear();
    radiance.clear();
    at_infinity.clear();
    weights.clear();
  }
  void add(const Walk& walk, const Vertex* vertex, Rgb emitted, uint32_t light_at_infinity = 0) {
    walks.push_back(&walk);
    vertices.push_back(vertex);
    radiance.push_back(emitted);
    at_infinity.push_back(light_at_infinity);
    weights.push_back(1);
  }
};

}  // namespace troffer
