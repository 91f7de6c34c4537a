// Direct light of paths under a few rectangular lights: one shadow ray from each hit. A point is
// chosen on every light, asked what it would bring if nothing were in the way, and one of them is
// picked in proportion: resampled importance sampling [1]. Combined with the path's own direction
// by the power heuristic. Next-event estimation in stages over arrays.
//
// Every light's point is a term of an estimate of all direct light, weighed against the path's own
// direction as if it had a ray of its own; that one of the terms is picked, and stands for their
// sum, changes no mean, however well or badly was foretold what they bring.
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
  std::vector<uint32_t> hits;  // which of the wave
  std::vector<uint64_t> streams;
  std::vector<uint32_t> samples;
  std::vector<float> numbers;  // for the point on every light, first and second, and for picking
  std::vector<Vec3> positions;
  std::vector<float> x, y, z, shading_x, shading_y, shading_z, normal_x, normal_y, normal_z;
  std::vector<float> both_sides;  // 1 where light from behind counts as well, else 0
  std::vector<float> own_pdf;     // of the path's own direction, over its cosine; 0: not known
  std::vector<float> cosine, inverse_pdf;
  std::vector<float> promises;  // of the first light's points, then of the second's …
  // What is picked: the light, numbers for its point, and by what it is to be multiplied.
  std::vector<uint32_t> picked;
  std::vector<float> picked_u, picked_v, scales;
  std::vector<LightSample> points;
  std::vector<uint8_t> is_valid;
  LightSampleScratch light_samples;

  void resize(size_t n);
};

// Immutable; any number of threads may call it, each with a scratch of its own.
class ResampledDirect {
 public:
  explicit ResampledDirect(const PreparedScene& scene) : scene_(scene) {}

  // Whether it is for this scene: from two to eight rectangles, each of one radiance, are all its
  // lights.
  static bool suits(const PreparedScene& scene);

  // Adds to `out` what sources send straight to the hits of a wave, all with the same number of
  // vertices behind them, times the walks' throughput, at the walks' indices.
  void add(const WaveHits& wave, ResampledDirectScratch& scratch, RadianceBatch& out,
           Counters& counters) const;
  // The weight of emission that a walk has run into at v.
  float weight_of(const Walk& walk, const Vertex& v) const;

 private:
  void begin(const WaveHits& wave, ResampledDirectScratch& s) const;
  void ask(const WaveHits& wave, uint32_t light, ResampledDirectScratch& s) const;
  void pick(ResampledDirectScratch& s) const;
  void connect_picked(const WaveHits& wave, ResampledDirectScratch& s) const;

  const PreparedScene& scene_;
};

}  // namespace troffer
