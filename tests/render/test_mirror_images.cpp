// Lights in flat mirrors: certified light by mirror images, against closed forms and paths.
#include <doctest/doctest.h>

#include <cmath>

#include "base/units.h"
#include "light/irradiance.h"
#include "pictures.h"
#include "render/measure.h"
#include "scene/mirror_image.h"
#include "support/light_scenes.h"
#include "support/surfaceless_lights.h"
#include "transport/mirror_images.h"

using namespace troffer;
using namespace troffer::test;

namespace {

uint32_t add_mirror(Scene& s, float reflectance = 1) {
  Material m;
  m.kind = MaterialKind::conductor;
  m.is_reflectance = true;
  m.base_color = {Rgb{reflectance}, no_texture};
  s.materials.push_back(m);
  return uint32_t(s.materials.size() - 1);
}

// Adds a square in the plane z = 0 that faces up, of several triangles that merge.
void add_mirror_square(Scene& s, uint32_t material, float half) {
  Mesh m;
  m.material = material;
  for (int i = 0; i <= 2; ++i)
    for (int j = 0; j <= 2; ++j)
      m.positions.push_back({half * float(i - 1), half * float(j - 1), 0});
  for (uint32_t i = 0; i < 2; ++i)
    for (uint32_t j = 0; j < 2; ++j) {
      const uint32_t a = 3 * i + j;
      m.triangles.push_back({a, a + 3, a + 4});
      m.triangles.push_back({a, a + 4, a + 1});
    }
  s.meshes.push_back(std::move(m));
}

// Adds a lamp that faces down, with its centre at c.
void add_lamp(Scene& s, uint32_t material, const Vec3& c, float half, Rgb radiance) {
  make_light(s,
             add_quad(s, material,
                      {c + Vec3{-half, -half, 0}, c + Vec3{-half, half, 0}, c + Vec3{half, half, 0},
                       c + Vec3{half, -half, 0}}),
             radiance, false);
}

Measurement at(const PreparedScene& scene, const Vec3d& point, const Vec3& normal,
               Method method = Method::certified, int spp = 0,
               Indirect indirect = Indirect::automatic) {
  MeasureOptions o;
  o.indirect = indirect;
  o.method = method;
  o.spp = spp;
  o.error = 0.004;
  o.threads = 2;
  return measure(scene, {{point, normal}}, o, {}, never_stopped).values.at(0);
}

}  // namespace

TEST_CASE("a lamp fully visible in a mirror sends the light of its mirror image, without noise") {
  Scene s;
  const uint32_t black = add_diffuse(s, Rgb{0});
  add_mirror_square(s, add_mirror(s), 3);
  add_lamp(s, black, {0.3f, -0.2f, 2}, 0.1f, Rgb{50});
  const PreparedScene scene(std::move(s));
  const Vec3d image[4] = {{0.2, -0.3, -2}, {0.4, -0.3, -2}, {0.4, -0.1, -2}, {0.2, -0.1, -2}};
  for (const Vec3d point : {Vec3d{-0.5, 0.4, 1}, Vec3d{1.2, 0.1, 2.5}, Vec3d{0.1, 0.1, 0.05}}) {
    const Measurement m = at(scene, point, {0, 0, -1});
    const double expected = 50 * polygon_irradiance(image, point, {0, 0, -1}, Sides::both);
    CAPTURE(point.z);
    CHECK(double(m.irradiance.g) == doctest::Approx(expected).epsilon(1e-3));
    CHECK(m.standard_error / luminous_efficacy < 1e-3 * expected);
  }
}

TEST_CASE("a mirror that shows nothing but a lamp is as bright as the lamp") {
  Scene s;
  const uint32_t black = add_diffuse(s, Rgb{0});
  add_mirror_square(s, add_mirror(s, 1), 0.4f);
  add_lamp(s, black, {0, 0, 3}, 30, Rgb{2});
  const PreparedScene scene(std::move(s));
  const Vec3d mirror[4] = {{-0.4, -0.4, 0}, {0.4, -0.4, 0}, {0.4, 0.4, 0}, {-0.4, 0.4, 0}};
  for (const Vec3d point : {Vec3d{0.2, 0.1, 0.7}, Vec3d{1, 0.5, 0.5}}) {
    const double expected = 2 * polygon_irradiance(mirror, point, {0, 0, -1}, Sides::both);
    const Measurement m = at(scene, point, {0, 0, -1});
    CHECK(double(m.irradiance.g) == doctest::Approx(expected).epsilon(2e-3));
    CHECK(m.standard_error / luminous_efficacy < 2e-3 * expected);
  }
}

TEST_CASE("objects in front of a mirror hide lamps in it, on both legs of the path") {
  for (const float z : {0.5f, 1.5f}) {
    Scene s;
    const uint32_t black = add_diffuse(s, Rgb{0});
    add_mirror_square(s, add_mirror(s), 3);
    add_lamp(s, black, {1, 0, 2}, 0.1f, Rgb{50});
    // the path from (-1,0,2) to the image at (1,0,-2) and back up passes x = -.25 and .75 at z = .5
    // and 1.5
    const float x = z < 1 ? -0.25f : 0.75f;
    add_quad(s, black,
             {Vec3{x - 0.15f, -0.2f, z},
              {x + 0.15f, -0.2f, z},
              {x + 0.15f, 0.2f, z},
              {x - 0.15f, 0.2f, z}});
    const PreparedScene scene(std::move(s));
    const Measurement hidden = at(scene, {-1, 0, 2}, {0, 0, -1});
    CHECK(hidden.irradiance.g == 0);
    const Measurement beside = at(scene, {-1, 1.5, 2}, {0, 0, -1});
    CHECK(beside.irradiance.g > 0);
  }
}

TEST_CASE("every kind of light in a mirror agrees with paths") {
  for (int kind = 0; kind < 3; ++kind) {
    Scene s;
    const uint32_t black = add_diffuse(s, Rgb{0});
    add_mirror_square(s, add_mirror(s, 0.6f), 1);
    if (kind == 0) add_sphere_light(s, black, {0.2f, 0.1f, 1.5f}, 0.4f, Rgb{9});
    if (kind == 1) add_disk_light(s, black, {0.2f, 0.1f, 1.5f}, {0, 0, -1}, 0.5f, Rgb{9});
    if (kind == 2) add_environment(s, Rgb{1.5f});
    const PreparedScene scene(std::move(s));
    const Vec3d point{0.9, 0.6, 1};
    const Vec3 normal = normalize(Vec3{-0.3f, -0.2f, -1});
    const Measurement paths = at(scene, point, normal, Method::path, 1 << 16);
    CAPTURE(kind);
    for (const Indirect indirect : {Indirect::automatic, Indirect::cells}) {
      const Measurement found = at(scene, point, normal, Method::certified, 0, indirect);
      const double spread = std::hypot(found.standard_error, paths.standard_error);
      CHECK(std::abs(found.illuminance_lx - paths.illuminance_lx) < 4 * spread);
      CHECK(spread < 0.02 * paths.illuminance_lx);
    }
  }
}

TEST_CASE("a point light in a mirror, which no path finds, follows the inverse square law") {
  Scene s;
  add_diffuse(s, Rgb{0});
  add_mirror_square(s, add_mirror(s, 1), 2);
  add_point(s, {0, 0, 1}, Rgb{5});
  const PreparedScene scene(std::move(s));
  // from (0,0,2), facing down: the light itself is at 1 m, its image at 3 m
  for (const Indirect indirect : {Indirect::automatic, Indirect::cells}) {
    const Measurement m = at(scene, {0, 0, 2}, {0, 0, -1}, Method::certified, 0, indirect);
    CHECK(double(m.irradiance.g) == doctest::Approx(5 + 5.0 / 9).epsilon(1e-4));
  }
}

TEST_CASE("a uniform sky has no image in a mirror, and the mirror reflects it all the same") {
  // From 1 m above the middle of a mirror of 2 m x 2 m, facing down, the mirror fills the share
  // f = (4 / pi) a atan(a), a = 1 / sqrt(2), of what a whole hemisphere would send.
  const double a = std::sqrt(0.5), f = 4 / pi * a * std::atan(a), sky = 1.5, share = 0.6;
  const Vec3d image[4] = {
      {-0.1, -0.1, -3}, {0.1, -0.1, -3}, {0.1, 0.1, -3}, {-0.1, 0.1, -3}};  // of the lamp
  const double of_lamp = polygon_irradiance(image, {0, 0, 1}, {0, 0, -1}, Sides::both);
  for (const double lamp : {0.0, 40.0}) {
    Scene s;
    const uint32_t black = add_diffuse(s, Rgb{0});
    add_mirror_square(s, add_mirror(s, float(share)), 1);
    add_environment(s, Rgb{float(sky)});
    if (lamp > 0) add_lamp(s, black, {0, 0, 3}, 0.1f, Rgb{float(lamp)});
    const PreparedScene scene(std::move(s));
    const auto images = MirrorImages::make(scene);
    CHECK((images != nullptr) == (lamp > 0));
    if (images) {
      REQUIRE(images->all().size() == 1);
      CHECK(!images->all()[0].shows[0]);  // the sky
      CHECK(images->all()[0].shows[1]);   // the lamp
    }
    // In the mirror, the lamp covers a part of the sky.
    const double expected =
        pi * sky * (1 - f) + share * pi * sky * f + (lamp > 0 ? share * (lamp - sky) * of_lamp : 0);
    CAPTURE(lamp);
    for (const Indirect indirect : {Indirect::automatic, Indirect::cells}) {
      const Measurement m = at(scene, {0, 0, 1}, {0, 0, -1}, Method::certified, 0, indirect);
      CHECK(std::abs(double(m.irradiance.g) - expected) <
            4 * m.standard_error / luminous_efficacy + 1e-4 * expected);
      CHECK(m.standard_error / luminous_efficacy < 0.02 * expected);
    }
  }
}

TEST_CASE("pictures of rooms with mirrors: same mean as paths, same for any number of threads") {
  Scene s;
  const uint32_t white = add_diffuse(s, Rgb{0.6f});
  const uint32_t mirror = add_mirror(s, 0.9f);
  add_box_inside(s, white, {0, 0, 0}, {4, 4, 3});
  add_box_inside(s, white, {1.5f, 1.2f, 0}, {2.1f, 2, 0.8f});
  // two mirrors that see each other
  add_quad(s, mirror, {Vec3{0.01f, 0.8f, 0.5f}, {0.01f, 3, 0.5f}, {0.01f, 3, 2}, {0.01f, 0.8f, 2}});
  add_quad(s, mirror, {Vec3{3.99f, 1, 0.5f}, {3.99f, 1, 2}, {3.99f, 2.5f, 2}, {3.99f, 2.5f, 0.5f}});
  add_lamp(s, white, {1.2f, 2, 2.9f}, 0.35f, Rgb{20});
  const PreparedScene scene(std::move(s));
  Camera camera = look_at({3.5f, 3.6f, 1.6f}, {1, 1, 0.8f}, {0, 0, 1}, 70);
  RenderOptions o;
  o.width = 32;
  o.height = 24;
  o.threads = 1;
  const RenderResult one = render_now(scene, camera, o);
  o.threads = 2;
  const RenderResult two = render_now(scene, camera, o);
  CHECK(is_identical(one.layers, two.layers));
  o.method = Method::path;
  o.spp = 2048;
  const RenderResult paths = render_now(scene, camera, o);
  CHECK(mean(one.layers.at(0).image) ==
        doctest::Approx(mean(paths.layers.at(0).image)).epsilon(0.006));
}

TEST_CASE(
    "the mirror image of a scene: cut triangles, triangles behind, and shapes that cannot be cut") {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  const uint32_t material = add_mirror(s);
  add_mirror_square(s, material, 1);
  add_quad(s, grey, {Vec3{2, 0, -1}, {2, 1, -1}, {2, 1, 1}, {2, 0, 1}});    // across the plane
  add_quad(s, grey, {Vec3{0, 0, -1}, {1, 0, -1}, {1, 1, -1}, {0, 1, -1}});  // behind it
  add_lamp(s, grey, {0, 0, 2}, 0.1f, Rgb{1});
  make_light(s, add_quad(s, grey, {Vec3{3, 0, -1}, {3, 1, -1}, {3, 1, 1}, {3, 0, 1}}), Rgb{1},
             false);  // on both sides of the plane
  FlatMirror m;
  m.normal = {0, 0, 1};
  m.tolerance = 1e-5f;
  m.outline = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  m.material = material;
  const auto image = mirror_image_of(s, m);
  REQUIRE(image.has_value());
  REQUIRE(image->lights == std::vector<uint32_t>{0});
  CHECK(image->scene.lights[0].polygon.at(0).z == doctest::Approx(-2));
  // area on either side of the plane, of the quad that was cut (plane x = 2)
  double front = 0, behind = 0;
  for (const Mesh& mesh : image->scene.meshes)
    for (const Triangle& t : mesh.triangles) {
      const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
      if (a.x != 2 || b.x != 2 || c.x != 2) continue;
      const double area = 0.5 * double(length(cross(b - a, c - a)));
      (a.z + b.z + c.z > 0 ? front : behind) += area;
    }
  CHECK(front == doctest::Approx(1));
  CHECK(behind == doctest::Approx(1));
  Scene with_sphere = s;
  with_sphere.spheres.push_back({{5, 5, 0.2f}, 0.5f, false, grey, no_light});
  CHECK(!mirror_image_of(with_sphere, m).has_value());
}

namespace {

// Adds a relay in the plane z = 0 that faces up.
void add_relay(Scene& s, Rgb reflectance, float half) {
  s.relays.push_back({{{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}},
                      {0, 0, 1},
                      reflectance});
}

}  // namespace

// Radiance's definition: a virtual source behind the mirror, its reflectance at every angle.
TEST_CASE("a relay sends the light of a point's mirror image, at a grazing angle as well") {
  Scene s;
  add_diffuse(s, Rgb{0});
  add_relay(s, {0.3f, 0.2f, 0.1f}, 5);
  add_point(s, {0, 0, 1}, Rgb{5});
  const PreparedScene scene(std::move(s));
  // From (7,0,1), facing down: the light itself lies in the sensor's horizon, its image 2 m below.
  const double cosine = 2 / std::sqrt(53.0);
  for (const Method method : {Method::certified, Method::path})
    for (const Indirect indirect : {Indirect::automatic, Indirect::cells}) {
      if (method == Method::path && indirect == Indirect::cells) continue;
      const Measurement m = at(scene, {7, 0, 1}, {0, 0, -1}, method, 0, indirect);
      CHECK(double(m.irradiance.r) == doctest::Approx(0.3 * 5 * cosine / 53).epsilon(1e-3));
      CHECK(double(m.irradiance.b) == doctest::Approx(0.1 * 5 * cosine / 53).epsilon(1e-3));
      // Behind the relay nothing is reflected and nothing is hidden.
      const Measurement behind = at(scene, {0, 0, -1}, {0, 0, 1}, method, 0, indirect);
      CHECK(double(behind.irradiance.g) == doctest::Approx(5.0 / 4).epsilon(1e-3));
    }
  CHECK(at(scene, {7, 0, 1}, {0, 0, -1}, Method::certified, 0, Indirect::none).irradiance.g < 1e-6);
}

TEST_CASE("a relay's light is reflected by matte and coated surfaces alike") {
  for (const bool is_coated : {false, true}) {
    Scene s;
    Material m;
    m.base_color = {Rgb{0.5f}, no_texture};
    if (is_coated) m.kind = MaterialKind::coated_diffuse;
    s.materials.push_back(m);
    // A ceiling at 2 m, lit from below by the image of a lamp that shines down only.
    add_quad(s, 0, {Vec3{-4, -4, 2}, {-4, 4, 2}, {4, 4, 2}, {4, -4, 2}});
    add_relay(s, Rgb{0.5f}, 3);
    add_lamp(s, add_diffuse(s, Rgb{0}), {0.3f, -0.2f, 1.5f}, 0.1f, Rgb{50});
    const PreparedScene scene(std::move(s));
    const Vec3d point{0, 0, 0.5};
    const Measurement paths = at(scene, point, {0, 0, 1}, Method::path, 1 << 15);
    CHECK(paths.irradiance.g > 0.01f);
    for (const Indirect indirect : {Indirect::automatic, Indirect::cells}) {
      const Measurement found = at(scene, point, {0, 0, 1}, Method::certified, 0, indirect);
      const double spread = std::hypot(found.standard_error, paths.standard_error);
      CAPTURE(is_coated);
      CAPTURE(found.illuminance_lx);
      CAPTURE(paths.illuminance_lx);
      CHECK(std::abs(found.illuminance_lx - paths.illuminance_lx) < 4 * spread);
      CHECK(spread < 0.02 * paths.illuminance_lx);
    }
  }
}
