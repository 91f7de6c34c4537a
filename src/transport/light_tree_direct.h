// Direct light by one shadow ray from each hit: to a light that the light tree picks, and a point
// of it nearly in proportion to solid angle; combined with the walk's own sample by the power
// heuristic. Next-event estimation, as path tracing wants it: stages over arrays.
#pragma once

#include <cstdint>
#include <vector>

#include "light/light.h"
#include "select/light_tree.h"
#include "transport/direct_light.h"

namespace troffer {

struct LightTreeDirectScratch final : DirectLightScratch {
  ShadowBatch shadows;
  std::vector<uint64_t> streams;
  std::vector<uint32_t> samples;
  std::vector<float> numbers;
  // The hits that take part, and the point that each is to be connected with.
  std::vector<uint32_t> lit, primitives;
  LightReceivers receivers;
  std::vector<LightChoice> choices;
  std::vector<float> tree_scratch;
  std::vector<Vec3> points_lit;
  std::vector<float> light_u, light_v, light_pmf;
  std::vector<LightSample> points;
  std::vector<uint8_t> is_valid;
  LightSampleScratch light_samples;

  void resize(size_t n);
};

class LightTreeDirect final : public DirectLight {
 public:
  // Where walks go on from the hits by the surface's own scattering and count the emission they run
  // into: from surfaces that are not Lambertian; from all of them, as paths do; from none, so that
  // all light is this one's.
  enum class Competition { glossy, all, none };
  explicit LightTreeDirect(const PreparedScene& scene,
                           Competition competition = Competition::glossy)
      : scene_(scene), competition_(competition) {}

  std::unique_ptr<DirectLightScratch> make_scratch() const override;
  WalkedPart walked_part() const override { return WalkedPart::whole; }
  // Hits of one wave: all with the same number of vertices behind them.
  void queue(WaveHits& wave, DirectLightScratch& scratch, RadianceBatch& out,
             Counters& counters) const override;
  void flush(DirectLightScratch& scratch, RadianceBatch& out, Counters& counters) const override;
  void weigh(SeenEmission& seen) const override;
  // Of emission that a walk has run into at v.
  float weight_of(const Walk& walk, const Vertex& v) const;
  // Of a light at infinity, seen by a walk that has left the scene.
  float weight_of_miss(const Walk& walk, uint32_t primitive) const;

 private:
  bool has_competition(const Bsdf& bsdf) const;
  size_t choose_lights(const WaveHits& wave, LightTreeDirectScratch& s) const;

  const PreparedScene& scene_;
  Competition competition_;
};

}  // namespace troffer
