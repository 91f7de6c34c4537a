// StagedDirect: which of its two DirectLights computes what.
#include "certified/staged_direct.h"

#include <doctest/doctest.h>

using namespace troffer;

namespace {

// A DirectLight that adds `value` for every hit and returns it as weight.
class Marking final : public DirectLight {
 public:
  explicit Marking(float value) : value_(value) {}
  std::unique_ptr<DirectLightScratch> make_scratch() const override {
    return std::make_unique<DirectLightScratch>();
  }
  WalkedPart walked_part() const override { return WalkedPart::specular; }
  void queue(WaveHits& wave, DirectLightScratch&, RadianceBatch& out, Counters&) const override {
    CHECK(wave.vertices.size() == wave.size());
    for (const Walk& w : wave.walks) out.direct[w.index] += Rgb{value_};
  }
  void flush(DirectLightScratch&, RadianceBatch& out, Counters&) const override {
    out.indirect[0] += Rgb{value_};
  }
  void weigh(SeenEmission& seen) const override {
    for (float& w : seen.weights) w = value_;
  }

 private:
  float value_;
};

constexpr uint32_t first_samples = 4;

StagedDirect one_then_two() {
  return {std::make_unique<Marking>(1.0f), std::make_unique<Marking>(2.0f), first_samples};
}

}  // namespace

TEST_CASE("staged direct light: first hits use the first integrator, hits after gloss the second") {
  const StagedDirect direct = one_then_two();
  const auto scratch = direct.make_scratch();
  Counters counters;
  for (const std::vector<uint32_t>& scatterings :
       {std::vector<uint32_t>{0, 0}, {1, 2}, {0, 1, 0, 3}}) {
    WaveHits wave;
    RadianceBatch out;
    out.reset(scatterings.size());
    for (uint32_t i = 0; i < scatterings.size(); ++i) {
      Walk& w = wave.walks.emplace_back();
      w.index = i;
      w.scatterings = scatterings[i];
    }
    wave.vertices.resize(scatterings.size());
    direct.begin({}, *scratch);
    direct.queue(wave, *scratch, out, counters);
    direct.flush(*scratch, out, counters);
    for (size_t i = 0; i < scatterings.size(); ++i)
      CHECK(out.direct[i] == Rgb{scatterings[i] == 0 ? 1.0f : 2.0f});
    CHECK(out.indirect[0] == Rgb{3});
  }
}

TEST_CASE("staged direct light: further samples of a pixel use the second integrator") {
  const StagedDirect direct = one_then_two();
  const auto scratch = direct.make_scratch();
  Counters counters;
  WaveHits wave;
  RadianceBatch out;
  out.reset(3);
  std::vector<Walk> walks(3);
  SeenEmission seen;
  for (uint32_t i = 0; i < 3; ++i) {
    walks[i].index = i;
    walks[i].sample = first_samples - 1 + i;
    walks[i].scatterings = i < 2 ? 0 : 1;
    wave.walks.push_back(walks[i]);
    seen.add(walks[i], nullptr, Rgb{1});
  }
  wave.vertices.resize(3);
  direct.queue(wave, *scratch, out, counters);
  CHECK(out.direct == std::vector<Rgb>{Rgb{1}, Rgb{2}, Rgb{2}});
  direct.weigh(seen);
  CHECK(seen.weights == std::vector<float>{1, 2, 2});
}

TEST_CASE(
    "staged direct light: emission is weighted against the light samples of the previous vertex") {
  const StagedDirect direct = one_then_two();
  std::vector<Walk> walks(4);
  SeenEmission seen;
  for (uint32_t i = 0; i < 4; ++i) {
    walks[i].scatterings = i;
    seen.add(walks[i], nullptr, Rgb{1});
  }
  direct.weigh(seen);
  CHECK(seen.weights == std::vector<float>{1, 1, 2, 2});
}
