// Two coincident one-sided sheets that face opposite ways, as in the Khronos TextureSettingsTest. A
// viewer sees the one that faces him (glTF 2.0 §3.9.7), whichever comes first in the file.
#include <doctest/doctest.h>

#include "render/pictures.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// A red sheet that faces up and a green one that faces down, in uniform surroundings.
Scene two_sheets(bool is_red_first, float shift) {
  Scene s;
  for (const bool is_red : {is_red_first, !is_red_first}) {
    Material m;
    m.base_color.value = is_red ? Rgb{0.5f, 0, 0} : Rgb{0, 0.5f, 0};
    m.back_faces = BackFaces::unseen;
    const uint32_t material = add_material(s, m);
    // not aligned with the axes, so that coordinates are rounded
    const Vec3 a{-1.1f, -0.9f, shift}, b{1.3f, -1, 0.13f + shift}, c{1.1f, 1.2f, 0.1f + shift};
    const Vec3 d = a + (c - b);
    add_quad(s, material, is_red ? std::array{a, b, c, d} : std::array{a, d, c, b});
  }
  Light all;
  all.name = "surroundings";
  all.kind = LightKind::environment;
  all.radiance = Rgb{1};
  s.lights.push_back(all);
  return s;
}

Camera looking(bool is_from_above) {
  Camera c;
  const float side = is_from_above ? 1.0f : -1.0f;
  c.position = {0.07f, 0.05f, 6 * side};
  c.right = {1, 0, 0};
  c.up = {0, side, 0};
  c.forward = {0, 0, -side};
  c.half_extent = 0.1f;
  return c;
}

}  // namespace

TEST_CASE("of two coincident one-sided sheets the one that faces the viewer is visible") {
  for (const Method method : {Method::certified, Method::path, Method::fixed, Method::kj92})
    for (const bool is_red_first : {true, false})
      for (const float shift : {0.0f, 37.0f})
        for (const bool is_from_above : {true, false}) {
          CAPTURE(std::string(method.row().name));
          CAPTURE(is_red_first);
          CAPTURE(shift);
          CAPTURE(is_from_above);
          const PreparedScene scene(two_sheets(is_red_first, shift));
          Camera camera = looking(is_from_above);
          camera.position.z += shift;
          RenderOptions o;
          o.method = method;
          o.width = o.height = 12;
          o.spp = method == Method::path ? 64 : 1;
          const Image image = render_now(scene, camera, o).layers.at(0).image;
          double red = 0, green = 0;
          for (const Rgb& p : image.pixels) {
            red += double(p.r) / 144;
            green += double(p.g) / 144;
          }
          // A matte sheet of reflectance .5 under surroundings of radiance 1 on its side.
          CHECK((is_from_above ? red : green) == doctest::Approx(0.5).epsilon(0.02));
          CHECK((is_from_above ? green : red) == 0);
        }
}
