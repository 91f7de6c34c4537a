#include "certified/lit_surfaces.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/frame.h"
#include "base/random.h"
#include "base/streams.h"
#include "base/warp.h"
#include "trace/surface.h"

namespace troffer {

namespace {

// Random walks per batch and in total, and the segments of each: up to 32 768 rays towards
// environment light.
constexpr size_t walks_at_a_time = 512, most_walks = 8192;
constexpr int most_segments = 4;

float magnitude_of(const Vec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

Vec3 cosine_direction(const Vec3& normal, const Vec2& u) {
  const float radius = std::sqrt(u.x), angle = 2 * float(pi) * u.y;
  const Frame f(normal);
  return f.tangent * (radius * std::cos(angle)) + f.bitangent * (radius * std::sin(angle)) +
         normal * std::sqrt(std::max(1 - u.x, 0.0f));
}

// Returns a random ray that leaves a light.
Ray first_ray(const LightPrimitive& p, Random& random) {
  Ray ray;
  if (p.has_surface() && p.shape != PrimitiveShape::sphere) {
    Vec3 normal(p.normal);
    if (p.is_two_sided && random.next_u32() % 2 == 0) normal = -normal;
    ray.direction = cosine_direction(normal, random.next_vec2());
    ray.origin = p.centroid + normal * (2 * ray_offset(magnitude_of(p.centroid)));
  } else {
    ray.direction = sphere_from_square(random.next_vec2());
    const float away = p.is_inside_out ? 0 : 1.001f * p.radius;
    ray.origin =
        p.centroid + ray.direction * (away + 2 * ray_offset(magnitude_of(p.centroid) + p.radius));
  }
  return ray;
}

// Random walks from lights, with a ray towards environment light at each hit.
class Walks {
 public:
  Walks(const PreparedScene& scene, const EnvironmentSampler& points)
      : scene_(scene), points_(points) {}

  // Returns false as soon as a ray finds environment light.
  bool are_closed(std::vector<Ray>& rays, Random& random) {
    std::vector<Hit> hits;
    std::vector<uint8_t> is_hidden;
    for (int i = 0; i < most_segments && !rays.empty(); ++i) {
      hits.assign(rays.size(), {});
      scene_.tracer.closest(rays, hits, Coherence::none, Meeting::no_panes);
      asking_.clear();
      for (size_t k = 0; k < rays.size(); ++k) {
        if (!hits[k].is_valid()) return false;
        go_on(rays[k], hits[k], random);
      }
      is_hidden.assign(asking_.size(), 0);
      scene_.tracer.occluded(asking_, is_hidden);
      if (std::find(is_hidden.begin(), is_hidden.end(), 0) != is_hidden.end()) return false;
    }
    return true;
  }

 private:
  // Adds a ray towards environment light at the hit, and reflects the walk's ray.
  void go_on(Ray& ray, const Hit& hit, Random& random) {
    const Surface s = surface_at(scene_.scene, ray, hit);
    const Vec3& n = s.geometric_normal;
    ShadowReceiver r{};
    r.position = s.position;
    r.normal = r.horizon = dot(n, ray.direction) < 0 ? n : -n;
    r.origin = offset_origin(s, r.normal);
    const Vec2 u = random.next_vec2();
    const float place = random.next_float();
    if (points_.set_chances(r, chances_)) {
      const float share = chances_.suns() / (chances_.all() + chances_.suns());
      const EnvironmentSampler::Point p =
          points_.point(place < share ? points_.choose_any_sun(chances_, u.x, u.y, place / share)
                                      : points_.choose(chances_, u.x, u.y),
                        r.normal);
      if (p.source != nullptr && dot(p.wi, r.normal) > 0) {
        Ray& asking = asking_.emplace_back();
        asking.origin = r.origin;
        asking.direction = p.wi;
      }
    }
    ray.origin = r.origin;
    ray.direction = cosine_direction(r.normal, random.next_vec2());
  }

  const PreparedScene& scene_;
  const EnvironmentSampler& points_;
  EnvironmentSampler::Chances chances_;
  std::vector<Ray> asking_;
};

}  // namespace

bool are_lit_surfaces_closed(const PreparedScene& scene, const EnvironmentSampler& points,
                             const ClosedShells& shells) {
  std::vector<uint32_t> lights;
  for (uint32_t i = 0; i < scene.primitives.size(); ++i)
    if (!scene.primitives[i].is_infinite()) lights.push_back(i);
  if (lights.empty()) return false;
  Random random(stream::lit_surfaces);
  Walks walks(scene, points);
  std::vector<Ray> rays;
  for (size_t first = 0; first < most_walks; first += walks_at_a_time) {
    rays.clear();
    for (size_t k = first; k < first + walks_at_a_time; ++k) {
      const LightPrimitive& p = scene.primitives[lights[random.next_u32() % lights.size()]];
      const Ray ray = first_ray(p, random);
      if (!shells.hold(ray.origin)) rays.push_back(ray);
    }
    if (!walks.are_closed(rays, random)) return false;
  }
  return true;
}

}  // namespace troffer
