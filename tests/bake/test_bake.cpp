// Light at texels and vertices, compared with closed forms and with `measure`; light at the foot of
// walls.
#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <set>

#include "bake/bake.h"
#include "base/units.h"
#include "export/export_scene.h"
#include "image/read_image.h"
#include "import/import.h"
#include "import/temp_folder.h"
#include "light/irradiance.h"
#include "support/instanced_scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

const StopFlag never_stop = false;

BakeOptions quick(int resolution, int samples = 64) {
  BakeOptions o;
  o.atlas.resolution = resolution;
  o.samples = samples;
  o.light.threads = 2;
  return o;
}

BakeResult baked(const Scene& scene, const BakeOptions& options) {
  const PreparedScene prepared(as_meshes(scene));
  BakeResult r = bake(prepared, options, {}, never_stop);
  REQUIRE(r.is_complete);
  return r;
}

Rgb bilinear(const Image& image, const Vec2& uv) {
  const float x = uv.x * float(image.width) - 0.5f, y = uv.y * float(image.height) - 0.5f;
  const int x0 = int(std::floor(x)), y0 = int(std::floor(y));
  const float fx = x - float(x0), fy = y - float(y0);
  const auto at = [&](int i, int j) {
    return image.at(std::clamp(i, 0, image.width - 1), std::clamp(j, 0, image.height - 1));
  };
  return (at(x0, y0) * (1 - fx) + at(x0 + 1, y0) * fx) * (1 - fy) +
         (at(x0, y0 + 1) * (1 - fx) + at(x0 + 1, y0 + 1) * fx) * fy;
}

// Visits places of a surface with the light that a lightmap shows there.
template <class Visit>
void for_places(const BakeResult& r, const MeshInWorld& mesh, const BakedSurface& surface,
                const Visit& visit, const Vec3& facing = {}) {
  for (uint32_t t = 0; t < mesh.size(); ++t) {
    const Triangle k = mesh.triangle(t);
    const auto [a, b, c] = mesh.corners(t);
    if (dot(cross(b - a, c - a), facing) < 0) continue;
    for (const Vec3 w : {Vec3{0.98f, 0.01f, 0.01f},
                         {0.01f, 0.98f, 0.01f},
                         {0.01f, 0.01f, 0.98f},
                         {0.5f, 0.49f, 0.01f},
                         {0.3f, 0.3f, 0.4f},
                         {0.6f, 0.2f, 0.2f}}) {
      const Vec3 p =
          mesh.position(k[0]) * w.x + mesh.position(k[1]) * w.y + mesh.position(k[2]) * w.z;
      const Vec2 uv = surface.uvs[k[0]] * w.x + surface.uvs[k[1]] * w.y + surface.uvs[k[2]] * w.z;
      visit(p, bilinear(r.irradiance[size_t(surface.page)], uv));
    }
  }
}

Scene lit_floor() {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  add_quad(s, grey, {Vec3{-2, -1, 0}, {2, -1, 0}, {2, 1, 0}, {-2, 1, 0}});
  add_ceiling_light(s, 1, 2, Rgb{10});
  return s;
}

const BakedSurface& surface_named(const BakeResult& r, const std::string& name, const Mesh*& mesh) {
  for (size_t i = 0; i < r.scene.meshes.size(); ++i)
    if (r.scene.meshes[i].name == name) {
      mesh = &r.scene.meshes[i];
      return r.baked.meshes[i];
    }
  FAIL("no surface " << name);
  return r.baked.meshes[0];
}

}  // namespace

TEST_CASE("texels of a floor under a rectangle have its exact irradiance") {
  const Scene scene = lit_floor();
  const PreparedScene prepared(as_meshes(scene));
  const BakeResult r = bake(prepared, quick(128), {}, never_stop);
  REQUIRE(r.is_complete);
  CHECK(r.figures.stands == 1);  // the source itself has none
  double worst = 0;
  size_t places = 0;
  for_places(r, MeshInWorld(r.scene.meshes[0]), r.baked.meshes[0], [&](const Vec3& p, Rgb found) {
    const double lx =
        luminous_efficacy * 10 * irradiance(prepared.primitives[0], Vec3d(p), Vec3d{0, 0, 1});
    worst = std::max(worst, std::abs(double(luminance(found)) / lx - 1));
    ++places;
  });
  CHECK(places == 12);
  CHECK(worst < 0.02);
  // The mean over a texel equals the value at its middle, to second order.
  CHECK(r.figures.error_lx < 0.01 * r.figures.mean_lx);
}

TEST_CASE("texels in a room agree with measure") {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.6f});
  add_box_inside(s, grey, {-2, -2, 0}, {2, 2, 2.5f});
  add_ceiling_light(s, 1, 2.4f, Rgb{10});
  const PreparedScene prepared(as_meshes(s));
  std::vector<MeasuringPoint> measured_points;
  MeasureResult truth;
  for (const Method method : {Method::certified, Method::path}) {
    BakeOptions o = quick(96, method == Method::path ? 512 : 128);
    o.light.method = method;
    const BakeResult r = bake(prepared, o, {}, never_stop);
    std::vector<MeasuringPoint> points;
    std::vector<double> found;
    for (size_t m = 0; m < 6; ++m)
      for_places(r, MeshInWorld(r.scene.meshes[m]), r.baked.meshes[m], [&](const Vec3& p, Rgb e) {
        const Mesh& mesh = r.scene.meshes[m];
        const Vec3& a = mesh.positions[0];
        points.push_back({Vec3d(p), normalize(cross(mesh.positions[mesh.triangles[0][1]] - a,
                                                    mesh.positions[mesh.triangles[0][2]] - a))});
        found.push_back(double(luminance(e)));
      });
    if (measured_points.empty()) {
      MeasureOptions by;
      by.method = Method::path;
      by.spp = 2048;
      measured_points = points;
      truth = measure(prepared, points, by, {}, never_stop);
    }
    REQUIRE(points.size() == measured_points.size());
    double squares = 0, sum = 0, total = 0;
    for (size_t i = 0; i < points.size(); ++i) {
      CHECK(points[i].position == measured_points[i].position);
      const double lx = truth.values[i].illuminance_lx;
      squares += sqr(found[i] / lx - 1);
      sum += found[i];
      total += lx;
    }
    CHECK(std::sqrt(squares / double(points.size())) < 0.05);
    CHECK(sum / total == doctest::Approx(1).epsilon(0.01));
  }
}

TEST_CASE("no two charts share a texel, and gutters repeat the adjacent texels") {
  Scene s = lit_floor();
  s.meshes.push_back(dented_ball(0, 16));
  for (Vec3& p : s.meshes.back().positions) p = p * 0.3f + Vec3{0.5f, 0, 0.5f};
  const BakedSurfaces surfaces = surfaces_of(as_meshes(s), 1);
  const Atlas atlas = make_atlas(surfaces, {0, 200, 4096, 2});
  CHECK(atlas.pages == 1);
  const TexelSites sites(surfaces, atlas);
  std::map<std::pair<int, int>, uint32_t> owner;
  for (const TexelSites::Texel& t : sites.texels()) {
    const auto [at, is_new] = owner.insert({{t.x, t.y}, t.chart});
    CHECK(is_new);
  }
  // Bilinear filtering reads one texel around a chart; no other chart may cover those texels.
  size_t bled = 0;
  for (const TexelSites::Texel& t : sites.texels())
    for (int dy = -2; dy <= 2; ++dy)
      for (int dx = -2; dx <= 2; ++dx) {
        const auto found = owner.find({t.x + dx, t.y + dy});
        bled += found != owner.end() && found->second != t.chart;
      }
  CHECK(bled == 0);
}

TEST_CASE(
    "a wall without thickness lets no light through, and the dark floor under a box does not "
    "spread") {
  // Two rooms with floors of their own, and between them a wall: two coincident quads, back to
  // back.
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.7f});
  add_box_inside(s, grey, {-3, -1, 0}, {0, 1, 2});  // lit
  add_box_inside(s, grey, {0, -1, 0}, {3, 1, 2});   // dark
  s.meshes[5].name = "lit side";
  s.meshes[10].name = "dark side";
  const uint32_t quad = add_quad(
      s, grey, {Vec3{-2, -0.5f, 1.9f}, {-2, 0.5f, 1.9f}, {-1, 0.5f, 1.9f}, {-1, -0.5f, 1.9f}});
  make_light(s, quad, Rgb{10});
  // A box on the lit floor: the floor below it gets no light.
  Mesh box;
  Scene of_box;
  add_box_inside(of_box, grey, {-0.9f, -0.4f, 0}, {-0.3f, 0.4f, 0.5f});
  for (const Mesh& side : of_box.meshes) {
    const auto first = uint32_t(box.positions.size());
    box.positions.insert(box.positions.end(), side.positions.begin(), side.positions.end());
    for (const Triangle& t : side.triangles)
      box.triangles.push_back({first + t[0], first + t[2], first + t[1]});
  }
  box.material = grey;
  s.meshes[0].name = "floor";
  s.meshes.push_back(box);
  const BakeResult r = baked(s, quick(256));
  const Mesh* mesh = nullptr;
  const BakedSurface& dark = surface_named(r, "dark side", mesh);
  // Each wall is visible from both sides, so it has two layers.
  double brightest = 0;
  for_places(r, MeshInWorld(*mesh), dark,
             [&](const Vec3&, Rgb e) { brightest = std::max(brightest, double(luminance(e))); },
             {1, 0, 0});
  CHECK(brightest < 1e-6 * r.figures.mean_lx);
  const BakedSurface& lit = surface_named(r, "lit side", mesh);
  double darkest = 1e9;
  for_places(r, MeshInWorld(*mesh), lit,
             [&](const Vec3&, Rgb e) { darkest = std::min(darkest, double(luminance(e))); },
             {-1, 0, 0});
  CHECK(darkest > 0.1 * r.figures.mean_lx);
  // At the foot of the box, a third of a texel in front of it, the lightmap agrees with measure.
  const PreparedScene prepared(as_meshes(s));
  const BakedSurface& floor = surface_named(r, "floor", mesh);
  std::vector<MeasuringPoint> points;
  std::vector<double> shown;
  const float off = 0.33f / float(r.atlas.texels_per_metre);
  for (float y = -0.35f; y < 0.36f; y += 0.1f) {
    const Vec3 p{-0.9f - off, y, 0};
    const auto& c = mesh->positions;
    for (const Triangle& t : mesh->triangles) {
      const double all = double(cross(c[t[1]] - c[t[0]], c[t[2]] - c[t[0]]).z);
      const double a = double(cross(c[t[1]] - p, c[t[2]] - p).z) / all;
      const double b = double(cross(c[t[2]] - p, c[t[0]] - p).z) / all;
      if (a < 0 || b < 0 || a + b > 1) continue;
      const Vec2 uv = floor.uvs[t[0]] * float(a) + floor.uvs[t[1]] * float(b) +
                      floor.uvs[t[2]] * float(1 - a - b);
      points.push_back({Vec3d(p), {0, 0, 1}});
      shown.push_back(double(luminance(bilinear(r.irradiance[size_t(floor.page)], uv))));
      break;
    }
  }
  REQUIRE(points.size() == 8);
  MeasureOptions by;
  by.method = Method::path;
  by.spp = 4096;
  const MeasureResult truth = measure(prepared, points, by, {}, never_stop);
  for (size_t i = 0; i < points.size(); ++i)
    CHECK(shown[i] == doctest::Approx(truth.values[i].illuminance_lx).epsilon(0.15));
}

TEST_CASE("a sheet lit on both sides gets two layers, each with its own light") {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  s.meshes.resize(add_quad(s, grey, {Vec3{0, -1, 0}, {0, 1, 0}, {0, 1, 2}, {0, -1, 2}}) + 1);
  s.meshes[0].name = "sheet";
  for (const float x : {-1.0f, 3.0f}) {  // the far one is three times as far
    const float d = x < 0 ? 1.0f : -1.0f;
    const uint32_t quad = add_quad(
        s, grey,
        {Vec3{x, -0.5f * d, 0.5f}, {x, 0.5f * d, 0.5f}, {x, 0.5f * d, 1.5f}, {x, -0.5f * d, 1.5f}});
    make_light(s, quad, Rgb{10}, true);
  }
  const BakeResult r = baked(s, quick(64));
  const PreparedScene prepared(s);
  size_t layers = 0;
  std::set<float> seen;
  for (size_t m = 0; m < r.scene.meshes.size(); ++m) {
    if (r.baked.meshes[m].page < 0) continue;
    const Mesh& mesh = r.scene.meshes[m];
    CHECK(r.scene.materials[mesh.material].back_faces == BackFaces::unseen);
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t, ++layers) {
      const auto k = MeshInWorld(mesh).corners(t);
      const Vec3 n = normalize(cross(k[1] - k[0], k[2] - k[0]));
      seen.insert(n.x);
      const Triangle& v = mesh.triangles[t];
      const auto& uvs = r.baked.meshes[m].uvs;
      const Vec2 uv = (uvs[v[0]] + uvs[v[1]] + uvs[v[2]]) * (1 / 3.0f);
      const Vec3d p = (Vec3d(k[0]) + Vec3d(k[1]) + Vec3d(k[2])) / 3.0;
      const size_t light = n.x < 0 ? 0 : 1;
      const double lx =
          luminous_efficacy * 10 * irradiance(prepared.primitives[light], p, Vec3d(n));
      CHECK(double(luminance(bilinear(r.irradiance[0], uv))) == doctest::Approx(lx).epsilon(0.05));
    }
  }
  CHECK(layers == 4);
  CHECK(seen.size() == 2);
}

TEST_CASE("instances share a mesh but not their light") {
  Scene s = lit_floor();
  s.instanced_meshes.push_back(dented_ball(0, 12));
  add_instance(s, 0, Affine::translate({0, 0, 0.5}) * Affine::scale({0.3, 0.3, 0.3}), "near");
  add_instance(s, 0, Affine::translate({1.6, 0, 0.4}) * Affine::scale({-0.3, 0.3, 0.3}), "far");
  const BakeResult r = baked(s, quick(64));
  REQUIRE(r.baked.instances.size() == 2);
  REQUIRE(r.baked.instances[0].is_baked());
  double mean[2] = {0, 0};
  for (size_t i = 0; i < 2; ++i)
    for_places(r, mesh_at(r.scene, uint32_t(r.scene.meshes.size() + 2 + i)), r.baked.instances[i],
               [&](const Vec3&, Rgb e) { mean[i] += double(luminance(e)); });
  CHECK(mean[0] > 1.3 * mean[1]);
  // The near instance has the light of a copy.
  Scene copy = lit_floor();
  copy.meshes.push_back(copied_to_world(mesh_at(s, uint32_t(s.meshes.size() + 2))));
  copy.meshes.push_back(copied_to_world(mesh_at(s, uint32_t(s.meshes.size() + 3))));
  const BakeResult of_copy = baked(copy, quick(64));
  for (size_t i = 0; i < 2; ++i) {
    double sum = 0;
    for_places(of_copy, MeshInWorld(of_copy.scene.meshes[2 + i]), of_copy.baked.meshes[2 + i],
               [&](const Vec3&, Rgb e) { sum += double(luminance(e)); });
    CHECK(mean[i] == doctest::Approx(sum).epsilon(0.03));
  }
}

TEST_CASE(
    "baked light does not depend on the number of threads, and a stop leaves nothing behind") {
  Scene s = lit_floor();
  s.meshes.push_back(dented_ball(0, 8));
  for (Vec3& p : s.meshes.back().positions) p = p * 0.2f + Vec3{0.5f, 0, 0.5f};
  BakeOptions o = quick(64, 16);
  o.light.threads = 1;
  const BakeResult one = baked(s, o);
  o.light.threads = 2;
  const BakeResult two = baked(s, o);
  CHECK(one.baked.pages == two.baked.pages);
  CHECK(one.irradiance[0].pixels == two.irradiance[0].pixels);
  const StopFlag stopped = true;
  const PreparedScene prepared(as_meshes(s));
  CHECK(!bake(prepared, o, {}, stopped).is_complete);
}

TEST_CASE("a vertex gets the mean light around it") {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  Mesh grid;
  grid.material = grey;
  constexpr int n = 16;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x)
      grid.positions.push_back({4.0f * float(x) / n - 2, 4.0f * float(y) / n - 2, 0});
  for (uint32_t y = 0; y < n; ++y)
    for (uint32_t x = 0; x < n; ++x) {
      const uint32_t a = y * (n + 1) + x;
      grid.triangles.push_back({a, a + 1, a + n + 2});
      grid.triangles.push_back({a, a + n + 2, a + n + 1});
    }
  s.meshes.push_back(grid);
  add_ceiling_light(s, 1, 2, Rgb{10});
  BakeOptions o = quick(64, 256);
  o.shading = BakedShading::vertex_colors;
  o.exposure_stops = 0;
  const PreparedScene prepared(as_meshes(s));
  const BakeResult r = bake(prepared, o, {}, never_stop);
  const std::vector<Rgb>& colors = r.baked.meshes[0].colors;
  REQUIRE(colors.size() == r.scene.meshes[0].positions.size());
  double worst = 0;
  for (size_t v = 0; v < colors.size(); ++v) {
    const Vec3& p = r.scene.meshes[0].positions[v];
    if (std::max(std::abs(p.x), std::abs(p.y)) > 1.9f) continue;  // one-sided there
    const double lx =
        luminous_efficacy * 10 * irradiance(prepared.primitives[0], Vec3d(p), Vec3d{0, 0, 1});
    worst = std::max(worst, std::abs(double(luminance(colors[v])) * pi / lx - 1));
  }
  CHECK(worst < 0.03);
}
