// Sources whose material has an alpha mask: holes emit no light, whatever the sampling.
#include <doctest/doctest.h>

#include <cmath>

#include "light/irradiance.h"
#include "render/measure.h"
#include "support/scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// A mesh source [x0,1] × [-1,1] at height 1 that faces down, u = (x + 1) / 2.
Scene source_from(float x0) {
  Scene s;
  add_diffuse(s, Rgb{0});
  Mesh m;
  m.positions = {{x0, -1, 1}, {x0, 1, 1}, {1, 1, 1}, {1, -1, 1}};
  for (const Vec3& p : m.positions) m.uvs.push_back({(p.x + 1) / 2, (p.y + 1) / 2});
  m.triangles = {{0, 1, 2}, {0, 2, 3}};
  m.lights = {0, 0};
  s.meshes.push_back(m);
  Light e;
  e.name = "source";
  e.kind = LightKind::mesh;
  e.radiance = Rgb{3};
  e.triangles = {0, 1};
  s.lights.push_back(e);
  return s;
}

}  // namespace

TEST_CASE("a source with holes emits as much as its remaining area") {
  Scene s = source_from(-1);
  Texture mask;
  mask.kind = TextureKind::image;
  mask.width = 2;
  mask.height = mask.channels = 1;
  mask.is_srgb = mask.is_filtered = false;
  mask.texels_float = {0, 1};
  s.textures.push_back(mask);
  s.materials[0].is_alpha_masked = true;
  s.materials[0].alpha = {1, 0, 0};
  s.lights[0].is_alpha_masked = true;
  const PreparedScene holed(std::move(s)), half(source_from(0));

  const StopFlag never_stop = false;
  const std::vector<MeasuringPoint> points{{{0, 0, 0}, {0, 0, 1}}, {{-2, 0.5f, 0}, {1, 0, 1}}};
  for (const Method method : {Method::path, Method::fixed}) {
    MeasureOptions o;
    o.method = method;
    const MeasureResult result = measure(holed, points, o, {}, never_stop);
    for (size_t i = 0; i < points.size(); ++i) {
      const double expected = 3 * irradiance(half.primitives, 0, Vec3d(points[i].position),
                                             Vec3d(normalize(points[i].normal)));
      REQUIRE(expected > 0.1);
      const double error = result.values[i].standard_error / luminous_efficacy;
      CAPTURE(i);
      CHECK(error < 0.02 * expected);
      CHECK(std::abs(double(result.values[i].irradiance.g) - expected) < 4.5 * error + 1e-6);
    }
  }
}

TEST_CASE("a blended sheet takes its share of the light, a blended source sends its share") {
  Scene sheet = source_from(-1);
  Material m = sheet.materials[0];
  m.is_alpha_masked = m.is_alpha_blended = true;
  m.alpha.value = 0.3f;
  add_quad(sheet, add_material(sheet, m),
           {Vec3{-9, -9, 0.5f}, {9, -9, 0.5f}, {9, 9, 0.5f}, {-9, 9, 0.5f}});
  Scene source = source_from(-1);
  source.materials[0].is_alpha_masked = source.materials[0].is_alpha_blended = true;
  source.materials[0].alpha.value = 0.25f;
  source.lights[0].is_alpha_masked = true;
  const PreparedScene plain(source_from(-1));
  const PreparedScene covered(std::move(sheet)), faint(std::move(source));

  const StopFlag never_stop = false;
  const std::vector<MeasuringPoint> points{{{0, 0, 0}, {0, 0, 1}}, {{0.4f, 0.5f, 0}, {1, 0, 1}}};
  for (const Method method : {Method::path, Method::fixed, Method::certified})
    for (const bool is_sheet : {true, false}) {
      MeasureOptions o;
      o.method = method;
      const MeasureResult result = measure(is_sheet ? covered : faint, points, o, {}, never_stop);
      for (size_t i = 0; i < points.size(); ++i) {
        CAPTURE(is_sheet);
        const double expected = (is_sheet ? 0.7 : 0.25) * 3 *
                                irradiance(plain.primitives, 0, Vec3d(points[i].position),
                                           Vec3d(normalize(points[i].normal)));
        const double error = result.values[i].standard_error / luminous_efficacy;
        CHECK(error < 0.02 * expected);
        CHECK(std::abs(double(result.values[i].irradiance.g) - expected) < 4.5 * error + 1e-5);
      }
    }
}
