// Spheres and integrands by certified visibility against brute force.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "base/frame.h"
#include "base/warp.h"
#include "brute_force.h"
#include "light/irradiance.h"
#include "shadow/sphere_outline.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// Returns the visible share of the sphere's irradiance, by n² directions uniform in its cone.
double reference_share(const BruteForceScene& scene, const SphereSource& s, const ShadowReceiver& x,
                       int n) {
  const Vec3d axis = s.centre - Vec3d(x.position);
  const double distance = length(axis), sine2 = sqr(s.radius / distance);
  const Framed frame(axis / distance);
  double all = 0, seen = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      // uniform in solid angle: 1 - cos is uniform
      const double cosine = 1 - (1 - std::sqrt(1 - sine2)) * (i + 0.5) / n;
      const double r = std::sqrt(1 - cosine * cosine), a = 2 * pi * (j + 0.5) / n;
      const Vec3d d = frame.to_world({r * std::cos(a), r * std::sin(a), cosine});
      const double weight = std::max(dot(d, Vec3d(x.normal)), 0.0);
      if (weight == 0) continue;
      all += weight;
      const double along = distance * cosine;
      const double half = std::sqrt(std::max(sqr(s.radius) - sqr(distance) + sqr(along), 0.0));
      if (scene.is_hidden(Vec3d(x.origin), Vec3d(x.position) + d * (along - half), 0) != 1)
        seen += weight;
    }
  return all > 0 ? seen / all : 0;
}

SphereSource random_sphere(Random& r) {
  return {{r.next_double() - 0.5, r.next_double() - 0.5, 1.2 + r.next_double()},
          0.05 + 0.5 * r.next_double()};
}

}  // namespace

TEST_CASE("spheres: exact where unoccluded, else shares by the disk that they span") {
  double error2 = 0, mean = 0, predicted2 = 0;
  int pairs = 0, lit = 0, mixed = 0;
  for (uint64_t seed = 0; seed < 200; ++seed) {
    Random r(seed + 311);
    BruteForceScene scene;
    const SphereSource source = random_sphere(r);
    if (seed % 4 != 0) add_random_facets(r, scene);
    const std::vector<ShadowReceiver> receivers = random_receivers(r, 4);
    CertifiedOptions options;
    options.lattice = fine_lattice;
    FoundFacets found;
    std::vector<SourceVisibility> out(receivers.size());
    evaluate_alone(options, source, receivers, scene, found, out);
    for (size_t i = 0; i < receivers.size(); ++i) {
      const Vec3d x(receivers[i].position), n(receivers[i].normal);
      CHECK(double(out[i].unoccluded) ==
            doctest::Approx(sphere_irradiance(source.centre, source.radius, x, n)));
      if (out[i].unoccluded < 1e-4f) continue;
      const double e = double(out[i].visible) - reference_share(scene, source, receivers[i], 80);
      if (out[i].answer == ShadowAnswer::lit) {
        CHECK(out[i].visible == 1);
        CHECK(std::abs(e) < 1e-6);
        ++lit;
        continue;
      }
      mixed += out[i].answer == ShadowAnswer::mixed;
      error2 += e * e;
      predicted2 += double(out[i].variance);
      mean += e;
      ++pairs;
    }
  }
  MESSAGE(pairs, " pairs, ", mixed, " with rays, ", lit, " lit: rms error ",
          std::sqrt(error2 / pairs), ", told ", std::sqrt(predicted2 / pairs));
  CHECK(pairs > 300);
  CHECK(lit > 100);
  CHECK(std::sqrt(error2 / pairs) < 0.01);
  CHECK(std::abs(mean / pairs) < 0.001);
  CHECK(error2 < 1.2 * predicted2);
  CHECK(predicted2 < 9 * error2);
}

TEST_CASE("a shaft to a sphere contains every segment to its visible part") {
  size_t tested = 0;
  for (uint64_t seed = 0; seed < 4000; ++seed) {
    Random r(seed + 2000000);
    const SphereSource sphere = random_sphere(r);
    const std::vector<ShadowReceiver> receivers = random_receivers(r, 12);
    std::vector<Vec3> origins, normals;
    for (const ShadowReceiver& x : receivers) {
      origins.push_back(x.origin);
      normals.push_back(x.normal);
    }
    const ReceiverHull hull = bound_receivers(origins, normals);
    if (is_near(sphere, hull)) continue;
    const Shaft shaft = make_shaft(hull, sphere.centre, sphere.radius, 10);
    for (int k = 0; k < 20; ++k) {
      const ShadowReceiver& x = receivers[size_t(r.next_float() * 12)];
      const Vec3d from(x.origin), out = normalize(Vec3d(random_vector(r, 1)));
      const Vec3d to = sphere.centre + out * sphere.radius;
      if (dot(from - to, out) <= 0) continue;
      const Vec3d p = from + (to - from) * (1 - sqr(r.next_double()));
      if (dot(p - from, Vec3d(x.normal)) <= 0) continue;
      ++tested;
      for (const Plane& plane : shaft.all())
        CHECK(dot(Vec3d(plane.normal), p) <= double(plane.distance));
    }
  }
  CHECK(tested > 20000);
}

TEST_CASE(
    "a wide cluster sees past the plane through a sphere's centre: a plate there counts as an "
    "occluder") {
  const SphereSource source{{0, 0, 2.5}, 0.1};
  for (const float size : {0.3f, 1.0f, 2.5f, 6.0f}) {
    BruteForceScene scene;  // a plate 5 mm in front of the centre
    scene.facets = {parallelogram_facet({-0.3f, -0.3f, 2.505f}, {0.6f, 0, 0}, {0, 0.6f, 0})};
    std::vector<ShadowReceiver> receivers;
    for (int i = 0; i < 64; ++i) {
      const Vec3 p{size * (float(i % 8) / 7 - 0.5f), size * (float(i / 8) / 7 - 0.5f), 0};
      receivers.push_back({p, {0, 0, 1}, {0, 0, 1}, p + Vec3{0, 0, 4e-6f}, uint64_t(i)});
    }
    std::vector<SourceVisibility> out(receivers.size());
    FoundFacets found;
    evaluate_alone({}, source, receivers, scene, found, out);
    for (size_t i = 0; i < out.size(); ++i) {
      const double expected = reference_share(scene, source, receivers[i], 100);
      CAPTURE(size);
      CAPTURE(i);
      CAPTURE(expected);
      CHECK((expected == 1 || out[i].answer != ShadowAnswer::lit));
    }
  }
}

TEST_CASE("a sphere is not hidden by facets inside it") {
  const SphereSource source{{0, 0, 2}, 0.5};
  BruteForceScene scene;
  // a socket: a plate through the sphere's middle, as wide as the sphere
  scene.facets = {parallelogram_facet({-0.45f, -0.2f, 2}, {0.9f, 0, 0}, {0, 0.4f, 0})};
  const ShadowReceiver x{{0, 0, 0}, {0, 0, 1}, {0, 0, 1}, {0, 0, 4e-6f}, 5};
  const CertifiedOptions options;
  FoundFacets found;
  SourceVisibility out;
  evaluate_alone(options, source, {&x, 1}, scene, found, {&out, 1});
  CHECK(double(out.visible) == doctest::Approx(1).epsilon(0.02));
}

namespace {

// A lobe around a direction, times a source that is brighter on one side.
class Lobe final : public ShadowIntegrand {
 public:
  Vec3 x, axis;
  uint32_t points(uint32_t, uint32_t) override { return 32; }
  static Rgb at(const Vec3& x, const Vec3& axis, const Vec3& p) {
    const Vec3 d = normalize(p - x);
    return Rgb{std::pow(std::max(dot(d, axis), 0.0f), 20.0f), 1 + p.x, 1};
  }
  void evaluate(uint32_t, uint32_t, std::span<const Vec3> points, std::span<Rgb> values) override {
    for (size_t i = 0; i < points.size(); ++i) values[i] = at(x, axis, points[i]);
  }
};

}  // namespace

TEST_CASE("integrals over the visible part are unbiased, with complete lists and with rays") {
  const FlatSource source{{{-0.8, -0.7, 2}, {1.5, 0, 0}, {0.2, 1.4, 0}, {0, 0, -1}}, {}};
  BruteForceScene scene;
  scene.facets = {parallelogram_facet({0.1f, -0.4f, 1.1f}, {0.7f, 0.1f, 0.05f}, {-0.1f, 0.6f, 0}),
                  parallelogram_facet({-0.5f, -0.5f, 0.6f}, {0.02f, 0, 0}, {0.1f, 0.9f, 0.3f}),
                  parallelogram_facet({-0.2f, 0.1f, 1.9f}, {0.2f, 0, 0.1f}, {0, 0.2f, 0.2f})};
  const Vec3 n = normalize(Vec3{0.2f, 0.1f, 1});
  ShadowReceiver x{{0.05f, -0.1f, 0}, n, n, Vec3{0.05f, -0.1f, 0} + n * 4e-6f, 0};
  Lobe lobe;
  lobe.x = x.position;
  lobe.axis = normalize(Vec3{0.1f, 0.3f, 1});
  double expected[3] = {0, 0, 0};
  constexpr int grid = 1200;
  for (int i = 0; i < grid; ++i)
    for (int j = 0; j < grid; ++j) {
      const Vec3d y = source.plane.origin + source.plane.u * ((i + 0.5) / grid) +
                      source.plane.v * ((j + 0.5) / grid);
      const Vec3d d = y - Vec3d(x.position);
      const double w = std::max(dot(d, Vec3d(n)), 0.0) * d.z / sqr(length_squared(d)) * 2.1 /
                       (double(grid) * grid);
      if (w == 0 || scene.is_hidden(Vec3d(x.origin), y, 0) == 1) continue;
      const Rgb v = Lobe::at(lobe.x, lobe.axis, Vec3(y));
      expected[0] += w * double(v.r);
      expected[1] += w * double(v.g);
      expected[2] += w * double(v.b);
    }
  for (const bool is_complete : {true, false}) {
    CertifiedOptions options;
    options.longest_list = is_complete ? 64 : 1;
    options.most_halvings = 0;
    double sum[3] = {}, sum2[3] = {}, told = 0;
    constexpr int seeds = 4000;
    for (int i = 0; i < seeds; ++i) {
      FoundFacets found;
      x.stream = hash_of(uint64_t(i), 15u);
      SourceVisibility out;
      evaluate_alone(options, source, {&x, 1}, scene, found, {&out, 1}, &lobe);
      CHECK(out.answer == (is_complete ? ShadowAnswer::masked : ShadowAnswer::mixed));
      const double v[3] = {double(out.value.r), double(out.value.g), double(out.value.b)};
      for (size_t c = 0; c < 3; ++c) {
        sum[c] += v[c];
        sum2[c] += v[c] * v[c];
      }
      told += double(out.value_variance);
    }
    for (size_t c = 0; c < 3; ++c) {
      const double mean = sum[c] / seeds, variance = sum2[c] / seeds - mean * mean;
      CAPTURE(c);
      CAPTURE(is_complete);
      CHECK(std::abs(mean - expected[c]) < 4 * std::sqrt(variance / seeds) + 3e-4 * expected[c]);
      if (c == 1) CHECK(variance < 2 * told / seeds);
    }
  }
}

namespace {

class Constant final : public ShadowIntegrand {
 public:
  uint32_t points(uint32_t, uint32_t) override { return 8; }
  void evaluate(uint32_t, uint32_t, std::span<const Vec3>, std::span<Rgb> values) override {
    std::fill(values.begin(), values.end(), Rgb{1});
  }
};

}  // namespace

TEST_CASE("a slit that most masks miss counts in an integral with its width") {
  const FlatSource source{{{-0.5, -0.5, 2}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}}, {}};
  constexpr double edge = 0.497;  // of the plate's shadow; the slit is narrower than a sample
  const auto plate_edge = float(edge * 1.9 / 2);
  BruteForceScene scene;
  scene.facets = {parallelogram_facet({-4, -4, 1.9f}, {4 + plate_edge, 0, 0}, {0, 8, 0}),
                  parallelogram_facet({-0.2f, -0.2f, 1}, {0.1f, 0, 0}, {0, 0.1f, 0}),
                  parallelogram_facet({0.1f, -0.2f, 1}, {0.05f, 0, 0}, {0, 0.1f, 0})};
  const std::vector<Vec3d> slit{{edge, -0.5, 2}, {edge, 0.5, 2}, {0.5, 0.5, 2}, {0.5, -0.5, 2}};
  const double expected = polygon_irradiance(slit, {0, 0, 0}, {0, 0, 1}, Sides::both);
  CertifiedOptions options;
  options.longest_list = 1;
  options.most_halvings = 0;
  Constant integrand;
  for (const bool has_integrand : {true, false}) {
    double sum = 0, sum2 = 0;
    int misses = 0;
    constexpr int seeds = 6000;
    for (int i = 0; i < seeds; ++i) {
      FoundFacets found;
      const ShadowReceiver x{{0, 0, 0}, {0, 0, 1}, {0, 0, 1}, {0, 0, 0}, hash_of(uint64_t(i), 21u)};
      SourceVisibility out;
      evaluate_alone(options, source, {&x, 1}, scene, found, {&out, 1},
                     has_integrand ? &integrand : nullptr);
      REQUIRE(found.is_over_budget());
      const double value =
          has_integrand ? double(out.value.g) : double(out.visible) * double(out.unoccluded);
      misses += value == 0;
      sum += value;
      sum2 += value * value;
    }
    const double mean = sum / seeds, variance = sum2 / seeds - mean * mean;
    CAPTURE(has_integrand);
    CAPTURE(mean);
    if (has_integrand) CHECK(misses > 0);  // rays have random end points
    CHECK(std::abs(mean - expected) < 4 * std::sqrt(variance / seeds) + 2e-3 * expected);
  }
}
