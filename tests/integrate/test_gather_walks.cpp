// Light straight from sources at what gather rays meet where there is no cell.
#include "integrate/gather_walks.h"

#include <doctest/doctest.h>

#include "base/units.h"
#include "support/light_scenes.h"
#include "support/surfaceless_lights.h"

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
