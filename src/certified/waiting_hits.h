// The hits of a wave that wait for certified visibility, and the cluster of them that is being lit.
// Used by CertifiedLights.
#pragma once

#include <cstdint>
#include <vector>

#include "certified/source_integrand.h"
#include "shadow/certified_light.h"
#include "transport/walk.h"

namespace troffer {

// Hits that wait for light, as arrays of equal length (except glossy_hits).
struct WaitingHits {
  std::vector<ShadowReceiver> receivers;
  std::vector<Vec3> positions, horizons;  // those of the receivers, for clustering
  std::vector<Rgb> weights;               // throughput; times reflectance / pi at matte hits
  std::vector<uint32_t> indices;          // viewing rays of the hits
  std::vector<uint64_t> pixels;           // hash of the pixel
  std::vector<uint32_t> samples;          // sample number within the pixel
  std::vector<uint64_t> draw_streams;     // random streams for light sampling
  std::vector<int32_t> glossy;            // index into glossy_hits, or -1: matte
  std::vector<uint8_t> is_direct;         // 1: the light counts as direct
  std::vector<uint8_t> is_first;          // 1: first surface of the viewing ray
  std::vector<GlossyHit> glossy_hits;

  size_t size() const { return receivers.size(); }
  void clear();
  // Adds a hit at v. direct: its light counts as direct light.
  void add_matte(const Walk& walk, const Vertex& v, Rgb reflectance, bool direct);
  void add_glossy(const Walk& walk, const Vertex& v, const SurfaceScattering& scattering,
                  const NominalSourceDensity& competition, bool direct);

 private:
  void add(const Walk& walk, const Vertex& v, const Rgb& weight, bool direct);
};

// Counts the answer for a pair of hit and source, and its rays.
inline void count_answer(const SourceVisibility& a, Counters& counters) {
  counters.shadow_rays += a.rays;
  counters.lit_certified += a.answer == ShadowAnswer::lit ? 1 : 0;
  counters.dark_certified += a.answer == ShadowAnswer::dark ? 1 : 0;
  counters.masked += a.answer == ShadowAnswer::masked ? 1 : 0;
  counters.mixed += a.answer == ShadowAnswer::mixed ? 1 : 0;
}

// The current cluster in the form that certified_light() takes, and its scratch memory.
struct CertifiedCluster {
  std::vector<ShadowReceiver> receivers;
  ShadowCluster shadow;  // the receivers, as the shadow algorithms see them
  std::vector<LightRequest> requests;
  CertifiedMemory memory;
};

}  // namespace troffer
