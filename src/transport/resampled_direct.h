// Direct light of paths under a few rectangular lights, by one shadow ray per hit: resampled
// importance sampling [1]. A point is sampled on every light, its unoccluded light is computed, and
// one point is picked in proportion. The power heuristic combines this with the path's own
// direction. Works in stages over arrays.
//
// The points of all lights form one estimate of the direct light. Each is weighted against the
// path's own direction as if it had a shadow ray of its own. One term then stands for the sum, so
// the estimate is unbiased whatever the quality of the prediction.
//
// References: [1] Talbot, Cline & Egbert, "Importance Resampling for Global Illumination", EGSR
//   2005.
#pragma once

#include <cstdint>
#include <vector>

#include "light/light.h"
#include "transport/wave.h"

namespace troffer {

// Arrays over the hits that take part, unless said otherwise.
struct ResampledDirectScratch {
  ShadowBatch shadows;
  std::vector<uint32_t> hits;  // index within the wave
  std::vector<uint64_t> streams;
  std::vector<uint32_t> samples;
  std::vector<float> numbers;  // two for the point on every light, one for picking
  std::vector<Vec3> positions;
  std::vector<float> x, y, z, shading_x, shading_y, shading_z, normal_x, normal_y, normal_z;
  std::vector<float> both_sides;  // 1 if light from behind counts as well, else 0
  std::vector<float> own_pdf;     // density of the path's own direction / its cosine; 0: unknown
  std::vector<float> cosine, inverse_pdf;
  // unoccluded light, for all hits of light 0, then of light 1, and so on
  std::vector<float> promises;
  // The picked light, the numbers for its point, and the factor on its light.
  std::vector<uint32_t> picked;
  std::vector<float> picked_u, picked_v, scales;
  std::vector<LightSample> points;
  std::vector<uint8_t> is_valid;
  LightSampleScratch light_samples;

  void resize(size_t n);
};

// Immutable and thread-safe; each thread needs its own scratch.
class ResampledDirect {
 public:
  explicit ResampledDirect(const PreparedScene& scene) : scene_(scene) {}

  // True if the scene's lights are two to eight rectangles, each of uniform radiance.
  static bool suits(const PreparedScene& scene);

  // Adds the light straight from sources at the hits of a wave to `out`, times the walks'
  // throughput, at the walks' indices. All hits must have the same number of vertices behind them.
  void add(const WaveHits& wave, ResampledDirectScratch& scratch, RadianceBatch& out,
           Counters& counters) const;
  // Returns the weight of emission that a walk has hit at v.
  float weight_of(const Walk& walk, const Vertex& v) const;

 private:
  void begin(const WaveHits& wave, ResampledDirectScratch& s) const;
  void ask(const WaveHits& wave, uint32_t light, ResampledDirectScratch& s) const;
  void pick(ResampledDirectScratch& s) const;
  void connect_picked(const WaveHits& wave, ResampledDirectScratch& s) const;

  const PreparedScene& scene_;
};

}  // namespace troffer
