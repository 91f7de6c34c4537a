// Hits of one wave of walks, as methods get them: those at which light is asked for, side by side.
#pragma once

#include <cstdint>
#include <vector>

#include "transport/batch.h"
#include "transport/radiosity_place.h"
#include "transport/surface_scattering.h"
#include "transport/walk.h"

namespace troffer {

// Plain arrays of one length, but for those that say when they are empty. A few dozen hits: what is
// known of them fits the caches.
struct WaveHits {
  std::vector<Walk> walks;  // that have arrived; notes may be left in them
  std::vector<Hit> hits;    // empty: sensors, which no ray has hit
  std::vector<Vertex> vertices;
  std::vector<Bsdf> bsdfs;                     // of methods that take surfaces whole, or
  std::vector<SurfaceScattering> scatterings;  // … of those that take them apart; else empty
  // How often walks go on from them, over how often lights are drawn for them; empty: as often.
  std::vector<float> going_on;
  // Where the hits lie on the radiosity mesh; empty until somebody asks (RadiosityLight::places).
  std::vector<RadiosityPlace> places;
  const ViewingRays* viewing = nullptr;  // of the batch; null: sensors

  size_t size() const { return walks.size(); }
  const Bsdf& bsdf(size_t i) const { return scatterings.empty() ? bsdfs[i] : scatterings[i].whole; }
  // Hit i of another wave of the same method.
  void take(const WaveHits& other, size_t i) {
    walks.push_back(other.walks[i]);
    if (!other.hits.empty()) hits.push_back(other.hits[i]);
    vertices.push_back(other.vertices[i]);
    if (!other.bsdfs.empty()) bsdfs.push_back(other.bsdfs[i]);
    if (!other.scatterings.empty()) scatterings.push_back(other.scatterings[i]);
    if (!other.going_on.empty()) going_on.push_back(other.going_on[i]);
  }
  void clear() {
    walks.clear();
    hits.clear();
    vertices.clear();
    bsdfs.clear();
    scatterings.clear();
    going_on.clear();
    places.clear();
    viewing = nullptr;
  }
};

// Light straight from sources counts as direct at the first surface, and at what mirrors and clear
// glass show.
inline bool is_direct_at(const Walk& walk) {
  return walk.scatterings == 0;
}

// What walks have run into: emission of a surface, or of what lies beyond the scene.
struct SeenEmission {
  std::vector<const Walk*> walks;
  std::vector<const Vertex*> vertices;  // where; null: the ray has left the scene
  std::vector<Rgb> radiance;
  std::vector<uint32_t> at_infinity;  // the light primitive, where the ray has left the scene
  std::vector<float> weights;  // to be set: against the sampling of sources from the vertex before

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
