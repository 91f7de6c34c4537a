// Next-event estimation with a light tree: one shadow ray per hit, or several at first hits. The
// tree picks a light, and a point on it is sampled nearly in proportion to solid angle. The power
// heuristic combines this with the walk's own direction. Used by path tracing, gather rays and the
// choice of mirror images. Works in stages over arrays.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "light/light.h"
#include "select/learned_lights.h"
#include "select/light_tree.h"
#include "transport/direct_light.h"

namespace troffer {

struct LightTreeDirectScratch final : DirectLightScratch {
  ShadowBatch shadows;
  std::vector<uint64_t> streams;
  std::vector<uint32_t> samples;
  std::vector<float> numbers;
  // Hit of each light sample.
  std::vector<uint32_t> hits;
  // Samples that have a light: their hits, and the point that each is connected with.
  std::vector<uint32_t> lit, primitives;
  std::vector<float> picked_u, picked_v;  // numbers for that point
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
  // Surfaces at which walks continue by BSDF sampling and count the emission that they hit: all but
  // Lambertian ones; all, as in path tracing; none. With none, shadow rays bring all light.
  enum class Competition { glossy, all, none };
  struct Options {
    Competition competition = Competition::glossy;
    // Light samples at the first surface that scatters, seen straight, in mirrors or through glass.
    // Other hits take one.
    uint32_t samples_at_first = 1;
    // Chooses the lights instead of the tree. Null: the tree alone.
    std::shared_ptr<const LearnedLights> learned = nullptr;
  };
  explicit LightTreeDirect(const PreparedScene& scene) : LightTreeDirect(scene, Options()) {}
  LightTreeDirect(const PreparedScene& scene, Options options)
      : scene_(scene), options_(std::move(options)) {}

  std::unique_ptr<DirectLightScratch> make_scratch() const override;
  WalkedPart walked_part() const override { return WalkedPart::whole; }
  // All hits of a wave must have the same number of vertices behind them.
  void queue(WaveHits& wave, DirectLightScratch& scratch, RadianceBatch& out,
             Counters& counters) const override;
  void flush(DirectLightScratch& scratch, RadianceBatch& out, Counters& counters) const override;
  void weigh(SeenEmission& seen) const override;
  // Returns the weight of emission that a walk has hit at v.
  float weight_of(const Walk& walk, const Vertex& v) const;
  // Returns the weight of a light at infinity that a walk sees as it leaves the scene.
  float weight_of_miss(const Walk& walk, uint32_t primitive) const;

 private:
  bool has_competition(const Bsdf& bsdf) const;
  // Returns the number of light samples at a hit from which a walk has scattered so many times.
  uint32_t samples_after(uint32_t scatterings) const {
    return scatterings == 0 ? options_.samples_at_first : 1;
  }
  // The same for the hit that the walk has left.
  float samples_before(const Walk& walk) const {
    return float(samples_after(walk.scatterings - 1));
  }
  void set_hits(const WaveHits& wave, LightTreeDirectScratch& s) const;
  void choose_points(LightTreeDirectScratch& s) const;
  size_t choose_lights(const WaveHits& wave, LightTreeDirectScratch& s) const;

  const PreparedScene& scene_;
  Options options_;
};

}  // namespace troffer
