// Light straight from sources at what gather rays meet where there is no cell.
#include "integrate/gather_walks.h"

#include <doctest/doctest.h>

#include "base/random.h"
#include "base/units.h"
#include "support/light_scenes.h"
#include "support/scenes.h"
#include "support/surfaceless_lights.h"
#include "support/textures.h"

using namespace troffer;
using namespace troffer::test;

// What is kept of a coat is ∫ L cos g / ḡ, ḡ the mean of g by the cosine: under an even sky of
// radiance 1 it is π, as without a coat. Nothing competes with the draws, for walks that go on from
// here count no light.
TEST_CASE("draws of sources bring coated surfaces all of their light") {
  for (const bool is_coated : {false, true}) {
    CAPTURE(is_coated);
    Scene s;
    Material m;
    m.kind = is_coated ? MaterialKind::coated_diffuse : MaterialKind::diffuse;
    m.base_color.value = Rgb{0.6f};
    m.roughness.value = 0.4f;
    const uint32_t material = add_material(s, m);
    add_quad(s, material, {Vec3{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
    add_light(s, LightKind::environment, Rgb{1});
    const PreparedScene scene(std::move(s));
    const GatherWalks walks(scene, nullptr);
    constexpr uint32_t draws = 1 << 14;
    std::vector<GatherArrival> arrivals(draws);
    for (uint32_t k = 0; k < draws; ++k) {
      arrivals[k].walk.sample = k;
      arrivals[k].hit = {{0, 0, 0}, {0, 0, 1}, {0, 0, 1}, 1e-5f};
      if (is_coated) arrivals[k].hit.coated = 2 * material;
    }
    GatherScratch scratch;
    scratch.light.reset(1);
    Counters counters;
    walks.light_up(arrivals, scratch, counters);
    const Rgb sum = scratch.light.direct[0] + scratch.light.indirect[0];
    CHECK(double(luminance(sum)) / draws * pi == doctest::Approx(pi).epsilon(0.01));
  }
}

// Images hold what other surfaces show beside what this one does, or nothing. A floor of small
// tiles, each of which shows the white middle of an image that is black around it.
TEST_CASE("gather rays see no texels that their surface does not show") {
  Scene s;
  s.textures.push_back(grey_image(
      64, 64, [](int x, int y) { return x >= 16 && x < 48 && y >= 16 && y < 48 ? 0.8f : 0.0f; }));
  Material m;
  m.base_color.value = Rgb{1};
  m.base_color.texture = 0;
  const uint32_t material = add_material(s, m);
  for (int i = -20; i < 20; ++i)
    for (int j = -20; j < 20; ++j) {
      const float x = 0.1f * float(i), y = 0.1f * float(j);
      add_quad(s, material,
               {Vec3{x, y, 0}, {x + 0.1f, y, 0}, {x + 0.1f, y + 0.1f, 0}, {x, y + 0.1f, 0}});
      s.meshes.back().uvs = {{0.3f, 0.3f}, {0.7f, 0.3f}, {0.7f, 0.7f}, {0.3f, 0.7f}};
    }
  const PreparedScene scene(std::move(s));
  const GatherWalks walks(scene, nullptr);
  GatherScratch scratch;
  for (uint32_t k = 0; k < 256; ++k) {
    Walk& walk = scratch.walks.emplace_back();
    walk.index = walk.sample = k;
    walks.leave({{0, 0, 1}, {0, 0, -1}, {0, 0, -1}, 1e-5f}, direction_number(walk), walk);
  }
  Counters counters;
  walks.follow(256, Coherence::none, scratch, counters);
  CHECK(scratch.arrivals.size() > 100);
  for (const GatherArrival& a : scratch.arrivals)
    CHECK(double(a.walk.throughput.g) == doctest::Approx(0.8).epsilon(0.001));
}
