#include "render/sub_pixel_features.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "render/segment_walk.h"
#include "scene/mesh_in_world.h"

namespace troffer {

namespace {

// Width in pixels from which a feature covers a corner almost wherever it lies.
constexpr float narrow = 1.5f;
// A mesh with more triangles per pixel, over its bounding rectangle, is fine everywhere. Corners
// show that, and its triangles are too many to test one by one.
constexpr double most_per_pixel = 64;
// Rays end this far along the way to a feature, so that rounding does not make it hide itself.
constexpr float reach = 0.999f;

class Search {
 public:
  Search(const PreparedScene& scene, const ViewingCamera& camera, const PixelRect& region,
         const PixelCorners& corners, std::span<const uint8_t> has_edge)
      : scene_(scene),
        camera_(camera),
        region_(region),
        corners_(corners),
        walk_(camera, region),
        states_(has_edge.size()) {
    for (size_t i = 0; i < has_edge.size(); ++i)
      if (has_edge[i] != 0) states_[i] = left_out;
  }

  void look_at(const MeshInWorld& mesh, const Box& bounds, uint32_t geometry, int threads) {
    if (mesh.size() == 0 || !is_worth_while(bounds, mesh.size())) return;
    constexpr size_t piece = 4096;
    parallel_for((mesh.size() + piece - 1) / piece, threads, [&](size_t k) {
      const size_t end = std::min((k + 1) * piece, mesh.size());
      for (size_t i = k * piece; i < end; ++i) look_at_triangle(mesh.corners(i), geometry);
    });
  }

  // Tests a sphere or disk around `centre` whose visible point is `front`, with this normal.
  void look_at_round(const Vec3& centre, const Vec3& front, const Vec3& normal, float radius,
                     uint32_t geometry) {
    const Vec3 other = std::abs(normal.x) < 0.9f ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 rim = centre + normalize(cross(normal, other)) * radius;
    Vec2 at, beside;
    if (!camera_.raster_of(centre, at) || !is_inside(at) || !camera_.raster_of(rim, beside)) return;
    if (!(2 * length_of(beside - at) < narrow)) return;
    SeenPlace place;
    place.geometry = geometry;
    place.position = front;
    place.normal = normal;
    look_at_place(place, at);
  }

  std::vector<uint8_t> found() const {
    std::vector<uint8_t> out;
    out.reserve(states_.size());
    for (const std::atomic<uint8_t>& state : states_)
      out.push_back(state.load(std::memory_order_relaxed) == something ? 1 : 0);
    return out;
  }

 private:
  size_t index(int x, int y) const {
    return size_t(y - region_.y0) * size_t(region_.width()) + size_t(x - region_.x0);
  }
  bool is_inside(const Vec2& r) const {
    return r.x >= float(region_.x0) && r.x < float(region_.x1) && r.y >= float(region_.y0) &&
           r.y < float(region_.y1);
  }
  static float length_of(const Vec2& v) { return std::sqrt(v.x * v.x + v.y * v.y); }

  // True if some of the box may be visible and its mesh is not too dense there.
  bool is_worth_while(const Box& box, size_t triangles) const {
    if (box.is_empty()) return false;
    Vec2 low{1e30f, 1e30f}, high{-1e30f, -1e30f};
    for (size_t k = 0; k < 8; ++k) {
      const Vec3 corner{k % 2 != 0 ? box.upper.x : box.lower.x,
                        k / 2 % 2 != 0 ? box.upper.y : box.lower.y,
                        k / 4 != 0 ? box.upper.z : box.lower.z};
      Vec2 r;
      if (!camera_.raster_of(corner, r)) return true;
      low = {std::min(low.x, r.x), std::min(low.y, r.y)};
      high = {std::max(high.x, r.x), std::max(high.y, r.y)};
    }
    if (high.x < float(region_.x0) || low.x > float(region_.x1) || high.y < float(region_.y0) ||
        low.y > float(region_.y1))
      return false;
    const double pixels =
        std::max(1.0, double(high.x - low.x)) * std::max(1.0, double(high.y - low.y));
    return double(triangles) <= most_per_pixel * pixels;
  }

  void look_at_triangle(const std::array<Vec3, 3>& corner, uint32_t geometry) {
    std::array<Vec2, 3> r;
    for (size_t k = 0; k < 3; ++k)
      if (!camera_.raster_of(corner[k], r[k])) return;
    const auto [x0, x1] = std::minmax({r[0].x, r[1].x, r[2].x});
    const auto [y0, y1] = std::minmax({r[0].y, r[1].y, r[2].y});
    if (!(x1 >= float(region_.x0) && x0 < float(region_.x1) && y1 >= float(region_.y0) &&
          y0 < float(region_.y1)))
      return;
    // Find the longest side, from a to b, and the opposite corner.
    size_t a = 0;
    float longest = -1;
    for (size_t k = 0; k < 3; ++k) {
      const float side = length_of(r[(k + 1) % 3] - r[k]);
      if (side > longest) longest = side, a = k;
    }
    const size_t b = (a + 1) % 3, c = (a + 2) % 3;
    const Vec2 along = r[b] - r[a], to = r[c] - r[a];
    const float twice_area = std::abs(along.x * to.y - along.y * to.x);
    if (!(twice_area < narrow * longest)) return;
    const float peak = (along.x * to.x + along.y * to.y) / (longest * longest);

    SeenPlace place;
    place.geometry = geometry;
    const Vec3 normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
    const float size = length(normal);
    if (!(size > 0)) return;
    place.is_front = dot(normal, camera_.towards_eye(corner[0])) >= 0;
    place.normal = normal * ((place.is_front ? 1 : -1) / size);
    // Test places near the corners, and along the line half-way across the triangle.
    constexpr float inwards = 0.1f;
    const Vec3 middle = (corner[0] + corner[1] + corner[2]) * (1.0f / 3);
    for (const Vec3& p : corner) {
      Vec2 at;
      place.position = p + (middle - p) * inwards;
      if (camera_.raster_of(place.position, at) && is_inside(at)) look_at_place(place, at);
    }
    Vec2 last{-1, -1};  // the last pixel; places of one pixel come in succession
    const auto look = [&](const Vec3& position, const Vec2& at) {
      if (int(at.x) == int(last.x) && int(at.y) == int(last.y)) return;
      last = at;
      place.position = position;
      look_at_place(place, at);
    };
    const Vec3 across = (corner[a] + (corner[b] - corner[a]) * peak + corner[c]) * 0.5f;
    walk_.walk(corner[a], across, look);
    walk_.walk(across, corner[b], look);
  }

  void look_at_place(const SeenPlace& place, const Vec2& at) {
    const size_t i = index(int(at.x), int(at.y));
    if (states_[i].load(std::memory_order_relaxed) != open) return;
    const SeenPlace& seen = corners_.of(int(at.x), int(at.y));
    if (place.is_of_surface_of(seen)) return;
    Ray ray = camera_.ray(at, {0.5f, 0.5f});
    const float distance = length(place.position - ray.origin);
    // Hidden behind the single surface that all corners see.
    if (seen.geometry != no_geometry && dot(seen.position - place.position, seen.normal) > 0 &&
        distance > length(seen.position - ray.origin))
      return;
    ray.t_max = reach * distance;
    uint8_t is_hidden = 0;
    scene_.tracer.occluded({&ray, 1}, {&is_hidden, 1}, Coherence::coherent);
    // Threads that race here store the same value.
    if (is_hidden == 0) states_[i].store(something, std::memory_order_relaxed);
  }

  enum State : uint8_t { open, left_out, something };

  const PreparedScene& scene_;
  const ViewingCamera& camera_;
  PixelRect region_;
  const PixelCorners& corners_;
  SegmentWalk walk_;
  std::vector<std::atomic<uint8_t>> states_;
};

}  // namespace

std::vector<uint8_t> pixels_with_sub_pixel_features(
    const PreparedScene& prepared, const ViewingCamera& camera, const PixelRect& region,
    const PixelCorners& corners, std::span<const uint8_t> has_edge, int threads) {
  const Scene& scene = prepared.scene;
  Search search(prepared, camera, region, corners, has_edge);
  for (uint32_t m = 0; m < scene.meshes.size(); ++m) {
    Box box;
    for (const Vec3& p : scene.meshes[m].positions) box.grow(p);
    search.look_at(MeshInWorld(scene.meshes[m]), box, m, threads);
  }
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    search.look_at(MeshInWorld(scene.instanced_meshes[instance.mesh], &instance), instance.bounds,
                   first_instance(scene) + i, threads);
  }
  const auto meshes = uint32_t(scene.meshes.size());
  for (const Sphere& s : scene.spheres) {
    const Vec3 normal = camera.towards_eye(s.centre);
    search.look_at_round(s.centre, s.centre + normal * s.radius, normal, s.radius, meshes);
  }
  for (const Disk& d : scene.disks) {
    const float side = dot(d.normal, camera.towards_eye(d.centre)) < 0 ? -1.0f : 1.0f;
    search.look_at_round(d.centre, d.centre, d.normal * side, d.radius, meshes + 1);
  }
  return search.found();
}

}  // namespace troffer
