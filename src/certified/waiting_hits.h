// Hits on their way through certified visibility: those that wait, the cluster of them that is lit
// at a time, and how its answers are counted.
#pragma once

#include <cstdint>
#include <vector>

#include "certified/source_integrand.h"
#include "shadow/certified_light.h"
#include "transport/walk.h"

namespace troffer {

// Hits that wait for light: plain arrays of one length.
struct WaitingHits {
  std::vector<ShadowReceiver> receivers;
  std::vector<Vec3> positions, horizons;  // of the receivers, as clustering wants them
  std::vector<Rgb> weights;               // throughput, times reflectance / pi of matte surfaces
  std::vector<uint32_t> indices;          // of the viewing rays
  std::vector<uint64_t> pixels;           // names of their pixels
  std::vector<uint32_t> samples;          // … and which of its viewing rays
  std::vector<uint64_t> draw_streams;     // of the random numbers that choose lights
  std::vector<int32_t> glossy;            // index into glossy_hits, or -1: matte
  std::vector<uint8_t> is_direct;         // the light counts as direct
  std::vector<uint8_t> is_first;          // the viewing ray's first surface
  std::vector<GlossyHit> glossy_hits;

  size_t size() const { return receivers.size(); }
  void clear();
  // A hit at v; the light counts as direct or not.
  void add_matte(const Walk& walk, const Vertex& v, Rgb reflectance, bool direct);
  void add_glossy(const Walk& walk, const Vertex& v, const SurfaceScattering& scattering,
                  const LobeCompetition& competition, bool direct);

 private:
  void add(const Walk& walk, const Vertex& v, const Rgb& weight, bool direct);
};

// A pair of hit and source, by how it was answered, and its rays.
inline void count_answer(const SourceVisibility& a, Counters& counters) {
  counters.shadow_rays += a.rays;
  counters.lit_certified += a.answer == ShadowAnswer::lit ? 1 : 0;
  counters.dark_certified += a.answer == ShadowAnswer::dark ? 1 : 0;
  counters.masked += a.answer == ShadowAnswer::masked ? 1 : 0;
  counters.mixed += a.answer == ShadowAnswer::mixed ? 1 : 0;
}

// The cluster at hand, as certified_light() takes it, and the memory that this works in.
struct CertifiedCluster {
  std::vector<ShadowReceiver> receivers;
  ShadowCluster shadow;  // of the receivers
  std::vector<LightRequest> requests;
  CertifiedMemory memory;
};

}  // namespace troffer
