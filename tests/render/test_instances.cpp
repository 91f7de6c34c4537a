// Pictures of instances compared with pictures of copies.
#include <doctest/doctest.h>

#include <cmath>

#include "render/cell_pilot.h"
#include "render/first_sight.h"
#include "render/measure.h"
#include "render/pictures.h"
#include "scene/mirror_image.h"
#include "support/instanced_scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

RenderOptions small_options(Method method, Indirect indirect) {
  RenderOptions o;
  o.method = method;
  o.indirect = indirect;
  o.width = 40;
  o.height = 30;
  o.threads = 2;
  o.shadow_rays = 16;
  o.kj92.radiosity.meshing.element_size = 0.5f;
  o.kj92.radiosity.meshing.patch_size = 1.5f;
  o.kj92.radiosity.unshot_fraction = 0.1f;
  return o;
}

Camera camera_in_room() {
  return look_at({-1.5f, -1.8f, 1.6f}, {0.3f, 0.3f, 0.5f}, {0, 0, 1}, 75);
}

struct Difference {
  double of_means = 0, rms = 0;  // relative
};

Difference difference(const Image& a, const Image& b) {
  double sum_a = 0, sum_b = 0, squares = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    const double p = luminance(a.pixels[i]), q = luminance(b.pixels[i]);
    sum_a += p;
    sum_b += q;
    squares += sqr(p - q);
  }
  const auto n = double(a.pixels.size());
  return {sum_a / sum_b - 1, std::sqrt(squares / n) / (sum_b / n)};
}

Difference difference(const RenderOptions& options, const Scene& scene) {
  const PreparedScene a(scene), b(copied_out(scene));
  return difference(render_now(a, camera_in_room(), options).layers[0].image,
                    render_now(b, camera_in_room(), options).layers[0].image);
}

// Checks that the picture is not black and that it shows the instances.
void check_is_a_picture(const Scene& scene) {
  Scene without = scene;
  without.instances.clear();
  const RenderOptions o = small_options(Method::certified, Indirect::none);
  const PreparedScene a(scene), b(without);
  const Difference d = difference(render_now(a, camera_in_room(), o).layers[0].image,
                                  render_now(b, camera_in_room(), o).layers[0].image);
  CHECK(d.rms > 0.2);
}

}  // namespace

TEST_CASE("certified light is the same with instances and with copies") {
  const Scene scene = room_of_instances(places_in_room());
  check_is_a_picture(scene);
  const RenderOptions o = small_options(Method::certified, Indirect::none);
  const Difference d = difference(o, scene);
  MESSAGE("means " << d.of_means << ", rms " << d.rms);
  CHECK(std::abs(d.of_means) < 1e-5);
  CHECK(d.rms < 1e-4);
}

TEST_CASE("every method gives the same picture with instances and with copies") {
  const Scene scene = room_of_instances(places_in_room());
  for (const auto& [method, indirect, most] : {std::tuple{Method::fixed, Indirect::none, 5e-3},
                                               {Method::path, Indirect::automatic, 0.02},
                                               {Method::certified, Indirect::automatic, 5e-3},
                                               {Method::kj92, Indirect::automatic, 5e-3}}) {
    RenderOptions o = small_options(method, indirect);
    if (method == Method::path) o.spp = 64;
    const Difference d = difference(o, scene);
    CAPTURE(method.row().name);
    MESSAGE("means " << d.of_means << ", rms " << d.rms);
    CHECK(std::abs(d.of_means) < most);
  }
}

TEST_CASE("a picture of instances does not depend on the number of threads") {
  const PreparedScene scene(room_of_instances(places_in_room()));
  RenderOptions o = small_options(Method::certified, Indirect::automatic);
  o.threads = 1;
  const RenderResult one = render_now(scene, camera_in_room(), o);
  o.threads = 3;
  CHECK(is_identical(one.layers, render_now(scene, camera_in_room(), o).layers));
}

TEST_CASE("a first sight shows instances") {
  const Scene scene = room_of_instances(places_in_room());
  const ViewingCamera viewing(camera_in_room(), 96, 72);
  const PixelRect window{0, 0, 96, 72};
  const Image a = first_sight(scene, viewing, window, 2);
  CHECK(a.pixels == first_sight(copied_out(scene), viewing, window, 1).pixels);
}

TEST_CASE("random places in a scene lie on instances in proportion to their area") {
  Scene scene =
      room_of_instances({Affine::translate({0, 0, 1.2}) * Affine::scale({-1, 1, 1}),
                         Affine::translate({1.2, 1.2, 0.5}) * Affine::scale({.4, .4, .4})});
  const PreparedScene a(scene), b(copied_out(scene));
  const auto near = [](const PreparedScene& s, const Vec3& middle, float radius) {
    int n = 0;
    for (const auto& place : surfaces_pilot(s, 1).places)
      n += length(place.position - middle) < radius;
    return n;
  };
  for (const auto& [middle, radius] :
       {std::pair{Vec3{0, 0, 1.2f}, 1.19f}, {{1.2f, 1.2f, 0.5f}, 0.48f}}) {
    const int by_instances = near(a, middle, radius), by_copies = near(b, middle, radius);
    CHECK(by_copies > 200);
    CHECK(std::abs(by_instances - by_copies) <= 3);
  }
}

TEST_CASE("instances in front of a mirror, behind it and across it") {
  Scene scene = room_of_instances({Affine::translate({0.2, 0, 1}) * Affine::scale({.4, .4, .4}),
                                   Affine::translate({0.2, 0.9, 1}) * Affine::scale({.2, -.3, .2}),
                                   Affine::translate({0.2, -.9, 1}) * Affine::scale({.3, .3, .3})});
  FlatMirror mirror;
  mirror.normal = {0, 1, 0};
  mirror.tolerance = 1e-5f;
  mirror.outline = {{-1, 0, 0.5f}, {1, 0, 0.5f}, {1, 0, 2}, {-1, 0, 2}};
  mirror.material = 0;
  const auto image = mirror_image_of(scene, mirror),
             expected = mirror_image_of(copied_out(scene), mirror);
  REQUIRE(image);
  REQUIRE(expected);
  CHECK(image->scene.instances.size() == 2);  // the one in front of the mirror, and its image
  CHECK(triangle_count(image->scene) == triangle_count(expected->scene));
  const Tracer a(image->scene), b(expected->scene);
  Random r(2);
  size_t differ = 0;
  for (int i = 0; i < 5000; ++i) {
    Ray ray;
    const float x = r.next_float();
    ray.origin = {1.6f * x - 0.8f, 1.7f * r.next_float(), 1.3f};
    ray.direction = sphere_from_square(r.next_vec2());
    Hit h, e;
    a.closest({&ray, 1}, {&h, 1});
    b.closest({&ray, 1}, {&e, 1});
    differ += std::abs(h.t - e.t) > 1e-4f * e.t;
  }
  CHECK(differ < 10);
}
