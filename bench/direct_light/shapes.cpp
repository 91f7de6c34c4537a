#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/random.h"
#include "base/warp.h"
#include "experiments.h"
#include "generated_scenes.h"
#include "light/irradiance.h"
#include "methods/methods.h"

namespace troffer::bench {

namespace {

void add_polygon(Scene& s, int corners) {
  Mesh m;
  Light e;
  for (int i = 0; i < corners; ++i) {  // clockwise seen from above: it faces down
    const float a = -2 * pi_f * float(i) / float(corners);
    m.positions.push_back({0.6f * std::cos(a), 0.4f * std::sin(a), 2});
  }
  for (uint32_t i = 1; i + 1 < uint32_t(corners); ++i) {
    m.triangles.push_back({0, i, i + 1});
    m.lights.push_back(0);
    e.triangles.push_back(i - 1);
  }
  e.polygon = m.positions;
  e.radiance = Rgb{1};
  s.lights.push_back(e);
  s.meshes.push_back(m);
}

void add_slanted_box(Scene& s) {
  Mesh m;
  add_box(m, {-0.3f, -0.2f, 1.8f}, {0.3f, 0.2f, 2.1f}, 0.5f);
  Light e;
  e.kind = LightKind::mesh;
  e.radiance = Rgb{1};
  for (uint32_t i = 0; i < m.triangles.size(); ++i) {
    e.triangles.push_back(i);
    m.lights.push_back(0);
  }
  s.lights.push_back(e);
  s.meshes.push_back(m);
}

void add_glowing_ball(Scene& s) {
  Mesh m;
  add_ball(m, {0, 0, 2}, 0.3f);
  Light e;
  e.kind = LightKind::mesh;
  e.radiance = Rgb{1};
  for (uint32_t i = 0; i < m.triangles.size(); ++i) {
    e.triangles.push_back(i);
    m.lights.push_back(0);
  }
  s.lights.push_back(e);
  s.meshes.push_back(m);
}

void add_disk(Scene& s) {
  Disk d;
  d.centre = {0, 0, 2};
  d.normal = normalize(Vec3{0.2f, 0.1f, -1});
  d.radius = 0.5f;
  d.light = 0;
  Light e;
  e.kind = LightKind::disk;
  e.radiance = Rgb{1};
  s.lights.push_back(e);
  s.disks.push_back(d);
}

void add_sphere(Scene& s) {
  Sphere b;
  b.centre = {0, 0, 2};
  b.radius = 0.3f;
  b.light = 0;
  Light e;
  e.kind = LightKind::sphere;
  e.radiance = Rgb{1};
  s.lights.push_back(e);
  s.spheres.push_back(b);
}

// Returns points around the source with any normal, farther than `off` from its middle.
SensorBatch sensors(size_t count, float off) {
  SensorBatch b;
  b.offset = 1e-5f;
  Random random(21);
  while (b.size() < count) {
    const Vec3 p{4 * random.next_float() - 2, 4 * random.next_float() - 2,
                 2.5f * random.next_float()};
    const Vec3 n = sphere_from_square(random.next_vec2());
    if (length(p - Vec3{0, 0, 2}) < off) continue;
    b.positions.push_back(p);
    b.normals.push_back(n);
    b.streams.push_back(hash_of(b.size(), 3u));
    b.samples.push_back(0);
  }
  return b;
}

struct Shape {
  const char* name;
  float off;  // least distance of points from the source
  std::function<void(Scene&)> build;
};

void compare_with_exact(const Shape& shape, const Arguments& a) {
  Scene s;
  s.materials.resize(1);
  shape.build(s);
  const PreparedScene scene(std::move(s));
  MethodSettings settings;
  settings.indirect = Indirect::none;
  const std::unique_ptr<Integrator> made = make_integrator(Method::certified, {scene, settings});
  const Integrator& integrator = *made;
  const auto scratch = integrator.make_scratch();
  const SensorBatch points = sensors(20000, shape.off);
  RadianceBatch out;
  out.reset(points.size());
  Counters counters;
  integrator.irradiance(points, *scratch, out, counters);
  std::vector<double> exact(points.size());
  double mean = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    exact[i] =
        irradiance(scene.primitives, 0, Vec3d(points.positions[i]), Vec3d(points.normals[i]));
    mean += exact[i] / double(points.size());
  }
  double worst = 0, sum = 0;
  size_t count = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    if (exact[i] < 1e-3 * mean) continue;
    const double e = std::abs(double(luminance(out.direct[i])) / exact[i] - 1);
    worst = std::max(worst, e);
    sum += e;
    ++count;
  }
  fmt::print("  {:<24} mean {:.7f} %  largest {:.5f} %  {:.2f} rays a point  ({} points)\n",
             shape.name, 100 * sum / double(count), 100 * worst,
             double(counters.shadow_rays) / double(points.size()), count);
  append_row(a.csv_folder, "shapes.csv", "shape,points,mean_difference,largest_difference,rays",
             fmt::format("{},{},{:.3g},{:.3g},{:.4g}", shape.name, count, sum / double(count),
                         worst, double(counters.shadow_rays) / double(points.size())));
}

}  // namespace

void shapes(const Arguments& a) {
  const Shape list[] = {{"rectangle", 0.05f,
                         [](Scene& s) {
                           add_square_light(s, {0, 0, 2}, 1);
                         }},
                        {"skewed parallelogram", 0.05f,
                         [](Scene& s) {
                           add_light(s, {-0.4f, -0.3f, 1.9f}, {0, 0.7f, 0.1f}, {0.9f, 0.3f, 0});
                         }},
                        {"triangle", 0.05f, [](Scene& s) { add_polygon(s, 3); }},
                        {"hexagon", 0.05f, [](Scene& s) { add_polygon(s, 6); }},
                        {"polygon of 12 corners", 0.05f, [](Scene& s) { add_polygon(s, 12); }},
                        {"two-sided rectangle", 0.05f,
                         [](Scene& s) {
                           add_square_light(s, {0, 0, 2}, 1);
                           s.lights[0].is_two_sided = true;
                         }},
                        {"disk", 0.05f, add_disk},
                        {"sphere", 0.35f, add_sphere},
                        {"box of 12 triangles", 0.5f, add_slanted_box},
                        {"ball of 256 triangles", 0.35f, add_glowing_ball}};
  for (const Shape& shape : list) compare_with_exact(shape, a);
}

}  // namespace troffer::bench
