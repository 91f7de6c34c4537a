// A lamp seen through a hole of 3 cm: proofs find its light at every point, while a sample of the
// lamp passes the hole once in thousands.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "light/irradiance.h"
#include "render/pictures.h"
#include "support/light_scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace test_pinhole {

namespace {

// A lamp of 80 cm at 2.6 m, an opaque plate with a hole at 1.2 m, and a floor.
Scene pinhole() {
  Scene s;
  const uint32_t matte = add_diffuse(s, Rgb{0.6f}), black = add_diffuse(s, Rgb{0});
  add_quad(s, matte, {Vec3{-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}});
  constexpr float h = 0.015f, z = 1.2f;
  const auto plate = [&](float x0, float y0, float x1, float y1) {
    add_quad(s, black, {Vec3{x0, y0, z}, {x0, y1, z}, {x1, y1, z}, {x1, y0, z}});
  };
  plate(-9, -9, -h, 9);
  plate(h, -9, 9, 9);
  plate(-h, -9, h, -h);
  plate(-h, h, h, 9);
  make_light(
      s,
      add_quad(
          s, black,
          {Vec3{-0.4f, -0.4f, 2.6f}, {-0.4f, 0.4f, 2.6f}, {0.4f, 0.4f, 2.6f}, {0.4f, -0.4f, 2.6f}}),
      Rgb{10});
  return s;
}

// Radiance of a point of the floor, in closed form. The point sees the lamp through the hole's
// image in the lamp's plane; nothing else reflects light.
double floor_radiance(double x, double y) {
  constexpr double half_lamp = 0.4, half_hole = 0.015, scale = 2.6 / 1.2;
  const auto part = [&](double at) {
    return std::array{std::max(-half_lamp, at + (-half_hole - at) * scale),
                      std::min(half_lamp, at + (half_hole - at) * scale)};
  };
  const auto [x0, x1] = part(x);
  const auto [y0, y1] = part(y);
  if (x0 >= x1 || y0 >= y1) return 0;
  const std::array<Vec3d, 4> seen{Vec3d{x0, y0, 2.6}, {x0, y1, 2.6}, {x1, y1, 2.6}, {x1, y0, 2.6}};
  return 0.6 / pi * 10 * polygon_irradiance(seen, {x, y, 0}, {0, 0, 1}, Sides::both);
}

// The picture of a camera above the floor, with the mean of each pixel's square.
Image picture_of_floor(const Camera& camera, int width, int height) {
  constexpr int along = 8;
  const ViewingCamera view(camera, width, height);
  Image image;
  image.width = width;
  image.height = height;
  for (int i = 0; i < width * height; ++i) {
    double sum = 0;
    for (int k = 0; k < along * along; ++k) {
      const Vec2 raster{float(i % width) + (float(k % along) + 0.5f) / along,
                        float(i / width) + (float(k / along) + 0.5f) / along};
      const Ray ray = view.ray(raster, {0.5f, 0.5f});
      const Vec3d o(ray.origin), d(ray.direction);
      sum += floor_radiance(o.x - d.x * o.z / d.z, o.y - d.y * o.z / d.z);
    }
    image.pixels.push_back(Rgb{float(sum / (along * along))});
  }
  return image;
}

// Root mean square of the difference in green, relative to the mean.
double difference(const Image& a, const Image& b) {
  double sum = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    const double d = double(a.pixels[i].g) - double(b.pixels[i].g);
    sum += d * d;
  }
  return std::sqrt(sum / double(a.pixels.size())) / mean_green(b);
}

}  // namespace

TEST_CASE("light through a small hole: less asked error never gives much more") {
  const PreparedScene scene(pinhole());
  const Camera camera = look_at({0, 0, 1.1f}, {0, 0, 0}, {0, 1, 0}, 50);
  RenderOptions o;
  o.width = 96;
  o.height = 64;
  o.threads = 2;
  const Image reference = picture_of_floor(camera, o.width, o.height);
  for (const double error : {0.1, 0.03, 0.01}) {
    CAPTURE(error);
    o.error = error;
    const RenderResult r = render_now(scene, camera, o);
    CHECK(difference(r.layers[0].image, reference) < 1.2 * error);
    CHECK(r.statistics.estimated_error < 2 * error);
  }
}

}  // namespace test_pinhole
