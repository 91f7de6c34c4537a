// Direct light by one shadow ray from each hit: to a light that the light tree picks, and a point
// of it nearly in proportion to solid angle; combined with the walk's own sample by the power
// heuristic. Next-event estimation, as path tracing wants it: stages over arrays.
#pragma once

#include <cstdint>
#include <vector>

#include "integrate/direct_light.h"
#include "light/light.h"
#include "select/light_tree.h"

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
  // No walk goes on from the hits by their own scattering and counts what it runs into: all light
  // is this one's, whatever the surface.
  bool is_alone = false;

  void resize(size_t n);
};

class LightTreeDirect final : public DirectLight {
 public:
  // has_matte_walks: walks leave Lambertian surfaces too, as paths do, and compete there.
  explicit LightTreeDirect(const PreparedScene& scene, bool has_matte_walks = false)
      : scene_(scene), has_matte_walks_(has_matte_walks) {}

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
  size_t choose_lights(const WaveHits& wave, LightTreeDirectScratch& s) const;

  const PreparedScene& scene_;
  bool has_matte_walks_;
};

}  // namespace troffer
