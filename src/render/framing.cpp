#include "render/framing.h"

#include <cmath>
#include <vector>

#include "base/random.h"
#include "base/warp.h"
#include "render/camera.h"
#include "scene/mesh_in_world.h"

namespace troffer {

namespace {

constexpr size_t looked_from = 64, rays_each = 32;
constexpr float room_share = 0.65f;

// True if the ray meets the front of a triangle or sphere. Disks count from both sides.
bool meets_front(const Scene& scene, const Ray& ray, const Hit& hit) {
  if (!hit.is_valid()) return false;
  if (hit.geometry == scene.meshes.size()) {
    const Sphere& sphere = scene.spheres[hit.primitive];
    const bool is_inside = length(ray.origin - sphere.centre) < sphere.radius;
    return is_inside == sphere.is_inside_out;
  }
  if (!is_mesh(scene, hit.geometry)) return true;
  const auto [a, b, c] = mesh_at(scene, hit.geometry).corners(hit.primitive);
  return dot(cross(b - a, c - a), ray.direction) < 0;
}

// Looks at the object from the front, a little from its right and above. The whole bounding sphere
// is visible. glTF models face +z; where z is up, they face -y.
Camera outside_camera(const Scene& scene, const Vec3& up) {
  const Box box = bounds(scene);
  const Vec3 front = std::abs(up.z) > 0.7f ? Vec3{0, -1, 0} : Vec3{0, 0, 1};
  const Vec3 from = normalize(front + cross(up, front) * 0.55f + up * 0.45f);
  constexpr float fov_deg = 40, slack = 1.05f;
  const float radius = std::max(0.5f * box.diagonal(), 1e-6f);
  const float distance = slack * radius / float(std::sin(rad_from_deg(double(fov_deg)) / 2));
  const Vec3 centre = box.centre();
  return look_at(centre + from * distance, centre, up, fov_deg);
}

}  // namespace

bool is_room(const PreparedScene& scene) {
  const Box box = bounds(scene.scene);
  if (box.is_empty()) return false;
  Random random(1);
  std::vector<Ray> rays;
  for (size_t i = 0; i < looked_from; ++i) {
    const Vec3 share{random.next_float(), random.next_float(), random.next_float()};
    const Vec3 place = box.lower + box.extent() * (Vec3{0.15f} + share * 0.7f);
    for (size_t k = 0; k < rays_each; ++k) {
      Ray ray;
      ray.origin = place;
      ray.direction = sphere_from_square(random.next_vec2());
      rays.push_back(ray);
    }
  }
  std::vector<Hit> hits(rays.size());
  scene.tracer.closest(rays, hits);
  size_t fronts = 0;
  for (size_t i = 0; i < rays.size(); ++i) fronts += meets_front(scene.scene, rays[i], hits[i]);
  return float(fronts) > room_share * float(rays.size());
}

Camera framing_camera(const PreparedScene& scene, const Vec3& up_hint) {
  const Vec3 tall = abs(up_hint);
  const bool is_flat = bounds(scene.scene).is_empty();
  if (is_flat || is_room(scene)) return default_camera(scene.scene, up_hint);
  const Vec3 up = tall.x > tall.y && tall.x > tall.z ? Vec3{1, 0, 0}
                  : tall.y > tall.z                  ? Vec3{0, 1, 0}
                                                     : Vec3{0, 0, 1};
  return outside_camera(scene.scene, up);
}

}  // namespace troffer
