#include "render/light_outlines.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/frame.h"
#include "base/units.h"
#include "render/segment_walk.h"

namespace troffer {

namespace {

struct OutlineEdge {
  Vec3 a, b;
};

// ---- outlines in space ----

void add_circle(const Vec3& centre, const Vec3& normal, float radius,
                std::vector<OutlineEdge>& edges) {
  constexpr int corners = 16;
  const Frame frame(normal);
  const auto corner = [&](int i) {
    const float angle = 2 * pi_f * float(i) / corners;
    return centre + frame.to_world({radius * std::cos(angle), radius * std::sin(angle), 0});
  };
  for (int i = 0; i < corners; ++i) edges.push_back({corner(i), corner(i + 1)});
}

// The circle in which the cone from the eye touches the sphere.
void add_sphere(const Sphere& s, const ViewingCamera& camera, std::vector<OutlineEdge>& edges) {
  const Vec3 to_eye = camera.towards_eye(s.centre);
  const float d =
      camera.is_perspective() ? camera.distance(s.centre) : std::numeric_limits<float>::infinity();
  if (!(d > s.radius)) return;
  const float sine = s.radius / d;
  add_circle(s.centre + to_eye * (s.radius * sine), to_eye, s.radius * std::sqrt(1 - sqr(sine)),
             edges);
}

// Edges that one triangle has for itself, or two of which one faces the eye.
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

void add_outline(const Scene& scene, const Light& light, const ViewingCamera& camera,
                 std::vector<OutlineEdge>& edges) {
  switch (light.kind) {
    case LightKind::polygon:
      for (size_t i = 0; i < light.polygon.size(); ++i)
        edges.push_back({light.polygon[i], light.polygon[(i + 1) % light.polygon.size()]});
      break;
    case LightKind::disk: {
      const Disk& d = scene.disks[light.geometry];
      add_circle(d.centre, d.normal, d.radius, edges);
      break;
    }
    case LightKind::sphere:
      add_sphere(scene.spheres[light.geometry], camera, edges);
      break;
    case LightKind::mesh:
      add_mesh(scene.meshes[light.geometry], light, camera, edges);
      break;
    case LightKind::point:
    case LightKind::spot:
    case LightKind::distant:
    case LightKind::environment:
    case LightKind::sky:
    case LightKind::sun:
      break;  // nothing that a camera sees has a border
  }
}

}  // namespace

std::vector<Pixel2> pixels_on_light_outlines(const PreparedScene& scene,
                                             const ViewingCamera& camera, const PixelRect& region) {
  std::vector<OutlineEdge> edges;
  for (const Light& light : scene.scene.lights) add_outline(scene.scene, light, camera, edges);
  // Where they run, and rays from the eye that end before them: what stands close before the light,
  // a fixture's rim, does not hide it here.
  constexpr float reach = 0.999f;
  std::vector<Pixel2> pixels;
  std::vector<Ray> rays;
  const SegmentWalk walk(camera, region);
  for (const OutlineEdge& e : edges)
    walk.walk(e.a, e.b, [&](const Vec3& position, const Vec2& r) {
      pixels.push_back({int(r.x), int(r.y)});
      rays.push_back(camera.ray(r, {0.5f, 0.5f}));
      rays.back().t_max = reach * length(position - rays.back().origin);
    });
  std::vector<uint8_t> is_hidden(rays.size());
  scene.tracer.occluded(rays, is_hidden, Coherence::coherent);
  std::vector<Pixel2> seen;
  for (size_t i = 0; i < is_hidden.size(); ++i)
    if (is_hidden[i] == 0) seen.push_back(pixels[i]);
  return seen;
}

}  // namespace troffer
