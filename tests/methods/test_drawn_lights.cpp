// Many lights: estimates of what groups send, and light samples for those that are not certified.
#include <doctest/doctest.h>

#include <cmath>

#include "certified/drawn_lights.h"
#include "light/irradiance.h"
#include "methods/probe.h"

using namespace troffer;
using namespace troffer::test;

namespace test_drawn_lights {

namespace {

// A room with n × n lights of about 3 cm under a ceiling of 6 × 6 m, over a matte floor. In
// between: a table top, some posts and a beam right below the lights.
Scene room_of_lights(uint32_t n) {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  add_quad(s, grey, {Vec3{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}});
  for (uint32_t i = 0; i < n * n; ++i) {
    const float x = -3 + 6 * (float(i % n) + 0.5f) / float(n);
    const float y = -3 + 6 * (float(i / n) + 0.5f) / float(n), r = 0.015f;
    const uint32_t quad = add_quad(s, grey,
                                   {Vec3{x - r, y - r, 2.5f},
                                    {x - r, y + r, 2.5f},
                                    {x + r, y + r, 2.5f},
                                    {x + r, y - r, 2.5f}});
    make_light(s, quad, Rgb{2000.0f * (1 + float(i % 5)) / float(n * n)});
  }
  add_block(s, grey, {-0.6f, -0.4f, 0.7f}, {0.6f, 0.4f, 0.75f});
  add_block(s, grey, {-0.9f, -0.9f, 0}, {-0.8f, -0.8f, 2});
  add_block(s, grey, {-3, 0.9f, 2.3f}, {3, 1.1f, 2.4f});
  return s;
}

// Adds a closed ball of triangles that shines.
void add_ball_light(Scene& s, const Vec3& centre, float radius, int rings, Rgb radiance) {
  const int sides = 2 * rings;
  std::vector<Vec3> p;
  std::vector<Triangle> t;
  for (int i = 0; i <= rings; ++i)
    for (int k = 0; k < sides; ++k) {
      const float a = pi_f * float(i) / float(rings), b = 2 * pi_f * float(k) / float(sides);
      p.push_back(centre +
                  Vec3{std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)} * radius);
    }
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < sides; ++k) {
      const auto at = [&](int ring, int side) { return uint32_t(ring * sides + side % sides); };
      if (i > 0) t.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
      if (i + 1 < rings) t.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
    }
  add_mesh_light(s, 0, std::move(p), std::move(t), radiance, false);
}

// Returns a viewing ray to a point of the floor.
Ray ray_to(const Vec3& point) {
  return ray_towards(point + Vec3{0.3f, -0.2f, 0.4f}, point);
}

WaveIntegrator certified_of_pixel(const PreparedScene& scene, double error, int viewing_rays) {
  const CertifiedSettings settings =
      certified_settings(error, scene.scene.lights.size(), viewing_rays);
  return {scene,
          std::make_unique<CertifiedDirect>(scene, std::make_shared<const Occluders>(scene.scene),
                                            settings),
          nullptr};
}

const Vec3 floor_points[] = {{1.7f, -1.2f, 0}, {0.5f, 0.2f, 0}, {-0.7f, -0.7f, 0}, {0, 1, 0}};

// Returns what the floor would send on from all lights if nothing hid them.
double unoccluded(const PreparedScene& scene, const Vec3& x) {
  double sum = 0;
  for (const Light& light : scene.scene.lights) {
    std::vector<Vec3d> corners;
    for (const Vec3& c : light.polygon) corners.emplace_back(c);
    sum +=
        double(light.radiance.g) * polygon_irradiance(corners, Vec3d(x), {0, 0, 1}, Sides::front);
  }
  return 0.5 * sum / pi;
}

struct Sent {
  double variance = 0, rays = 0;
};
Sent told_by(const Integrator& integrator, const Ray& ray, uint32_t samples, int sets) {
  const auto scratch = integrator.make_scratch();
  RadianceBatch batch;
  Counters counters;
  Sent told;
  for (int s = 0; s < sets; ++s) {
    const ViewingRays rays = repeated(ray, hash_of(7u, uint64_t(s)), samples);
    batch.reset(rays.size());
    integrator.radiance(rays, *scratch, batch, counters);
    for (const float v : batch.direct_variance) told.variance += double(v);
  }
  told.variance /= double(sets) * samples * samples;
  told.rays = double(counters.shadow_rays) / (double(sets) * samples);
  return told;
}

}  // namespace

TEST_CASE("many lights: no group that a receiver in the ball sees is estimated as zero") {
  int seen = 0;
  for (uint64_t seed = 0; seed < 3000; ++seed) {
    Random r(seed);
    Scene s;
    add_diffuse(s, Rgb{0.5f});
    const Vec3 centre = random_point(r, 4), u = random_point(r, 0.5f);
    const Vec3 v = cross(u, random_point(r, 1));
    if (seed % 5 == 0)
      add_sphere_light(s, 0, centre, 0.02f + 0.5f * r.next_float(), Rgb{1});
    else if (seed % 5 == 1)  // two triangles, folded
      add_mesh_light(s, 0, {centre, centre + u, centre + u + v * r.next_float(), centre + v},
                     {{0, 1, 2}, {0, 2, 3}}, Rgb{1}, seed % 2 == 0);
    else if (seed % 5 == 2)  // two triangles in any position
      add_mesh_light(s, 0, {centre, centre + u, centre + v, centre + random_point(r, 0.5f)},
                     {{0, 1, 2}, {0, 2, 3}}, Rgb{1}, seed % 2 == 0);
    else
      make_light(s, add_quad(s, 0, {centre, centre + u, centre + u + v, centre + v}), Rgb{1},
                 seed % 2 == 0);
    const PreparedScene scene(std::move(s));
    std::vector<uint32_t> all;
    for (uint32_t i = 0; i < scene.primitives.size(); ++i) all.push_back(i);
    if (all.empty()) continue;
    LightGroups groups;
    groups.add(scene.primitives, all, 0, 0);
    groups.finish();
    ClusterBall ball;
    ball.centre = random_point(r, 3);
    ball.radius = seed % 3 == 0 ? 0.001f : r.next_float();
    const Vec3 n = random_direction(r);
    const bool is_flat = seed % 2 == 0;
    if (is_flat) ball.normal = n;
    ball.depth = is_flat && seed % 4 == 0 ? ball.radius * r.next_float() : 0;
    std::vector<float> estimates, near;
    groups.estimate(ball, estimates, near);
    for (size_t i = 0; i < 20; ++i) {
      Vec3 d = random_direction(r);
      if (is_flat) d = d - n * dot(d, n);
      Vec3 x = ball.centre + normalize(d) * (ball.radius * std::sqrt(r.next_float()));
      if (ball.depth > 0) x = ball.centre - n * (ball.depth * r.next_float());
      LightSample point;
      const LightPrimitive& p = scene.primitives[i % all.size()];
      if (!sample(scene.scene, p, x, r.next_vec2(), point)) continue;
      if (dot(point.wi, is_flat ? n : random_direction(r)) <= 0) continue;
      ++seen;
      CHECK(estimates[0] > 0);
    }
  }
  CHECK(seen > 10000);
}

TEST_CASE(
    "many lights: sampling is unbiased, and its error agrees with the allowed and the estimated "
    "error") {
  const PreparedScene scene(room_of_lights(20));
  const WaveIntegrator fixed = fixed_integrator(scene, 4);
  constexpr uint32_t samples = 16;
  for (const double error : {0.005, 0.02})
    for (const Vec3& point : floor_points) {
      const WaveIntegrator drawn = certified_of_pixel(scene, error, samples);
      const Ray ray = ray_to(point);
      const Probed reference = probe(fixed, ray, 4, 24, 3);
      const Probed got = probe(drawn, ray, samples, 300, 5);
      CAPTURE(error);
      CAPTURE(point.x);
      CHECK(p_of_difference(got.direct, reference.direct) > 1e-4);
      const double deviation = std::sqrt(got.direct.variance_of_mean() * 300);
      const Sent told = told_by(drawn, ray, samples, 100);
      MESSAGE("allowed ", error, ": ", told.rays, " rays per viewing ray, deviation ",
              deviation / unoccluded(scene, point), " of the unoccluded light, told ",
              std::sqrt(told.variance) / unoccluded(scene, point), "; seen ",
              got.direct.mean() / unoccluded(scene, point));
      CHECK(deviation > 0);
      // The table, posts and the beam hide lights here and there, which is worse than one shadow
      // edge.
      CHECK(deviation < 2 * error * unoccluded(scene, point));
      CHECK(std::sqrt(told.variance) > deviation);
      CHECK(std::sqrt(told.variance) < 4 * deviation);
    }
}

TEST_CASE("many lights: the cost of a hit hardly grows with their number") {
  const auto cost = [](uint32_t n) {
    const PreparedScene scene(room_of_lights(n));
    const WaveIntegrator drawn = certified_of_pixel(scene, 0.01, 16);
    const auto scratch = drawn.make_scratch();
    RadianceBatch batch;
    Counters counters;
    for (const Vec3& point : floor_points) {
      const ViewingRays rays = repeated(ray_to(point), 9, 16);
      batch.reset(rays.size());
      drawn.radiance(rays, *scratch, batch, counters);
    }
    return double(counters.shadow_rays + counters.lit_certified + counters.masked +
                  counters.dark_certified + counters.mixed) /
           (4 * 16);
  };
  const double few = cost(10), many = cost(50);
  MESSAGE("100 lights: ", few, " answers and rays per viewing ray; 2500: ", many);
  CHECK(many < 2 * few);
  CHECK(many < 30);
}

TEST_CASE("many lights: coats and gloss, sharp or dull, get their light once at no greater cost") {
  for (const float roughness : {0.05f, 0.3f}) {
    Scene s = room_of_lights(12);
    Material& m = s.materials[0];
    m.kind = MaterialKind::coated_diffuse;
    m.roughness.value = roughness;
    const PreparedScene scene(std::move(s));
    const WaveIntegrator fixed = fixed_integrator(scene, 4);
    constexpr uint32_t samples = 16;
    const WaveIntegrator drawn = certified_of_pixel(scene, 0.02, samples);
    for (const Vec3& point : floor_points) {
      const Ray ray = ray_to(point);
      const Probed reference = probe(fixed, ray, 16, 24, 3);
      const Probed got = probe(drawn, ray, samples, 200, 5);
      CAPTURE(roughness);
      CAPTURE(point.x);
      CHECK(p_of_difference(got.direct, reference.direct) > 1e-4);
      CHECK(told_by(drawn, ray, samples, 10).rays < 40);
    }
  }
}

TEST_CASE("many lights: curved meshes take few rays, without bias, over matte and glossy floors") {
  for (const float roughness : {-1.0f, 0.05f, 0.3f}) {
    Scene s = room_of_lights(0);
    for (int i = 0; i < 4; ++i)
      add_ball_light(s, {-1.2f + 0.8f * float(i), 0.5f - 0.4f * float(i), 1.9f}, 0.15f, 6 + 2 * i,
                     Rgb{10});
    if (roughness > 0) {
      s.materials[0].kind = MaterialKind::coated_diffuse;
      s.materials[0].roughness.value = roughness;
    }
    const PreparedScene scene(std::move(s));
    const WaveIntegrator fixed = fixed_integrator(scene, 64);
    constexpr uint32_t samples = 16;
    const WaveIntegrator drawn = certified_of_pixel(scene, 0.01, samples);
    for (const Vec3& point : floor_points) {
      const Ray ray = ray_to(point);
      const Probed reference = probe(fixed, ray, 8, 24, 3);
      const Probed got = probe(drawn, ray, samples, 200, 5);
      CAPTURE(roughness);
      CAPTURE(point.x);
      CHECK(p_of_difference(got.direct, reference.direct) > 1e-4);
      CHECK(told_by(drawn, ray, samples, 10).rays < 20);
      // Some of the spread is that of the lobe's own ray.
      CHECK(std::sqrt(got.direct.variance_of_mean() * 200) <
            (roughness > 0 ? 0.15 : 0.02) * got.direct.mean());
    }
  }
}

namespace {

// Lights a scene like further rays of a pixel: light samples replace certificates where those cost
// more.
WaveIntegrator drawn_or_certified(const PreparedScene& scene, int draws,
                                  int matte_draw_factor = 1) {
  CertifiedSettings settings = certified_settings(0.1, scene.scene.lights.size());
  settings.draws = draws;
  settings.matte_draw_factor = matte_draw_factor;
  return {scene,
          std::make_unique<CertifiedDirect>(scene, std::make_shared<const Occluders>(scene.scene),
                                            settings),
          nullptr};
}

// A room with eight lights and a net of many small strips over the floor at x < 0.
Scene room_with_net() {
  Scene s = room_of_lights(2);
  for (const Vec3& at : {Vec3{-2, -1, 2}, {-1, -1, 2}, {-2, 0.4f, 2}, {-1, 0.4f, 2}})
    make_light(
        s,
        add_quad(s, 0,
                 {at, at + Vec3{0, 0.6f, 0}, at + Vec3{0.6f, 0.6f, 0}, at + Vec3{0.6f, 0, 0}}),
        Rgb{5});
  for (int i = 0; i < 40; ++i)
    for (int k = 0; k < 40; ++k) {
      const Vec3 at{-3 + 0.07f * float(i), -1.4f + 0.07f * float(k), 0.2f};
      add_quad(s, 0,
               {at, at + Vec3{0.03f, 0, 0}, at + Vec3{0.03f, 0.06f, 0}, at + Vec3{0, 0.06f, 0}});
    }
  return s;
}

Counters counted(const Integrator& integrator, const Ray& ray) {
  const auto scratch = integrator.make_scratch();
  RadianceBatch batch;
  Counters counters;
  const ViewingRays rays = repeated(ray, 3, 64);
  batch.reset(rays.size());
  integrator.radiance(rays, *scratch, batch, counters);
  return counters;
}

}  // namespace

TEST_CASE("few lights: certified in the open and sampled behind a net, with the same mean") {
  const PreparedScene scene(room_with_net());
  const Vec3 in_the_open{2, 0, 0}, below_the_net{-1.5f, 0, 0};
  const WaveIntegrator some = drawn_or_certified(scene, 5), none = drawn_or_certified(scene, 0);
  const Counters open = counted(some, ray_to(in_the_open));
  CHECK(open.mixed == 0);
  CHECK(open.lit_certified + open.dark_certified + open.masked == 8 * 64);
  // All hits but the first few sample all lights at once; the ray goes up.
  Ray up = ray_towards(below_the_net + Vec3{0.02f, 0.01f, 0.15f}, below_the_net);
  const Counters net = counted(some, up);
  CHECK(net.mixed >= 60);
  CHECK(net.masked <= 8 * 4);
  CHECK(net.shadow_rays > 0);
  for (const Ray& ray : {up, ray_to(in_the_open)}) {
    const Moments a = probe(some, ray, 32, 100).direct, b = probe(none, ray, 32, 100, 9).direct;
    CAPTURE(a.mean());
    CAPTURE(b.mean());
    const double sigma = std::sqrt(a.variance_of_mean() + b.variance_of_mean());
    CHECK(b.mean() > 0);
    CHECK(std::abs(a.mean() - b.mean()) < 5 * sigma + 0.003 * b.mean());
  }
}

TEST_CASE("few lights: matte hits sample several times more points, with the same mean") {
  const Vec3 below_the_net{-1.5f, 0, 0};
  const Ray up = ray_towards(below_the_net + Vec3{0.02f, 0.01f, 0.15f}, below_the_net);
  for (const bool is_glossy : {false, true}) {
    CAPTURE(is_glossy);
    Scene s = room_with_net();
    if (is_glossy) {
      s.materials[0].kind = MaterialKind::coated_diffuse;
      s.materials[0].roughness.value = 0.3f;
    }
    const PreparedScene scene(std::move(s));
    const WaveIntegrator once = drawn_or_certified(scene, 2),
                         twice = drawn_or_certified(scene, 2, 2),
                         none = drawn_or_certified(scene, 0);
    const auto few = double(counted(once, up).shadow_rays),
               many = double(counted(twice, up).shadow_rays);
    CHECK(few > 64);
    CHECK(many / few == doctest::Approx(is_glossy ? 1 : 2).epsilon(0.15));
    const Moments a = probe(twice, up, 32, 100).direct, b = probe(none, up, 32, 100, 9).direct;
    CHECK(std::abs(a.mean() - b.mean()) <
          5 * std::sqrt(a.variance_of_mean() + b.variance_of_mean()) + 0.003 * b.mean());
  }
}

// If lights were chosen by what they send to a cluster as a whole, rays that happen to hit a near
// strip would bring many times what arrives, as bright dots.
TEST_CASE("few lights: sampled light is never far above unoccluded light") {
  Scene s = room_of_lights(4);
  constexpr float low = 0.03f;  // metres over the floor: a strip of 2 m × 2 cm
  make_light(s,
             add_quad(s, 0, {Vec3{-1, -2, low}, {-1, -1.98f, low}, {1, -1.98f, low}, {1, -2, low}}),
             Rgb{20});
  const PreparedScene scene(std::move(s));
  CertifiedSettings settings = certified_settings(0.1, scene.scene.lights.size());
  settings.draws = 8;
  const WaveIntegrator integrator(
      scene,
      std::make_unique<CertifiedDirect>(scene, std::make_shared<const Occluders>(scene.scene),
                                        settings),
      nullptr);
  ViewingRays rays;
  std::vector<Vec3> points;
  for (uint32_t i = 0; i < 4; ++i)
    for (uint32_t k = 0; k < 4; ++k) {  // few hits, for which certificates would cost more
      points.push_back({0.85f + 0.06f * float(i), -2.15f + 0.05f * float(k), 0});
      rays.rays.push_back(ray_to(points.back()));
    }
  rays.streams.resize(points.size());
  rays.samples.assign(points.size(), 0);
  const auto scratch = integrator.make_scratch();
  double most = 0, sum = 0, all = 0;
  for (uint64_t set = 0; set < 64; ++set) {
    for (size_t i = 0; i < rays.streams.size(); ++i) rays.streams[i] = hash_of(set, uint64_t(i));
    RadianceBatch batch;
    Counters counters;
    batch.reset(rays.size());
    integrator.radiance(rays, *scratch, batch, counters);
    CHECK(counters.shadow_rays > 2 * rays.size());
    for (size_t i = 0; i < points.size(); ++i) {
      const double open = unoccluded(scene, points[i]);
      most = std::max(most, double(batch.direct[i].g) / open);
      sum += double(batch.direct[i].g);
      all += open;
    }
  }
  CAPTURE(most);
  CHECK(most < 1.7);
  CHECK(sum < all);
  CHECK(sum > 0.8 * all);
}

// If it were left to the lobe's rays alone, a few rays would bring all of the light.
TEST_CASE(
    "a lamp without certificates is weighted against gloss rays, however few lights there are") {
  Scene s;
  add_quad(s, add_metal(s, 0.6f), {Vec3{-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}});
  add_ball_light(s, {-0.5f, -0.3f, 1.2f}, 0.2f, 16, Rgb{20});
  const PreparedScene scene(std::move(s));
  const Ray ray = ray_towards({2.2f, 1, 1.6f}, {0.9f, 0.4f, 0});
  const Probed got = probe(certified_integrator(scene, 0.05), ray, 1, 2000, 5);
  const Probed reference = probe(fixed_integrator(scene, 64), ray, 16, 64, 3);
  CHECK(p_of_difference(got.direct, reference.direct, 1e-3 * reference.direct.mean()) > 1e-4);
  const double deviation = std::sqrt(got.direct.variance_of_mean() * 2000) / got.direct.mean();
  CHECK(deviation < 0.02);
}

}  // namespace test_drawn_lights
