// The scene's lights, cut into simple pieces that can be chosen, sampled and hit: convex polygons,
// triangles of mesh lights, disks and spheres. A light without surface is one piece, which no ray
// hits. All direct light methods and light trees use these pieces.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/box.h"
#include "base/rgb.h"
#include "base/vec.h"
#include "light/direction_table.h"
#include "light/portal.h"
#include "light/web.h"
#include "scene/scene.h"

namespace troffer {

// Shape of a piece. Parallelograms without right angles count as polygons. Among pieces without
// surface, `point` has a position and `infinite` has none.
enum class PrimitiveShape : uint8_t { rectangle, triangle, polygon, disk, sphere, point, infinite };

constexpr int32_t no_primitive = -1;

// One piece of a light: plain data. The fields that sampling reads come first.
struct LightPrimitive {
  PrimitiveShape shape = PrimitiveShape::triangle;
  bool is_two_sided = false;
  bool is_inside_out = false;  // sphere whose front is the inside
  uint32_t vertex_count = 0;   // 0 for disk and sphere
  float area = 0;              // one side, m²
  float radius = 0;     // radius of disk or sphere; else farthest vertex from the centroid; metres
  Vec3 centroid;        // centre of a disk or sphere
  Vec3 axis_x, axis_y;  // unit: along a rectangle's sides; orthogonal axes of a disk
  float size_x = 0, size_y = 0;  // side lengths of a rectangle, metres
  Vec3d normal;                  // unit, on the front side; zero for spheres
  Vec3 vertices[4];              // counterclockwise seen from the front, if vertex_count <= 4
  // all vertices if vertex_count > 4, owned by LightPrimitives
  const Vec3* more_vertices = nullptr;
  Vec2 uvs[3];  // triangle: texture coordinates of the vertices
  // Table for sampling directions of an infinite piece, or null. Owned by LightPrimitives.
  const DirectionTable* directions = nullptr;
  const Portal* portal = nullptr;  // null: none; owned by LightPrimitives

  uint32_t light = 0;        // index in Scene::lights
  int32_t triangle = -1;     // mesh lights: index in the mesh's triangles
  bool is_textured = false;  // radiance varies by texture, alpha mask or web
  Rgb mean_radiance;         // mean over the surface, W/(m² sr) or cd/m²
  float power = 0;           // luminance of the emitted flux: pi area L, twice if two-sided
  // Power used by light trees: the power of a light that emits in every direction as much as this
  // one does in its strongest.
  float tree_power = 0;
  Box bounds;  // in world space; empty if infinite
  // Cone of surface normals, for light trees: unit axis, and cosine of the half angle (1: one
  // normal; -1: all directions). Light leaves through the hemisphere around each normal, or both
  // hemispheres if two-sided. For infinite pieces: the directions in which light travels.
  Vec3 cone_axis{0, 0, 1};
  float cos_cone = -1;

  bool has_surface() const { return shape <= PrimitiveShape::sphere; }
  bool is_infinite() const { return shape == PrimitiveShape::infinite; }

  const Vec3& vertex(uint32_t i) const {
    const Vec3* first = more_vertices ? more_vertices : vertices;
    return first[i];
  }
};

// All pieces of a scene's lights, and their lookup from what a ray hit. Order: that of
// Scene::lights, then that of triangles. Black lights and surfaces without area are left out.
class LightPrimitives {
 public:
  LightPrimitives() = default;
  explicit LightPrimitives(const Scene& scene);
  // Not copyable, because pieces point into vertices_. Moving keeps those pointers valid.
  LightPrimitives(const LightPrimitives&) = delete;
  LightPrimitives& operator=(const LightPrimitives&) = delete;
  LightPrimitives(LightPrimitives&&) = default;
  LightPrimitives& operator=(LightPrimitives&&) = default;

  const std::vector<LightPrimitive>& all() const { return primitives_; }
  size_t size() const { return primitives_.size(); }
  const LightPrimitive& operator[](size_t i) const { return primitives_[i]; }

  // Range [first, last) of a light's pieces.
  struct Range {
    uint32_t first = 0, last = 0;
  };
  Range of_light(uint32_t light) const { return ranges_[light]; }

  // Indices of the infinite pieces, in increasing order.
  const std::vector<uint32_t>& at_infinity() const { return at_infinity_; }

  // Index of the piece that was hit, or no_primitive.
  int32_t of_triangle(uint32_t mesh, uint32_t triangle) const {
    const std::vector<int32_t>& t = triangle_table_[mesh];
    return t.empty() ? no_primitive : t[triangle];
  }
  int32_t of_disk(uint32_t disk) const { return disk_table_[disk]; }
  int32_t of_sphere(uint32_t sphere) const { return sphere_table_[sphere]; }

 private:
  void add_polygon(const Scene& scene, uint32_t light);
  void add_mesh(const Scene& scene, uint32_t light);
  void add_disk(const Scene& scene, uint32_t light);
  void add_sphere(const Scene& scene, uint32_t light);
  void add_without_surface(const Scene& scene, uint32_t light, const Box& scene_bounds);
  void set_web(const Scene& scene, const Light& e, LightPrimitive& p);
  int32_t append(LightPrimitive p, const Light& e);

  std::vector<LightPrimitive> primitives_;
  std::vector<std::vector<Vec3>> vertices_;  // vertices of polygons with more than 4 vertices
  std::vector<std::unique_ptr<const DirectionTable>> directions_;
  std::vector<std::unique_ptr<const Portal>> portals_;
  std::vector<Range> ranges_;  // per light
  std::vector<uint32_t> at_infinity_;
  std::vector<std::vector<int32_t>> triangle_table_;  // per mesh: empty, or per triangle
  std::vector<int32_t> disk_table_, sphere_table_;
  std::vector<std::unique_ptr<const WebSamples>> web_samples_;  // per web; empty after construction
};

}  // namespace troffer
