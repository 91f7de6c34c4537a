#include <cmath>
#include <functional>
#include <utility>

#include "base/random.h"
#include "base/warp.h"
#include "generated_scenes.h"
#include "render/camera.h"

namespace troffer::bench {

namespace {

constexpr float light_height = 2.5f;

// A floor, lights of 1 m and of 1.5 m × 0.1 m, and a camera that looks at the space between.
Scene floor_and_lights(bool has_lights = true) {
  Scene s;
  s.materials.resize(1);
  Mesh floor;
  add_sheet(floor, {-4, -4, 0}, {8, 0, 0}, {0, 8, 0});
  s.meshes.push_back(floor);
  if (has_lights) {
    add_square_light(s, {0, 0, light_height}, 1);
    add_light(s, {-0.75f, 1, light_height}, {0, 0.1f, 0}, {1.5f, 0, 0});
  }
  s.cameras = {look_at({0.2f, -1.8f, 1.3f}, {0, 0.1f, 0}, {0, 0, 1}, 40)};
  return s;
}

// Adds a straight bar from a to b, `size` wide and thick.
void add_bar(Mesh& m, const Vec3& a, const Vec3& b, float size) {
  const Vec3 along = normalize(b - a);
  const Vec3 side =
      normalize(cross(along, std::abs(along.z) < 0.9f ? Vec3{0, 0, 1} : Vec3{1, 0, 0}));
  const Vec3 u = side * size, v = cross(along, side) * size, w = b - a, o = a - (u + v) * 0.5f;
  add_sheet(m, o, v, u);
  add_sheet(m, o + w, u, v);
  add_sheet(m, o, u, w);
  add_sheet(m, o + v, w, u);
  add_sheet(m, o, w, v);
  add_sheet(m, o + u, v, w);
}

void wires(Scene&, Mesh& m) {
  Random random(11);
  for (int i = 0; i < 24; ++i) {
    const Vec3 c{random.next_float() - 0.5f, random.next_float() - 0.5f,
                 0.05f + 1.5f * random.next_float()};
    const Vec3 d = sphere_from_square(random.next_vec2()) * 0.5f;
    add_bar(m, c - Vec3{d.x, d.y, 0.05f * d.z}, c + Vec3{d.x, d.y, 0.05f * d.z}, 0.001f);
  }
}

void specks(Scene&, Mesh& m) {
  Random random(12);
  for (int i = 0; i < 400; ++i) {
    const Vec3 c{1.6f * random.next_float() - 0.8f, 1.6f * random.next_float() - 0.8f,
                 0.02f + 1.2f * random.next_float()};
    const auto base = uint32_t(m.positions.size());
    for (int k = 0; k < 3; ++k)
      m.positions.push_back(c + sphere_from_square(random.next_vec2()) * 0.005f);
    m.triangles.push_back({base, base + 1, base + 2});
  }
}

// Adds 64 bars of 4 mm with a spacing of 8 mm, at `angle` to the lights' sides.
void comb(Mesh& m, const Vec3& centre, float angle) {
  const Vec3 across{std::cos(angle), std::sin(angle), 0}, along{-across.y, across.x, 0};
  for (int i = 0; i < 64; ++i) {
    const Vec3 o = centre + across * (0.008f * (float(i) - 32)) - along * 0.25f;
    add_sheet(m, o, across * 0.004f, along * 0.5f);
  }
}

void combs(Scene&, Mesh& m) {
  comb(m, {-0.3f, 0, 0.4f}, 0);
  comb(m, {0.3f, 0, 0.4f}, 0.35f);
}

// Adds a sheet of 1 m with 64 holes of 4 mm.
void pinholes(Scene&, Mesh& m) {
  constexpr int n = 8;
  constexpr float cell = 1.0f / n, hole = 0.004f, rim = (cell - hole) / 2;
  for (int i = 0; i < n * n; ++i) {
    const Vec3 o{-0.5f + cell * float(i % n), -0.5f + cell * float(i / n), 0.3f};
    add_sheet(m, o, {cell, 0, 0}, {0, rim, 0});
    add_sheet(m, o + Vec3{0, rim + hole, 0}, {cell, 0, 0}, {0, rim, 0});
    add_sheet(m, o + Vec3{0, rim, 0}, {rim, 0, 0}, {0, hole, 0});
    add_sheet(m, o + Vec3{rim + hole, rim, 0}, {rim, 0, 0}, {0, hole, 0});
  }
}

void contact(Scene&, Mesh& m) {
  add_box(m, {-0.5f, -0.2f, 0}, {-0.2f, 0.1f, 0.3f}, 0.4f);
  add_box(m, {0.3f, -0.1f, 0}, {0.31f, 0.5f, 0.2f}, 0);
  add_ball(m, {0, 0, 0.1f}, 0.1f);
  add_ball(m, {0.1f, -0.4f, 0.02f}, 0.02f);
  add_box(m, {-0.2f, 0.3f, 0.001f}, {0.2f, 0.6f, 0.003f}, 0.2f);
}

void through_source(Scene&, Mesh& m) {
  add_sheet(m, {-0.5f, -0.6f, 2.2f}, {0.8f, 0.9f, 0}, {0, 0, 0.6f});
  add_sheet(m, {-0.2f, -0.6f, 2.4f}, {0.7f, 0.1f, 0.05f}, {0, 0.5f, 0.25f});
  add_box(m, {0.2f, 0.1f, 2.3f}, {0.5f, 0.3f, 2.7f}, 0.3f);
  add_bar(m, {-0.4f, 1.05f, 2.4f}, {-0.3f, 1.06f, 2.6f}, 0.01f);
}

void through_receiver(Scene&, Mesh& m) {
  add_sheet(m, {-0.5f, -0.3f, -0.1f}, {0.7f, 0.2f, 0}, {0.1f, 0, 0.4f});
  add_box(m, {0.1f, 0, -0.2f}, {0.4f, 0.2f, 0.2f}, 0.5f);
  add_ball(m, {-0.3f, 0.4f, 0.03f}, 0.1f);
  add_bar(m, {0, 0.5f, -0.05f}, {0.4f, 0.3f, 0.25f}, 0.002f);
}

// Adds a ceiling with flush lights, a square and two disks. One disk is in a shade that begins at
// its rim.
void embedded(Scene& s, Mesh& m) {
  constexpr float z = light_height;
  add_square_light(s, {0, 0, z}, 1);
  constexpr float edges[4] = {-3, -0.5f, 0.5f, 3};
  for (int i = 0; i < 9; ++i) {
    if (i == 4) continue;
    const float x0 = edges[i % 3], x1 = edges[i % 3 + 1], y0 = edges[i / 3], y1 = edges[i / 3 + 1];
    add_sheet(m, {x0, y0, z}, {0, y1 - y0, 0}, {x1 - x0, 0, 0});
  }
  for (const float y : {-1.0f, 1.0f}) {
    Disk disk;
    disk.centre = {0.3f * y, y, z - 0.2f};
    disk.normal = {0, 0, -1};
    disk.radius = 0.1f;
    disk.light = int32_t(s.lights.size());
    Light e;
    e.kind = LightKind::disk;
    e.radiance = Rgb{10};
    e.geometry = uint32_t(s.disks.size());
    s.lights.push_back(e);
    s.disks.push_back(disk);
    constexpr int sides = 32;
    for (int i = 0; i < sides; ++i) {
      const auto rim = [&](int k) {
        const float a = 2 * pi_f * float(k) / sides, r = disk.radius / std::cos(pi_f / sides);
        return disk.centre + Vec3{r * std::cos(a), r * std::sin(a), 0};
      };
      const float depth = y > 0 ? -0.08f : 0.2f;  // below the lamp, or above it as a housing
      add_sheet(m, rim(i), rim(i + 1) - rim(i), {0, 0, depth});
    }
  }
  add_ball(m, {0, 0, 0.4f}, 0.1f);
}

void coplanar(Scene&, Mesh& m) {
  add_sheet(m, {-0.5f, -0.3f, 0.5f}, {0.6f, 0, 0}, {0, 0.5f, 0});
  add_sheet(m, {-0.2f, -0.1f, 0.5f}, {0.6f, 0.1f, 0}, {-0.1f, 0.5f, 0});
  for (int i = 0; i < 5; ++i)
    add_sheet(m, {0.3f, -0.5f + 0.05f * float(i), 0.5f}, {0.3f, 0, 0}, {0, 0.05f, 0});
  // vertical, in one plane with a side of the large light
  add_sheet(m, {0.5f, -0.4f, 0.2f}, {0, 0.4f, 0}, {0, 0, 0.5f});
}

void back_faces(Scene&, Mesh& m) {
  for (int i = 0; i < 6; ++i) {
    const Vec3 o{-0.6f + 0.22f * float(i), -0.2f, 0.2f + 0.1f * float(i)};
    if (i % 2 == 0)
      add_sheet(m, o, {0.15f, 0, 0.05f}, {0, 0.4f, 0.1f});
    else
      add_sheet(m, o, {0, 0.4f, 0.1f}, {0.15f, 0, 0.05f});
  }
}

// Adds half a pipe, open at its ends, and a fan of separate triangles.
void open_sheets(Scene&, Mesh& m) {
  constexpr int n = 24;
  for (int i = 0; i < n; ++i) {
    const auto at = [&](int k) {
      const float a = pi_f * float(k) / n;
      return Vec3{-0.3f, -0.1f - 0.2f * std::cos(a), 0.2f + 0.2f * std::sin(a)};
    };
    add_sheet(m, at(i), at(i + 1) - at(i), {0.5f, 0.1f, 0});
  }
  for (int i = 0; i < 9; ++i) {
    const auto base = uint32_t(m.positions.size());
    const float a = 0.7f * float(i), b = a + 0.3f;
    m.positions.push_back({0.4f, 0.2f, 0.4f});
    m.positions.push_back({0.4f + 0.3f * std::cos(a), 0.2f + 0.3f * std::sin(a), 0.3f});
    m.positions.push_back({0.4f + 0.3f * std::cos(b), 0.2f + 0.3f * std::sin(b), 0.5f});
    m.triangles.push_back({base, base + 1, base + 2});
  }
}

// Adds each of three objects three times, one copy inside out.
void duplicates(Scene&, Mesh& m) {
  for (int copy = 0; copy < 3; ++copy) {
    add_box(m, {-0.4f, -0.2f, 0.2f}, {-0.1f, 0.1f, 0.4f}, 0.3f, copy == 1);
    add_ball(m, {0.3f, 0, 0.3f}, 0.12f);
    add_sheet(m, {0, 0.3f, 0.3f}, {0.4f, 0, 0}, {0, 0.2f, 0.1f});
  }
}

}  // namespace

std::vector<ThinScene> thin_scenes() {
  struct Kind {
    const char *name, *what;
    void (*build)(Scene&, Mesh&);
    bool has_lights = true;
  };
  const Kind kinds[] = {
      {"wires", "24 wires, 1 mm", wires},
      {"specks", "400 triangles of 5 mm to 10 mm", specks},
      {"combs", "two combs of 64 bars, 4 mm, 4 mm apart", combs},
      {"pinholes", "a sheet with 64 holes of 4 mm", pinholes},
      {"contact", "boxes, balls and a plate on the floor or 1 mm above it", contact},
      {"through source", "sheets, a box and a bar through the lights", through_source},
      {"through receiver", "the same through the floor", through_receiver},
      {"embedded", "lights flush with the ceiling and with the rim of a shade", embedded, false},
      {"coplanar", "sheets that overlap in one plane or lie in that of a light's side", coplanar},
      {"back faces", "sheets with front and back to the light", back_faces},
      {"open sheets", "half a pipe, single triangles", open_sheets},
      {"duplicates", "everything three times, a box once inside out", duplicates}};
  std::vector<ThinScene> scenes;
  for (const Kind& k : kinds) {
    Scene s = floor_and_lights(k.has_lights);
    Mesh m;
    k.build(s, m);
    s.meshes.push_back(std::move(m));
    scenes.push_back({k.name, k.what, std::move(s)});
  }
  return scenes;
}

}  // namespace troffer::bench
