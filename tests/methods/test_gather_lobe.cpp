// Gather rays that are drawn by the lobe of their place: the same mean, and less noise.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "certified/light_groups.h"
#include "gather/gather_lobe.h"
#include "support/light_scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

struct Gloss {
  PreparedScene scene;  // owns the tables that `specular` points into
  Bsdf specular;
  explicit Gloss(const Material& m) : scene(scene_of(m)) {
    specular = specular_part(make_bsdf(scene.bsdf_tables, {m}, {}, 0, {}, true));
  }
  static Scene scene_of(const Material& m) {
    Scene s;
    add_quad(s, add_material(s, m), {Vec3{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    return s;
  }
};

Material material_of(MaterialKind kind, float alpha) {
  Material m;
  m.kind = kind;
  m.is_reflectance = true;
  m.base_color.value = Rgb{0.5f};
  m.roughness.value = alpha;
  m.roughness_meaning = RoughnessMeaning::alpha;
  return m;
}

struct Rays {
  double mean = 0, variance = 0, gloss = 0, gloss_variance = 0, heaviest = 0;
};

// Traces rays from one place under a sky that is brighter on one side, and returns what either part
// gets.
Rays gather(const GatherLobe& lobe, size_t n, uint64_t seed) {
  const Vec3 normal = normalize(Vec3{0.2f, -0.4f, 1});
  const CellHit at{{0, 0, 0}, normal, normal, 1e-5f};
  Random random(seed);
  Rays r;
  double squares = 0, gloss_squares = 0;
  for (size_t i = 0; i < n; ++i) {
    float weight = 0;
    const Vec2 number{random.next_float(), random.next_float()};
    const Vec3 d = lobe.direction(GatherDistribution(), at, number, random.next_float(), weight);
    if (!(weight > 0)) continue;
    const float light = weight * (d.x > 0 ? 3.0f : 1.0f);
    const float shown = light * luminance(lobe.share_of(d));
    r.mean += double(light);
    r.gloss += double(shown);
    squares += sqr(double(light));
    gloss_squares += sqr(double(shown));
    r.heaviest = std::max(r.heaviest, double(weight * luminance(lobe.share_of(d))));
  }
  const auto count = double(n);
  r.mean /= count;
  r.gloss /= count;
  r.variance = squares / count - sqr(r.mean);
  r.gloss_variance = gloss_squares / count - sqr(r.gloss);
  return r;
}

}  // namespace

TEST_CASE("lobe-distributed rays: same mean as cosine-distributed rays, and less noise in gloss") {
  constexpr size_t rays = 200'000;
  const Vec3 normal = normalize(Vec3{0.2f, -0.4f, 1});
  for (const MaterialKind kind : {MaterialKind::conductor, MaterialKind::metallic_roughness})
    for (const float alpha : {0.2f, 0.4f})
      for (const float cosine : {0.1f, 0.5f}) {
        const Gloss surface(material_of(kind, alpha));
        const Bsdf& gloss = surface.specular;
        const Vec3 wo{std::sqrt(1 - sqr(cosine)), 0, cosine};
        // One lobe as strong as the rest, and one with so little gloss that no ray is drawn by it.
        const GatherLobe mixed(gloss, normal, wo, 0.5f, 0.5f);
        const GatherLobe by_cosine(gloss, normal, wo, 1, 1e-6f);
        REQUIRE(by_cosine.by_lobe() == 0);
        const Rays a = gather(mixed, rays, 1), b = gather(by_cosine, rays, 2);
        CAPTURE(alpha);
        CAPTURE(cosine);
        CAPTURE(mixed.by_lobe());
        const auto error = [&](double u, double v) { return std::sqrt((u + v) / double(rays)); };
        CHECK(std::abs(a.mean - b.mean) < 4.5 * error(a.variance, b.variance));
        CHECK(std::abs(a.gloss - b.gloss) < 4.5 * error(a.gloss_variance, b.gloss_variance));
        CHECK(mixed.by_lobe() <= GatherLobe::most_by_lobe);
        REQUIRE(mixed.by_lobe() > 0);
        // The lobe's share of rays bounds what a ray shows in gloss.
        CHECK(a.heaviest < 1.3 / double(mixed.by_lobe()));
        CHECK(a.gloss_variance < b.gloss_variance);
        // The share of other rays bounds what it brings to the matte part.
        CHECK(a.variance + sqr(a.mean) <
              1.05 * (b.variance + sqr(b.mean)) / (1 - double(mixed.by_lobe())));
      }
}

TEST_CASE("lobe-distributed rays: most where gloss is narrow, seen from the side, and strong") {
  const Vec3 normal{0, 0, 1};
  const auto share = [&](float alpha, float cosine, float matte, float gloss) {
    const Vec3 wo{std::sqrt(1 - sqr(cosine)), 0, cosine};
    const Gloss surface(material_of(MaterialKind::conductor, alpha));
    return GatherLobe(surface.specular, normal, wo, matte, gloss).by_lobe();
  };
  CHECK(share(0.25f, 0.1f, 0.3f, 0.1f) > share(0.25f, 0.6f, 0.3f, 0.1f));
  CHECK(share(0.25f, 0.1f, 0.3f, 0.1f) > share(0.6f, 0.1f, 0.3f, 0.1f));
  CHECK(share(0.25f, 0.1f, 0.3f, 0.1f) > share(0.25f, 0.1f, 0.3f, 0.03f));
  CHECK(share(0.25f, 1, 0.6f, 0.03f) == 0);
  CHECK(share(0.25f, 0.1f, 0, 0.5f) == GatherLobe::most_by_lobe);
  CHECK(share(0.25f, 0.1f, 0.5f, 0) == 0);
}

TEST_CASE("the estimated light of all lights together is about the sum of the single estimates") {
  Scene s;
  const uint32_t black = add_diffuse(s, Rgb{0});
  for (int i = 0; i < 30; ++i)
    for (int j = 0; j < 30; ++j) {
      const Vec3 c{float(i) * 0.4f, float(j) * 0.4f, 2.5f + 0.1f * float((i * 7 + j * 3) % 5)};
      add_mesh_light(s, black,
                     {c, c + Vec3{0, 0.1f, 0}, c + Vec3{0.1f, 0.1f, 0}, c + Vec3{0.1f, 0, 0}},
                     {{0, 1, 2}, {0, 2, 3}}, Rgb{float(1 + (i + j) % 4)}, false);
    }
  const PreparedScene scene(std::move(s));
  LightGroups groups;
  for (uint32_t p = 0; p < scene.primitives.size(); ++p)
    groups.add(scene.primitives, std::vector<uint32_t>{p}, p, p + 1);
  groups.finish();
  REQUIRE(groups.size() >= 900);
  std::vector<float> each, near;
  for (const Vec3& x : {Vec3{1, 1, 0}, Vec3{6, 6, 0.8f}, Vec3{11, 2, 2}, Vec3{-3, 6, 1}})
    for (const Vec3& n : {Vec3{0, 0, 1}, normalize(Vec3{1, 0.2f, 0.1f})}) {
      groups.estimate({x, 0, n, 0}, each, near);
      double sum = 0;
      for (const float e : each) sum += double(e);
      CAPTURE(x.x);
      CAPTURE(n.z);
      CHECK(double(groups.all_light(x, n)) > sum / 6);
      CHECK(double(groups.all_light(x, n)) < 6 * sum);
    }
  // Behind all of them none shines.
  CHECK(groups.all_light({6, 6, 5}, {0, 0, -1}) < 1e-3f * groups.all_light({6, 6, 0}, {0, 0, 1}));
}
