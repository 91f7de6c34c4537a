// Wide gloss is gathered and fitted together with matte light, and the error estimate includes
// gloss.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "render/pictures.h"
#include "support/light_scenes.h"
#include "support/surfaceless_lights.h"

using namespace troffer;
using namespace troffer::test;

namespace {

Material coated(float reflectance, float roughness) {
  Material m;
  m.kind = MaterialKind::metallic_roughness;
  m.base_color.value = Rgb{reflectance};
  m.roughness.value = roughness;
  m.roughness_meaning = RoughnessMeaning::alpha;
  return m;
}
Material metal(float reflectance, float roughness) {
  Material m;
  m.kind = MaterialKind::conductor;
  m.is_reflectance = true;
  m.base_color.value = Rgb{reflectance};
  m.roughness.value = roughness;
  m.roughness_meaning = RoughnessMeaning::alpha;
  return m;
}

// A bright patch on the floor of a room illuminates everything else.
Scene room_with_patch(const Material& walls) {
  Scene s;
  add_box_inside(s, add_material(s, walls), {-2, -2, 0}, {2, 2, 2.5f});
  add_spot(s, {1, 0.5f, 2.4f}, {0, 0, -1}, 0.995f, 0.99f, Rgb{100});
  return s;
}

RenderOptions picture(int width, double error) {
  RenderOptions o;
  o.width = width;
  o.height = width * 3 / 4;
  o.threads = 2;
  o.error = error;
  o.aovs = {Aov::indirect, Aov::error};
  return o;
}

// Counts the pixels far brighter than the median of their neighbours.
size_t specks(const Image& image) {
  size_t count = 0;
  for (int y = 2; y < image.height - 2; ++y)
    for (int x = 2; x < image.width - 2; ++x) {
      std::vector<float> around;
      for (int j = -2; j <= 2; ++j)
        for (int i = -2; i <= 2; ++i)
          around.push_back(luminance(image.pixels[size_t((y + j) * image.width + x + i)]));
      const float own = around[12];
      std::nth_element(around.begin(), around.begin() + 12, around.end());
      count += own > 1.4f * around[12] ? 1 : 0;
    }
  return count;
}

}  // namespace

TEST_CASE("gathered gloss: no bright specks if a small patch lights a room") {
  const PreparedScene scene(room_with_patch(coated(0.7f, 1)));
  size_t sum = 0;
  for (uint64_t seed = 0; seed < 4; ++seed) {
    RenderOptions o = picture(64, 0.05);
    o.seed = seed;
    const RenderResult r = render_now(scene, mixed_room_camera(), o);
    sum += specks(r.layers[1].image);
  }
  CHECK(sum <= 20);
}

TEST_CASE("gathered gloss: agrees with paths for any width") {
  for (const Material& m :
       {coated(0.5f, 1), coated(0.1f, 0.4f), metal(0.8f, 0.7f), metal(0.8f, 0.25f)}) {
    Scene s;
    add_box_inside(s, add_diffuse(s, Rgb{0.6f, 0.5f, 0.4f}), {-2, -2, 0}, {2, 2, 2.5f});
    add_quad(
        s, add_material(s, m),
        {Vec3{-1.5f, -1.5f, 0.3f}, {1.5f, -1.5f, 0.3f}, {1.5f, 1.5f, 0.3f}, {-1.5f, 1.5f, 0.3f}});
    s.spheres.push_back(
        {{0.4f, 0.5f, 0.9f}, 0.5f, false, uint32_t(s.materials.size() - 1), no_light});
    add_ceiling_light(s, 1, 2.4f, Rgb{10});
    const PreparedScene scene(std::move(s));
    RenderOptions o = picture(32, 0.02);
    o.max_spp = 64;
    const Ensemble mine = render_ensemble(scene, mixed_room_camera(), o, 2);
    o.method = Method::path;
    o.spp = 256;
    const Ensemble paths = render_ensemble(scene, mixed_room_camera(), o, 4);
    CAPTURE(m.roughness.value);
    CAPTURE(paths.mean.standard_error() / paths.mean.mean());
    CHECK(mine.mean.mean() == doctest::Approx(paths.mean.mean()).epsilon(0.005));
  }
}

// Rays of the lobe look for lamps there, in competition with points sampled on lamps.
TEST_CASE("gathered gloss: agrees with paths at grazing view under lamps") {
  for (const int lamps : {6, 2}) {
    Scene s;
    const Material gloss = lamps == 6 ? coated(0.2f, 0.22f) : metal(0.6f, 0.3f);
    const uint32_t board = add_material(s, gloss), black = add_diffuse(s, Rgb{0});
    add_box_inside(s, add_diffuse(s, Rgb{0.5f}), {-3, -3, 0}, {3, 3, 2.5f});
    for (int i = 0; i < 4; ++i) {
      const float y = -2.2f + 1.2f * float(i), z = 0.8f + 0.05f * float(i);
      add_quad(s, board, {Vec3{-2.5f, y, z}, {2.5f, y, z}, {2.5f, y + 1, z}, {-2.5f, y + 1, z}});
    }
    for (int j = 0; j < lamps; ++j)
      for (int i = 0; i < lamps; ++i) {
        const float apart = 6 / float(lamps);
        const Vec3 c{(float(i) + 0.4f) * apart - 3, (float(j) + 0.4f) * apart - 3, 2.45f};
        make_light(
            s,
            add_quad(s, black,
                     {c, c + Vec3{0, 0.2f, 0}, c + Vec3{0.2f, 0.2f, 0}, c + Vec3{0.2f, 0, 0}}),
            Rgb{12});
      }
    const PreparedScene scene(std::move(s));
    const Camera camera = look_at({0, -2.9f, 1.3f}, {0, 0, 0.7f}, {0, 0, 1}, 60);
    RenderOptions o = picture(32, 0.02);
    o.max_spp = 64;
    const Ensemble mine = render_ensemble(scene, camera, o, 2);
    o.method = Method::path;
    o.spp = 256;
    const Ensemble paths = render_ensemble(scene, camera, o, 4);
    CAPTURE(lamps);
    CAPTURE(paths.mean.standard_error() / paths.mean.mean());
    CHECK(mine.mean.mean() == doctest::Approx(paths.mean.mean()).epsilon(0.004));
  }
}

TEST_CASE("the estimated error includes the noise of gloss") {
  Scene s;
  add_box_inside(s, add_diffuse(s, Rgb{0.6f}), {-2, -2, 0}, {2, 2, 2.5f});
  add_quad(s, add_material(s, metal(0.9f, 0.1f)),
           {Vec3{-2, -2, 0.01f}, {2, -2, 0.01f}, {2, 2, 0.01f}, {-2, 2, 0.01f}});
  add_spot(s, {1, 0.5f, 0.5f}, {0, 0, 1}, 0.995f, 0.99f, Rgb{100});
  const PreparedScene scene(std::move(s));
  RenderOptions o = picture(32, 0.05);
  o.max_spp = 4;
  const RenderResult mine = render_now(scene, mixed_room_camera(), o);
  o.spp = o.max_spp = 256;
  o.error = 0.01;
  o.seed = 5;
  const RenderResult better = render_now(scene, mixed_room_camera(), o);
  double made = 0, told = 0;
  for (size_t i = 0; i < mine.layers[0].image.pixels.size(); ++i) {
    made += sqr(double(luminance(mine.layers[0].image.pixels[i])) -
                double(luminance(better.layers[0].image.pixels[i])));
    told += sqr(double(mine.layers[2].image.pixels[i].r));
  }
  CAPTURE(std::sqrt(made));
  CAPTURE(std::sqrt(told));
  CHECK(told > sqr(0.7) * made);
  CHECK(told < sqr(2.0) * made);
}
