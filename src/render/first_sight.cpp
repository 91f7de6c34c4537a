#include "render/first_sight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "base/parallel.h"
#include "scene/mesh_in_world.h"

namespace troffer {

namespace {

constexpr int most_blocks = 128;  // along the longer side
constexpr size_t triangles_at_a_time = 1 << 16;

// The nearest surface in a block of pixels, and the cosine at which it is seen.
struct Seen {
  float distance = std::numeric_limits<float>::infinity();
  float cosine = 0;
  void take(float d, float c) {
    // Ties are resolved by the cosine, so that the order of threads does not matter.
    if (d > distance || (d == distance && c <= cosine)) return;
    distance = d;
    cosine = c;
  }
};

// The window divided into blocks, with a ray through the middle of each.
struct Grid {
  PixelRect window;
  int side, across, down;
  std::vector<Ray> rays;

  Grid(const ViewingCamera& camera, const PixelRect& w) : window(w) {
    side = std::max(1, (std::max(w.width(), w.height()) + most_blocks - 1) / most_blocks);
    across = (w.width() + side - 1) / side;
    down = (w.height() + side - 1) / side;
    for (int j = 0; j < down; ++j)
      for (int i = 0; i < across; ++i)
        rays.push_back(camera.ray({float(w.x0) + (float(i) + 0.5f) * float(side),
                                   float(w.y0) + (float(j) + 0.5f) * float(side)},
                                  {0.5f, 0.5f}));
  }
};

// Blocks i0 … i1 and j0 … j1, inclusive.
struct BlockRange {
  int i0, i1, j0, j1;
};

class Sight {
 public:
  Sight(const ViewingCamera& camera, const Grid& grid)
      : camera_(camera), grid_(grid), seen_(grid.rays.size()) {}

  void add(const std::array<Vec3, 3>& p) {
    std::array<Vec2, 3> at;
    int before = 0;
    for (size_t k = 0; k < 3; ++k)
      before += camera_.raster_of(p[k], at[k]) && std::isfinite(at[k].x + at[k].y) ? 1 : 0;
    if (before == 0) return;
    // all blocks if the triangle is partly behind the camera
    BlockRange r{0, grid_.across - 1, 0, grid_.down - 1};
    if (before == 3) {
      r = around(at);
      if (r.i1 < 0 || r.j1 < 0 || r.i0 >= grid_.across || r.j0 >= grid_.down) return;
      if (r.i0 == r.i1 && r.j0 == r.j1 && is_hidden(r.i0, r.j0, p)) return;
    }
    const Vec3 area = cross(p[1] - p[0], p[2] - p[0]);
    const float twice = length(area);
    if (!(twice > 0) || !std::isfinite(twice)) return;
    const Vec3 normal = area * (1 / twice);
    if (before == 3) {
      if (r.i0 == r.i1 && r.j0 == r.j1) return take(r.i0, r.j0, p, normal);
      r = {std::max(r.i0, 0), std::min(r.i1, grid_.across - 1), std::max(r.j0, 0),
           std::min(r.j1, grid_.down - 1)};
    }
    for (int j = r.j0; j <= r.j1; ++j)
      for (int i = r.i0; i <= r.i1; ++i) intersect(i, j, p, normal);
  }

  void merge(const Sight& other) {
    for (size_t i = 0; i < seen_.size(); ++i)
      seen_[i].take(other.seen_[i].distance, other.seen_[i].cosine);
  }

  Image image() const {
    Image image(grid_.window.width(), grid_.window.height());
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const Seen& s =
            seen_[size_t(y / grid_.side) * size_t(grid_.across) + size_t(x / grid_.side)];
        constexpr float darkest = 0.05f, brightest = 0.4f;
        if (std::isfinite(s.distance))
          image.at(x, y) = Rgb{darkest + (brightest - darkest) * s.cosine};
      }
    return image;
  }

 private:
  // Returns the blocks around the corners. Indices just beyond the window stand for everything
  // there.
  BlockRange around(const std::array<Vec2, 3>& at) const {
    const auto block = [&](float raster, int first, int count) {
      const float b = (raster - float(first)) / float(grid_.side);
      return int(std::floor(std::clamp(b, -1.0f, float(count))));
    };
    const auto [x0, x1] = std::minmax({at[0].x, at[1].x, at[2].x});
    const auto [y0, y1] = std::minmax({at[0].y, at[1].y, at[2].y});
    return {block(x0, grid_.window.x0, grid_.across), block(x1, grid_.window.x0, grid_.across),
            block(y0, grid_.window.y0, grid_.down), block(y1, grid_.window.y0, grid_.down)};
  }

  Seen& seen(int i, int j) { return seen_[size_t(j) * size_t(grid_.across) + size_t(i)]; }

  // True if a triangle within one block lies behind the surface seen there.
  bool is_hidden(int i, int j, const std::array<Vec3, 3>& p) {
    return distance_of(p) > seen(i, j).distance;
  }

  float distance_of(const std::array<Vec3, 3>& p) const {
    const Vec3 middle = middle_of(p);
    return camera_.is_perspective() ? camera_.distance(middle) : camera_.depth(middle);
  }

  static Vec3 middle_of(const std::array<Vec3, 3>& p) {
    return (p[0] + p[1] + p[2]) * (1.0f / 3.0f);
  }

  // Adds a triangle within one block as if it filled the block.
  void take(int i, int j, const std::array<Vec3, 3>& p, const Vec3& normal) {
    seen(i, j).take(distance_of(p), std::abs(dot(normal, camera_.towards_eye(middle_of(p)))));
  }

  // Adds the intersection of the block's ray with the triangle, if there is one.
  void intersect(int i, int j, const std::array<Vec3, 3>& p, const Vec3& normal) {
    const Ray& ray = grid_.rays[size_t(j) * size_t(grid_.across) + size_t(i)];
    const float cosine = dot(normal, ray.direction);
    const float t = dot(normal, p[0] - ray.origin) / cosine;
    if (!(t > 0) || !std::isfinite(t)) return;
    const Vec3 at = ray.origin + ray.direction * t;
    for (size_t k = 0; k < 3; ++k)
      if (dot(cross(p[(k + 1) % 3] - p[k], at - p[k]), normal) < 0) return;
    seen(i, j).take(t, std::abs(cosine));
  }

  const ViewingCamera& camera_;
  const Grid& grid_;
  std::vector<Seen> seen_;
};

// Every step-th triangle of a mesh, starting at `first`.
struct MeshPart {
  uint32_t geometry;
  size_t first, step;
};

// Divides the meshes into parts. Of instances of large meshes only some triangles are taken, since
// they are small.
std::vector<MeshPart> parts_of(const Scene& scene) {
  constexpr size_t most_triangles = 1 << 24, few_triangles = 1 << 12;
  const size_t every = 1 + triangle_count(scene) / most_triangles;
  std::vector<MeshPart> parts;
  for_each_mesh(scene, [&](uint32_t geometry, const MeshInWorld& mesh) {
    const bool is_whole = mesh.instance() == nullptr;
    const size_t step = is_whole ? 1 : std::min(every, 1 + mesh.size() / few_triangles);
    for (size_t first = 0; first < mesh.size(); first += triangles_at_a_time * step)
      parts.push_back({geometry, first, step});
  });
  return parts;
}

}  // namespace

Image first_sight(const Scene& scene, const ViewingCamera& camera, const PixelRect& window,
                  int threads) {
  const Grid grid(camera, window);
  std::vector<Sight> sights(size_t(thread_count(threads)), Sight(camera, grid));
  const std::vector<MeshPart> parts = parts_of(scene);
  parallel_for_slots(parts.size(), threads, [&](size_t i, size_t slot) {
    const MeshPart& part = parts[i];
    const MeshInWorld mesh = mesh_at(scene, part.geometry);
    const size_t end = std::min(mesh.size(), part.first + triangles_at_a_time * part.step);
    for (size_t t = part.first; t < end; t += part.step) sights[slot].add(mesh.corners(t));
  });
  for (size_t i = 1; i < sights.size(); ++i) sights[0].merge(sights[i]);
  return sights[0].image();
}

}  // namespace troffer
