// Scaled lights: every kind of emission scales, and nothing else changes.
#include <doctest/doctest.h>

#include <vector>

#include "scene/scaled_lights.h"

using namespace troffer;

TEST_CASE("lights are scaled channel by channel, the ground of a sky too") {
  Scene s;
  s.lights.resize(2);
  s.lights[0].radiance = {1, 2, 3};
  s.lights[1].kind = LightKind::sky;
  s.lights[1].radiance = {4, 4, 4};
  s.lights[1].sky.ground = {8, 8, 8};
  const Scene scaled = with_scaled_lights(s, std::vector<Rgb>{{0.5f, 1, 2}, Rgb{0.25f}});
  REQUIRE(scaled.lights.size() == 2);
  CHECK(scaled.lights[0].radiance == Rgb{0.5f, 2, 6});
  CHECK(scaled.lights[1].radiance == Rgb{1});
  CHECK(scaled.lights[1].sky.ground == Rgb{2});
  CHECK(scaled.lights[1].kind == LightKind::sky);
  // Light numbers stay when one is turned off, because geometry refers to them.
  CHECK(with_scaled_lights(s, std::vector<Rgb>{Rgb{0}, Rgb{1}}).lights.size() == 2);
}
