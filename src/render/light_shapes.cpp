#include "render/light_shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "base/frame.h"
#include "base/units.h"

namespace troffer {

namespace {

using Loop = std::vector<Vec3>;

void add_loop(const Loop& loop, std::vector<OutlineEdge>& edges, float hidden_before = 0) {
  for (size_t i = 0; i < loop.size(); ++i)
    edges.push_back({loop[i], loop[(i + 1) % loop.size()], hidden_before});
}

// Returns a polygon of the circle's area. Its sides are within .001 pixels of the circle, unless
// the circle is more than 400 pixels wide.
Loop circle(const Vec3& centre, const Vec3& normal, float radius, const ViewingCamera& camera) {
  constexpr float fewest = 16, most = 1024, largest_error = 0.001f;
  const Frame frame(normal);
  Vec2 middle, rim;
  float pixels = 0;
  for (const Vec3& axis : {frame.tangent, frame.bitangent})
    if (camera.raster_of(centre, middle) && camera.raster_of(centre + axis * radius, rim))
      pixels = std::max(pixels, std::hypot(rim.x - middle.x, rim.y - middle.y));
  const int corners =
      int(std::clamp(pi_f * std::sqrt(0.5f * pixels / largest_error), fewest, most));
  const float step = 2 * pi_f / float(corners);
  const float r = radius * std::sqrt(step / std::sin(step));
  Loop loop;
  for (int i = 0; i < corners; ++i)
    loop.push_back(
        centre + frame.to_world({r * std::cos(step * float(i)), r * std::sin(step * float(i)), 0}));
  return loop;
}

Loop outline_of(const Disk& d, const ViewingCamera& camera) {
  return circle(d.centre, d.normal, d.radius, camera);
}

// Returns the circle along which the cone from the eye touches the sphere; nothing if the eye is
// inside.
Loop outline_of(const Sphere& s, const ViewingCamera& camera) {
  const Vec3 to_eye = camera.towards_eye(s.centre);
  const float d =
      camera.is_perspective() ? camera.distance(s.centre) : std::numeric_limits<float>::infinity();
  if (!(d > s.radius)) return {};
  const float sine = s.radius / d;
  return circle(s.centre + to_eye * (s.radius * sine), to_eye, s.radius * std::sqrt(1 - sqr(sine)),
                camera);
}

// Adds the edges of a single triangle, and those between a triangle that faces the eye and one that
// does not.
void add_mesh(const Mesh& mesh, const Light& light, const ViewingCamera& camera,
              std::vector<OutlineEdge>& edges) {
  struct Side {
    uint32_t low, high;
    bool is_front;
    bool is_like(const Side& o) const { return low == o.low && high == o.high; }
  };
  std::vector<Side> sides;
  for (const uint32_t t : light.triangles) {
    const Triangle& i = mesh.triangles[t];
    const Vec3 &a = mesh.positions[i[0]], &b = mesh.positions[i[1]], &c = mesh.positions[i[2]];
    const bool is_front = dot(cross(b - a, c - a), camera.towards_eye(a)) > 0;
    for (size_t k = 0; k < 3; ++k)
      sides.push_back({std::min(i[k], i[(k + 1) % 3]), std::max(i[k], i[(k + 1) % 3]), is_front});
  }
  std::sort(sides.begin(), sides.end(), [](const Side& p, const Side& q) {
    return p.low != q.low ? p.low < q.low : p.high < q.high;
  });
  for (size_t i = 0; i < sides.size();) {
    size_t last = i + 1, fronts = sides[i].is_front ? 1 : 0;
    for (; last < sides.size() && sides[last].is_like(sides[i]); ++last)
      fronts += sides[last].is_front ? 1 : 0;
    if (last - i == 1 || (fronts > 0 && fronts < last - i))
      edges.push_back({mesh.positions[sides[i].low], mesh.positions[sides[i].high]});
    i = last;
  }
}

bool is_turned_to(const Vec3& normal, const Vec3& at, const Light& light,
                  const ViewingCamera& camera) {
  return light.is_two_sided || dot(normal, camera.towards_eye(at)) > 0;
}

}  // namespace

void add_outline(const Scene& scene, const Light& light, const ViewingCamera& camera,
                 std::vector<OutlineEdge>& edges) {
  switch (light.kind) {
    case LightKind::polygon:
      add_loop(light.polygon, edges);
      break;
    case LightKind::disk:
      add_loop(outline_of(scene.disks[light.geometry], camera), edges);
      break;
    case LightKind::sphere: {
      const Sphere& sphere = scene.spheres[light.geometry];
      // With 16 corners, a ray to a side of the polygon meets the sphere up to .2 radii before it.
      constexpr float chord = 0.25f;
      add_loop(outline_of(sphere, camera), edges, chord * sphere.radius);
      break;
    }
    case LightKind::mesh:
      add_mesh(scene.meshes[light.geometry], light, camera, edges);
      break;
    case LightKind::point:
    case LightKind::spot:
    case LightKind::distant:
    case LightKind::environment:
    case LightKind::sky:
    case LightKind::sun:
      break;  // no visible border
  }
}

bool is_even(const Light& light) {
  return has_surface(light.kind) && light.texture < 0 && !light.is_alpha_masked && light.web < 0;
}

std::vector<LightLoop> shining_loops(const Scene& scene, const Light& light,
                                     const ViewingCamera& camera) {
  std::vector<LightLoop> loops;
  const auto add = [&](const Loop& loop) {
    LightLoop& out = loops.emplace_back();
    for (const Vec3& p : loop) out.push_back({p});
  };
  if (light.kind == LightKind::polygon && light.polygon.size() >= 3) {
    const Loop& p = light.polygon;
    Vec3 area;
    for (size_t i = 2; i < p.size(); ++i) area += cross(p[i - 1] - p[0], p[i] - p[0]);
    if (is_turned_to(area, p[0], light, camera)) add(p);
  } else if (light.kind == LightKind::disk) {
    const Disk& d = scene.disks[light.geometry];
    if (is_turned_to(d.normal, d.centre, light, camera)) add(outline_of(d, camera));
  } else if (light.kind == LightKind::sphere) {
    const Sphere& s = scene.spheres[light.geometry];
    if (!s.is_inside_out || light.is_two_sided) add(outline_of(s, camera));
  } else if (light.kind == LightKind::mesh) {
    const Mesh& mesh = scene.meshes[light.geometry];
    std::vector<Triangle> shining;
    for (const uint32_t t : light.triangles) {
      const Triangle& i = mesh.triangles[t];
      const Vec3 &a = mesh.positions[i[0]], &b = mesh.positions[i[1]], &c = mesh.positions[i[2]];
      if (!is_turned_to(cross(b - a, c - a), a, light, camera)) continue;
      shining.push_back(i);
      add({a, b, c});
    }
    std::set<std::pair<uint32_t, uint32_t>> sides;
    for (const Triangle& t : shining)
      for (size_t k = 0; k < 3; ++k) sides.insert({t[k], t[(k + 1) % 3]});
    for (size_t i = 0; i < shining.size(); ++i)
      for (size_t k = 0; k < 3; ++k)
        loops[i][k].is_outline = !sides.contains({shining[i][(k + 1) % 3], shining[i][k]});
  }
  return loops;
}

}  // namespace troffer
