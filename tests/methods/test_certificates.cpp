// Certificates by the whole chain (the hierarchy of facets and its single-precision tests included)
// against rays in double precision. The variable TROFFER_CERTIFICATE_SCENES sets the number of
// scenes.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "certificate_scenes.h"
#include "certified/open_parts.h"
#include "certified/shadow_world.h"
#include "probe.h"
#include "shadow/certified_light.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// Returns M, the largest coordinate of the scene, its receivers and its source.
double magnitude_of(const CertificateScene& s) {
  double m = 0;
  const auto grow = [&](const Vec3d& p) {
    m = std::max({m, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  };
  for (const Mesh& mesh : s.scene.meshes)
    for (const Vec3& p : mesh.positions) grow(Vec3d(p));
  for (const ShadowReceiver& x : s.receivers) grow(Vec3d(x.origin));
  if (s.shape == SourceShape::sphere)
    grow(s.sphere.centre);
  else if (!s.is_far())
    for (const Vec3d& c : s.flat.corners()) grow(c);
  return m;
}

// Returns 1 if the segment passes through the triangle's inside, at least `tolerance` from its
// edges and with both ends at least as far from its plane. Returns 0 if it misses the triangle by
// that much, else -1.
int meets(const Vec3d& from, const Vec3d& to, const Vec3d& a, const Vec3d& b, const Vec3d& c,
          double tolerance) {
  const Vec3d normal = cross(b - a, c - a);
  const double size = length(normal);
  if (!(size > 0)) return -1;
  const double h0 = dot(normal, from - a) / size, h1 = dot(normal, to - a) / size;
  if ((h0 > tolerance && h1 > tolerance) || (h0 < -tolerance && h1 < -tolerance)) return 0;
  const bool crosses = (h0 > tolerance && h1 < -tolerance) || (h0 < -tolerance && h1 > tolerance);
  if (!crosses) return -1;
  const Vec3d p = from + (to - from) * (h0 / (h0 - h1));
  const Vec3d corners[3] = {a, b, c};
  bool is_near = false;
  for (size_t i = 0; i < 3; ++i) {
    const Vec3d &v = corners[i], &w = corners[(i + 1) % 3];
    const double side = dot(cross(w - v, p - v), normal) / size / length(w - v);
    if (side < -tolerance) return 0;
    is_near = is_near || side < tolerance;
  }
  return is_near ? -1 : 1;
}

// The same for a sphere, which hides nothing from within.
int meets(const Vec3d& from, const Vec3d& to, const Sphere& s, double tolerance) {
  const Vec3d a = Vec3d(s.centre) - from, d = to - from;
  const double t = std::clamp(dot(a, d) / length_squared(d), 0.0, 1.0);
  const double inside = double(s.radius) - length(a - d * t);
  if (inside < -tolerance) return 0;
  const double ends = std::min(length(a), length(a - d));
  return inside < tolerance || ends < double(s.radius) + tolerance ? -1 : 1;
}

// The same for a disk.
int meets(const Vec3d& from, const Vec3d& to, const Disk& disk, double tolerance) {
  const Vec3d n = normalize(Vec3d(disk.normal)), c(disk.centre);
  const double h0 = dot(n, from - c), h1 = dot(n, to - c);
  if (std::abs(h0) < tolerance || std::abs(h1) < tolerance) return -1;
  if ((h0 > 0) == (h1 > 0)) return 0;
  const double inside = double(disk.radius) - length(from + (to - from) * (h0 / (h0 - h1)) - c);
  return inside > tolerance ? 1 : inside < -tolerance ? 0 : -1;
}

// The same over everything that may hide a source: surely hidden, surely free, or neither.
int is_hidden(const CertificateScene& scene, const Occluders& occluders, const Vec3d& from,
              const Vec3d& to, double tolerance) {
  int answer = 0;
  const auto look = [&](int met) {
    if (answer != 1 && met != 0) answer = met;
  };
  const size_t own = scene.shape == SourceShape::sphere ? 1 : 0;  // the source is the first sphere
  for (size_t i = own; i < scene.scene.spheres.size(); ++i)
    look(meets(from, to, scene.scene.spheres[i], 4 * tolerance));
  for (const Disk& d : scene.scene.disks) look(meets(from, to, d, 4 * tolerance));
  if (answer == 1) return 1;
  for (uint32_t f = 0; f < occluders.facet_count(); ++f) {
    const Quad& q = occluders.facet(f);
    const Vec3d a(q[0]), b(q[1]), c(q[2]), d(q[3]);
    const int first = meets(from, to, a, b, c, tolerance);
    const int second = is_triangle(q) ? 0 : meets(from, to, a, c, d, tolerance);
    if (first == 1 || second == 1) return 1;
    if (first < 0 || second < 0) answer = -1;
  }
  return answer;
}

// True if y, in the source's plane, belongs to the source.
bool is_on(const FlatSource& s, const Vec3d& y) {
  const Vec3d d = y - s.plane.origin, n = cross(s.plane.u, s.plane.v);
  const double u = dot(cross(d, s.plane.v), n) / length_squared(n);
  const double v = dot(cross(s.plane.u, d), n) / length_squared(n);
  if (u < 0 || u > 1 || v < 0 || v > 1) return false;
  if (s.is_disk) return sqr(u - 0.5) + sqr(v - 0.5) <= 0.25;
  for (size_t i = 0; i < s.outline.size(); ++i) {
    const Vec2d a(s.outline[i]), b(s.outline[(i + 1) % s.outline.size()]);
    if ((b.x - a.x) * (v - a.y) - (b.y - a.y) * (u - a.x) < 0) return false;
  }
  return true;
}

// Sets `end` of the segment from x that reaches the source in the direction of `through`; false if
// there is none. Anything within 2e-6 M of a flat source's plane counts as lying in it
// (docs/method/certified.md, "Shafts"). Where light is claimed, the segment ends where that `slab`
// begins.
bool aim(const CertificateScene& s, const Vec3d& x, const Vec3d& through, double slab, Vec3d& end) {
  const Vec3d d = through - x;
  if (s.shape == SourceShape::sphere) {
    const Vec3d c = s.sphere.centre - x;
    const double along = dot(c, d) / length_squared(d), off2 = length_squared(c - d * along);
    const double inside2 = sqr(s.sphere.radius) - off2;
    if (!(along > 0) || inside2 < 0) return false;
    end = x + d * (along - std::sqrt(inside2 / length_squared(d)));
    return true;
  }
  const Vec3d& n = s.flat.plane.normal;
  const double height = dot(n, x - s.flat.plane.origin), fall = -dot(n, d);
  if (height < 2 * slab || !(fall > 0) || !is_on(s.flat, x + d * (height / fall))) return false;
  end = x + d * ((height - slab) / fall);
  return true;
}

// Returns a point of the source, often close to its outline.
Vec3d point_of_source(const CertificateScene& s, Random& r) {
  if (s.shape == SourceShape::sphere)
    return s.sphere.centre + normalize(random_in_cube(r)) * (s.sphere.radius * r.next_double());
  const std::vector<Vec3d> corners = s.flat.corners();
  Vec3d sum;
  double weights = 0;
  const double power = r.next_double() < 0.5 ? 1 : 12;
  for (const Vec3d& c : corners) {
    const double weight = std::pow(r.next_double(), power);
    sum += c * weight;
    weights += weight;
  }
  return sum / weights;
}

// Returns a point near the rim of a sphere or disk, as seen from x.
Vec3d point_at_rim(const Scene& scene, const Vec3d& x, Random& r) {
  const size_t n = scene.spheres.size() + scene.disks.size();
  const size_t i = std::min(size_t(r.next_double() * double(n)), n - 1);
  const double off = 1 + (r.next_double() - 0.5) * log_uniform(r, 1e-5, 1);
  if (i >= scene.spheres.size()) {
    const Disk& d = scene.disks[i - scene.spheres.size()];
    const Vec3d way = cross(Vec3d(d.normal), random_in_cube(r));
    return Vec3d(d.centre) + normalize(way) * (double(d.radius) * off);
  }
  const Sphere& s = scene.spheres[i];
  const Vec3d way = Vec3d(s.centre) - x;
  return Vec3d(s.centre) + normalize(cross(way, random_in_cube(r))) * (double(s.radius) * off);
}

// Returns a point where a ray may contradict a certificate: inside a facet, or just past its edge.
Vec3d point_at_facet(const Occluders& occluders, double tolerance, Random& r) {
  const Quad& q = occluders.facet(uint32_t(r.next_double() * double(occluders.facet_count())));
  const size_t i = size_t(r.next_double() * 4), j = (i + 1 + size_t(r.next_double() * 3)) % 4;
  const Vec3d centre = (Vec3d(q[0]) + Vec3d(q[1]) + Vec3d(q[2]) + Vec3d(q[3])) * 0.25;
  const double t = r.next_double();
  const Vec3d rim = Vec3d(q[i]) * t + Vec3d(q[j]) * (1 - t), inwards = centre - rim;
  const double size = length(inwards);
  if (!(size > 0)) return rim;
  const double step = r.next_double() < 0.3
                          ? size * r.next_double()
                          : std::min(tolerance * std::pow(10.0, 2 * r.next_double()), size);
  return rim + inwards * (step / size * (r.next_double() < 0.5 ? 1 : -1));
}

std::vector<SourceVisibility> answers_of(const CertificateScene& s, const Occluders& occluders,
                                         ShadowScene& world) {
  std::vector<SourceVisibility> out(s.receivers.size());
  ShadowCluster cluster;
  cluster.set(s.receivers);
  FoundFacets found;
  LightRequest request{&s.flat, nullptr, 1, 1, &found};
  if (s.shape == SourceShape::sphere) request = {nullptr, &s.sphere, 1, 1, &found};
  const LargeFacets far = large_facets(occluders);
  if (s.is_far()) request.far = &far;
  CertifiedMemory memory;
  CertifiedOptions options;
  options.rays.most_rays = options.rays.most_pair_rays = 1;  // rays are not under test
  certified_light(cluster, {&request, 1}, nullptr, world, options, memory,
                  [&](uint32_t, std::span<const SourceVisibility> answers) {
                    std::copy(answers.begin(), answers.end(), out.begin());
                  });
  return out;
}

struct Tally {
  size_t lit = 0, dark = 0, rays = 0, contradictions = 0;
};

void check_scene(uint64_t seed, std::array<Tally, source_shapes>& tallies) {
  const CertificateScene s = random_certificate_scene(seed);
  const Occluders occluders(s.scene);
  const Tracer tracer(s.scene);
  ShadowWorld world(s.scene, occluders, tracer);
  const std::vector<SourceVisibility> answers = answers_of(s, occluders, world);
  const double magnitude = magnitude_of(s), tolerance = 1e-7 * magnitude;
  Tally& tally = tallies[size_t(s.shape)];
  Random r(hash_of(seed, 8u));
  for (size_t i = 0; i < answers.size(); ++i) {
    const bool is_lit = answers[i].answer == ShadowAnswer::lit;
    if (!is_lit && answers[i].answer != ShadowAnswer::dark) continue;
    ++(is_lit ? tally.lit : tally.dark);
    const ShadowReceiver& receiver = s.receivers[i];
    const Vec3d x(receiver.origin), p(receiver.position);
    for (int k = 0; k < 24; ++k) {
      Vec3d end;
      const bool has_round = s.scene.spheres.size() + s.scene.disks.size() > 0;
      const Vec3d through = has_round && k % 4 == 1 ? point_at_rim(s.scene, x, r)
                            : k % 4 == 0 || occluders.facet_count() == 0
                                ? point_of_source(s, r)
                                : point_at_facet(occluders, tolerance, r);
      if (!aim(s, x, through, is_lit && !s.is_far() ? 2.01e-6 * magnitude : 0, end)) continue;
      const double least = 5e-6 * (s.is_far() ? length(end - p) : magnitude);
      if (dot(end - p, Vec3d(receiver.horizon)) <= least) continue;
      if (dot(end - p, Vec3d(receiver.normal)) <= least) continue;
      ++tally.rays;
      const int hidden = is_hidden(s, occluders, x, end, tolerance);
      if (hidden < 0 || (hidden == 1) != is_lit) continue;
      if (tally.contradictions++ < 3)
        MESSAGE("seed ", seed, ", shape ", int(s.shape), ", receiver ", i, ": ",
                std::string(is_lit ? "lit, yet hidden" : "dark, yet free"), ", magnitude ",
                magnitude);
    }
  }
}

}  // namespace

TEST_CASE("certificates are never contradicted: real extents, all shapes, far from the origin") {
  const char* wanted = std::getenv("TROFFER_CERTIFICATE_SCENES");
  const uint64_t scenes = wanted != nullptr ? std::strtoull(wanted, nullptr, 10) : 4000;
  std::array<Tally, source_shapes> tallies;
  for (uint64_t seed = 0; seed < scenes; ++seed) check_scene(seed, tallies);
  Tally all;
  for (size_t i = 0; i < tallies.size(); ++i) {
    const Tally& t = tallies[i];
    MESSAGE("shape ", i, ": ", t.lit, " lit, ", t.dark, " dark, ", t.rays, " rays, ",
            t.contradictions, " contradictions");
    CHECK(t.contradictions == 0);
    all.lit += t.lit;
    all.dark += t.dark;
  }
  CHECK(double(all.lit + all.dark) > 25 * double(scenes));
  CHECK(double(all.dark) > 3 * double(scenes));
}

namespace {

// Direct light at n × n points of the floor, in a square of this size around (x, y), seen from
// `eye`. All points are one batch, so that neighbours form a cluster.
std::vector<double> direct_light(const Integrator& integrator, const Vec3& eye, const Vec2& centre,
                                 float size, int n, uint32_t set) {
  ViewingRays rays;
  for (int i = 0; i < n * n; ++i) {
    const float u = (float(i % n) + 0.5f) / float(n) - 0.5f;
    const float v = (float(i / n) + 0.5f) / float(n) - 0.5f;
    rays.rays.push_back(ray_towards(eye, {centre.x + size * u, centre.y + size * v, 0}));
    rays.streams.push_back(hash_of(uint64_t(i), set));
    rays.samples.push_back(0);
  }
  const auto scratch = integrator.make_scratch();
  RadianceBatch batch;
  Counters counters;
  batch.reset(rays.size());
  integrator.radiance(rays, *scratch, batch, counters);
  std::vector<double> out;
  for (const Rgb& c : batch.direct) out.push_back(double(c.g));
  return out;
}

}  // namespace

// A plate around the sphere, 5 mm above its centre. A wide cluster sees past the plane through the
// centre, and the plate hides some of what it sees there.
TEST_CASE("a thumbnail of a sphere under a canopy agrees with rays") {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  add_quad(s, grey, {Vec3{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}});
  const float z = 2.505f;
  add_quad(s, grey, {Vec3{-0.3f, -0.3f, z}, {0.3f, -0.3f, z}, {0.3f, 0.3f, z}, {-0.3f, 0.3f, z}});
  add_sphere_light(s, grey, {0, 0, 2.5f}, 0.1f, Rgb{10});
  const PreparedScene scene(std::move(s));
  const WaveIntegrator mine = certified_integrator(scene), rays = fixed_integrator(scene, 1024);
  const Vec3 eye{0, 0, 2.3f};
  for (const float size : {0.5f, 2.0f, 5.0f}) {
    constexpr uint32_t sets = 16;
    std::vector<double> a(64, 0), b(64, 0);
    for (uint32_t set = 0; set < sets; ++set) {
      const auto x = direct_light(mine, eye, {0, 0}, size, 8, set);
      const auto y = direct_light(rays, eye, {0, 0}, size, 8, set + sets);
      for (size_t i = 0; i < 64; ++i) {
        a[i] += x[i];
        b[i] += y[i];
      }
    }
    double worst = 0;
    for (size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] / b[i] - 1));
    CAPTURE(size);
    CHECK(worst < 0.01);
  }
}
