// Direct light where gather rays meet surfaces without a cell.
#include "gather/gather_walks.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "gather/cells.h"
#include "support/light_scenes.h"
#include "support/scenes.h"
#include "support/surfaceless_lights.h"
#include "support/textures.h"

using namespace troffer;
using namespace troffer::test;

// A coated place keeps ∫ L cos g / ḡ, with ḡ the cosine-weighted mean of g. Under a uniform sky of
// radiance 1 it is π, as without a coat. Light samples have no competition, because walks that go
// on from here do not count emission.
TEST_CASE("sampled sources give coated surfaces all of their light") {
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
    walks.sample_direct_light(arrivals, scratch, counters);
    const Rgb sum = scratch.light.direct[0] + scratch.light.indirect[0];
    CHECK(double(luminance(sum)) / draws * pi == doctest::Approx(pi).epsilon(0.01));
  }
}

namespace {

enum class Cover { none, clear_coat, smooth_clear_coat };

// Black surfaces with gloss all around the origin. Under a uniform sky of radiance 1 they send what
// they reflect. With a cover the gloss itself is black, too.
Scene black_gloss(float alpha, Cover cover) {
  Scene s;
  Material m;
  m.kind = MaterialKind::metallic_roughness;
  m.base_color.value = Rgb{0};
  m.roughness.value = alpha;
  if (cover != Cover::none) {
    m.specular.value = 0;
    m.coat.value = 1;
    m.coat_roughness.value = cover == Cover::clear_coat ? 0.3f : 0.0f;
  }
  const uint32_t material = add_material(s, m);
  add_quad(s, material, {Vec3{-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}});
  add_light(s, LightKind::environment, Rgb{1});
  return s;
}

struct Gathered {
  double mean = 0, sigma = 0;        // of what rays bring; sigma: standard error of the mean
  double went_on = 0, were_lit = 0;  // per ray: continued rays and light samples
};

// Traces rays that arrive at the origin at a cosine of .8.
Gathered gathered(const PreparedScene& scene, bool is_of_rows) {
  const GatherWalks walks(scene, nullptr);
  constexpr uint32_t rays = 1 << 17;
  GatherScratch scratch;
  scratch.is_of_rows = is_of_rows;
  for (uint32_t k = 0; k < rays; ++k) {
    Walk& walk = scratch.walks.emplace_back();
    walk.index = walk.sample = k;
    walk.stream = 5;
    set_out({{-0.75f, 0, 1}, {0, 0, -1}, {0, 0, -1}, 1e-5f}, Vec3{0.6f, 0, -0.8f}, walk);
  }
  Counters counters;
  walks.follow(rays, Coherence::none, scratch, counters);
  double sum = 0, squares = 0;
  for (uint32_t k = 0; k < rays; ++k) {
    const double x = double(luminance(scratch.light.direct[k] + scratch.light.indirect[k]));
    sum += x;
    squares += x * x;
  }
  Gathered g;
  g.mean = sum / rays;
  g.sigma = std::sqrt((squares / rays - sqr(g.mean)) / rays);
  g.went_on = double(counters.extension_rays) / rays - 1;
  g.were_lit = double(counters.shadow_rays) / rays;
  return g;
}

}  // namespace

// Roulette sends a light sample and a continued ray only sometimes. Rays of cells continue more
// often, and so do those of narrow gloss.
TEST_CASE("gather rays include the light of gloss, although few continue from it") {
  for (const float alpha : {0.01f, 0.1f, 0.25f, 0.5f, 0.9f})
    for (const bool is_of_rows : {false, true}) {
      CAPTURE(alpha);
      CAPTURE(is_of_rows);
      const PreparedScene scene(black_gloss(alpha, Cover::none));
      const SurfaceScattering* gloss = scene.uniform_bsdfs.find(0, true);
      REQUIRE(gloss != nullptr);
      const double all = double(luminance(albedo(gloss->specular, 0.8f)));
      REQUIRE(all > 0.01);
      const Gathered g = gathered(scene, is_of_rows);
      CHECK(std::abs(g.mean - all) < 5 * g.sigma + 0.003 * all);
      const bool is_narrow = alpha < 0.2f;
      CHECK(g.went_on ==
            doctest::Approx(all / (is_of_rows || is_narrow ? 0.1 : 0.5)).epsilon(0.03));
      // Half of the light samples are below the floor.
      if (!is_narrow) CHECK(g.were_lit == doctest::Approx(0.5 * all / 0.25).epsilon(0.03));
    }
}

// albedo() does not cover clear coats, so roulette cannot be based on it.
TEST_CASE("gather rays include the light of a clear coat over black") {
  for (const Cover cover : {Cover::clear_coat, Cover::smooth_clear_coat}) {
    CAPTURE(int(cover));
    const PreparedScene scene(black_gloss(0.5f, cover));
    const SurfaceScattering* gloss = scene.uniform_bsdfs.find(0, true);
    REQUIRE(gloss != nullptr);
    double all = 0;
    constexpr uint32_t n = 1 << 16;
    for (uint32_t k = 0; k < n; ++k) {
      const SobolGroup numbers(3, 0, k);
      BsdfSample sampled;
      if (sample(gloss->specular, {0.6f, 0, 0.8f}, numbers.get(2), numbers.get2(0), sampled))
        all += double(luminance(sampled.weight)) / n;
    }
    REQUIRE(all > 0.03);
    const Gathered g = gathered(scene, false);
    CHECK(std::abs(g.mean - all) < 5 * g.sigma + 0.01 * all);
  }
}

// Images have texels for other surfaces, or for none. Here each small tile of a floor shows the
// white middle of an image that is black around it.
TEST_CASE("gather rays see no texels outside of their surface's part of an image") {
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

// The result does not depend on how many rays there are. Some rays carry nothing and are not
// followed.
TEST_CASE("gather rays that are traced together see what each sees alone") {
  Scene s;
  Material m;
  m.base_color.value = Rgb{0.5f};
  const uint32_t material = add_material(s, m);
  add_quad(s, material, {Vec3{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}});
  const PreparedScene scene(std::move(s));
  const auto map = std::make_shared<CellMap>(scene.tracer, 0.5f);
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) {
      const Vec3 at{0.5f * float(i) - 4.75f, 0.5f * float(j) - 4.75f, 0};
      map->add({at, {0, 0, 1}, {0, 0, 1}, 1e-5f}, 5);
    }
  std::vector<Rgb> direct(map->size()), irradiance;
  for (size_t c = 0; c < map->size(); ++c) irradiance.push_back(Rgb{1 + float(c)});
  const Cells cells(scene, map, direct, irradiance, std::vector<float>(map->size(), 0.25f), {}, {},
                    nullptr, {});
  constexpr uint32_t rays = 1000;
  const auto walk_of = [&](uint32_t k) {
    Walk walk;
    walk.stream = 7;
    walk.sample = k;
    const Vec3 from{float(k % 97) / 10 - 4.83f, float(k % 89) / 10 - 4.41f, 5};
    set_out({from, {0, 0, -1}, {0, 0, -1}, 1e-5f}, Vec3{0, 0, -1}, walk);
    return walk;
  };
  const auto is_followed = [](uint32_t k) { return k % 7 != 3 && (k < 300 || k > 600); };
  CellsScratch all, one;
  Counters counters;
  for (uint32_t k = 0; k < rays; ++k) {
    if (!is_followed(k)) continue;
    all.walks.push_back(walk_of(k));
    all.walks.back().index = k;
  }
  cells.gather(rays, all, counters);
  REQUIRE(all.light.irradiance.size() == rays);
  for (uint32_t k = 0; k < rays; ++k) {
    CAPTURE(k);
    one.walks.clear();
    if (is_followed(k)) one.walks.push_back(walk_of(k));
    cells.gather(1, one, counters);
    CHECK(all.light.irradiance[k].g == one.light.irradiance[0].g);
    CHECK(all.light.half_difference[k] == one.light.half_difference[0]);
    CHECK(all.light.distance[k] == one.light.distance[0]);
    CHECK((one.light.irradiance[0].g >= 0.5f) == is_followed(k));
    CHECK(one.light.half_difference[0] == (is_followed(k) ? 0.125f : 0.0f));
    CHECK(double(one.light.distance[0]) == doctest::Approx(is_followed(k) ? 5 : 0));
  }
}

TEST_CASE("one arrival of a split walk can represent all of them") {
  std::array<double, 3> sums{};
  double alone = 0;
  constexpr uint32_t walks = 1 << 14;
  for (uint32_t k = 0; k < walks; ++k) {
    std::vector<GatherArrival> arrivals(5);
    const std::array<float, 3> carried{0.2f, 0, 0.5f};
    for (size_t i = 0; i < arrivals.size(); ++i) {
      GatherArrival& a = arrivals[i];
      a.walk.sample = k;
      a.walk.index = i < 3 ? 4 : uint32_t(i) + 4;  // of three walks
      a.walk.throughput = Rgb{i < 3 ? carried[i] : 0.3f};
      a.length = 2;
      a.distance = float(i);
    }
    keep_one_of_each(arrivals);
    REQUIRE(arrivals.size() == 3);
    CHECK(arrivals[0].distance < 3);
    sums[size_t(arrivals[0].distance)] += double(luminance(arrivals[0].walk.throughput)) / walks;
    alone += double(luminance(arrivals[1].walk.throughput)) / walks;
    CHECK(arrivals[1].walk.index == 7);
    CHECK(arrivals[2].walk.index == 8);
  }
  CHECK(sums[0] == doctest::Approx(0.2).epsilon(0.01));
  CHECK(sums[1] == 0);
  CHECK(sums[2] == doctest::Approx(0.5).epsilon(0.01));
  CHECK(alone == doctest::Approx(0.3).epsilon(1e-5));
  // Arrivals of the same walk at other lengths stay separate.
  std::vector<GatherArrival> apart(2);
  apart[1].length = 1;
  keep_one_of_each(apart);
  CHECK(apart.size() == 2);
  std::vector<GatherArrival> black(2);
  for (GatherArrival& a : black) a.walk.throughput = Rgb{0};
  keep_one_of_each(black);
  CHECK(black.empty());
}
