#include "render/light_outlines.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/frame.h"
#include "base/units.h"

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

// ---- … and in the picture ----

// Points of an edge, no farther apart than half a pixel, that fall into the region.
class EdgeWalk {
 public:
  EdgeWalk(const ViewingCamera& camera, const PixelRect& region)
      : camera_(camera), region_(region) {}
  void walk(const OutlineEdge& e) { halve(at(e.a), at(e.b), 0); }

  std::vector<Pixel2> pixels;
  std::vector<Ray> rays;         // from the eye through the points, which …
  std::vector<float> distances;  // … lie so far away

 private:
  struct Point {
    Vec3 position;
    Vec2 raster;
    bool is_before = false;  // the camera
  };

  Point at(const Vec3& p) const {
    Point q{p, {}, false};
    q.is_before = camera_.raster_of(p, q.raster);
    return q;
  }
  bool is_beside(const Point& a, const Point& b) const {
    const auto x0 = float(region_.x0), x1 = float(region_.x1), y0 = float(region_.y0),
               y1 = float(region_.y1);
    return (a.raster.x < x0 && b.raster.x < x0) || (a.raster.x >= x1 && b.raster.x >= x1) ||
           (a.raster.y < y0 && b.raster.y < y0) || (a.raster.y >= y1 && b.raster.y >= y1);
  }
  void halve(const Point& a, const Point& b, int depth) {
    constexpr int deepest = 16;
    if (!a.is_before && !b.is_before) return;
    if (a.is_before && b.is_before) {
      if (is_beside(a, b)) return;
      const Vec2 d = a.raster - b.raster;
      if (std::abs(d.x) <= 0.5f && std::abs(d.y) <= 0.5f) {
        add(a);
        add(b);
        return;
      }
    }
    if (depth == deepest) return;
    const Point middle = at((a.position + b.position) * 0.5f);
    halve(a, middle, depth + 1);
    halve(middle, b, depth + 1);
  }
  void add(const Point& p) {
    const Vec2 r = p.raster;
    if (!(r.x >= float(region_.x0) && r.x < float(region_.x1) && r.y >= float(region_.y0) &&
          r.y < float(region_.y1)))
      return;
    pixels.push_back({int(r.x), int(r.y)});
    rays.push_back(camera_.ray(r, {0.5f, 0.5f}));
    distances.push_back(length(p.position - rays.back().origin));
  }

  const ViewingCamera& camera_;
  PixelRect region_;
};

}  // namespace

std::vector<Pixel2> pixels_on_light_outlines(const PreparedScene& scene,
                                             const ViewingCamera& camera, const PixelRect& region) {
  std::vector<OutlineEdge> edges;
  for (const Light& light : scene.scene.lights) add_outline(scene.scene, light, camera, edges);
  EdgeWalk walk(camera, region);
  for (const OutlineEdge& e : edges) walk.walk(e);
  // What stands close before the light, a fixture's rim, does not hide it here.
  constexpr float reach = 0.999f;
  for (size_t i = 0; i < walk.rays.size(); ++i) walk.rays[i].t_max = reach * walk.distances[i];
  std::vector<uint8_t> is_hidden(walk.rays.size());
  scene.tracer.occluded(walk.rays, is_hidden, Coherence::coherent);
  std::vector<Pixel2> seen;
  for (size_t i = 0; i < is_hidden.size(); ++i)
    if (is_hidden[i] == 0) seen.push_back(walk.pixels[i]);
  return seen;
}

}  // namespace troffer
