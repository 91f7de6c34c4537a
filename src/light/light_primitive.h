// The scene's lights cut into simple pieces that can be chosen, sampled and hit: convex polygons,
// triangles of mesh sources, disks, spheres; and one piece, which no ray hits, of each light
// without surface.
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

// Parallelograms without right angles and other polygons are `polygon`.
// Without surface: `point` has a position, `infinite` has none.
enum class PrimitiveShape : uint8_t { rectangle, triangle, polygon, disk, sphere, point, infinite };

constexpr int32_t no_primitive = -1;

// One piece of a light. Plain data; what is read by sampling comes first.
struct LightPrimitive {
  PrimitiveShape shape = PrimitiveShape::triangle;
  bool is_two_sided = false;
  bool is_inside_out = false;    // sphere: the front is inside
  uint32_t vertex_count = 0;     // 0 for disk and sphere
  float area = 0;                // m², one side
  float radius = 0;              // disk, sphere; else the farthest vertex from the centroid, m
  Vec3 centroid;                 // disk, sphere: the centre
  Vec3 axis_x, axis_y;           // rectangle: unit, along its sides; disk: any in its plane
  float size_x = 0, size_y = 0;  // rectangle: side lengths, m
  Vec3d normal;                  // unit, on the front side; sphere: zero
  Vec3 vertices[4];              // counterclockwise seen from the front, where vertex_count <= 4
  const Vec3* more_vertices = nullptr;  // all of them, where vertex_count > 4; LightPrimitives owns
  Vec2 uvs[3];                          // triangle: texture coordinates of the vertices
  // infinite: by which directions are drawn, or none; LightPrimitives owns
  const DirectionTable* directions = nullptr;
  const Portal* portal = nullptr;  // … through which alone; so too

  uint32_t light = 0;        // index into Scene::lights
  int32_t triangle = -1;     // of a mesh source: index into that mesh's triangles
  bool is_textured = false;  // radiance varies: a texture, holes of an alpha mask, or a web
  Rgb mean_radiance;         // over the surface, W/(m² sr) or cd/m²
  float power = 0;           // luminance of the flux that leaves: pi area L, twice if two-sided
  // What light trees take for power: that of a light as strong in all its directions as this one is
  // in its strongest.
  float tree_power = 0;
  Box bounds;  // world space; empty where infinite
  // Cone of surface normals, for light trees: unit axis and cosine of its half angle (1: all equal;
  // -1: all directions). From each normal, light leaves through the hemisphere around it (both
  // hemispheres where is_two_sided). Of what is infinite: the directions that its light takes.
  Vec3 cone_axis{0, 0, 1};
  float cos_cone = -1;

  bool has_surface() const { return shape <= PrimitiveShape::sphere; }
  bool is_infinite() const { return shape == PrimitiveShape::infinite; }

  const Vec3& vertex(uint32_t i) const {
    const Vec3* first = more_vertices ? more_vertices : vertices;
    return first[i];
  }
};

// All pieces of a scene's lights, in the order of Scene::lights and within them in the order
// of triangles, and the way back from what a ray hit. Surfaces without area and black lights are
// left out.
class LightPrimitives {
 public:
  LightPrimitives() = default;
  explicit LightPrimitives(const Scene& scene);
  // A primitive points into its owner's vertices: moving keeps them, copying would not.
  LightPrimitives(const LightPrimitives&) = delete;
  LightPrimitives& operator=(const LightPrimitives&) = delete;
  LightPrimitives(LightPrimitives&&) = default;
  LightPrimitives& operator=(LightPrimitives&&) = default;

  const std::vector<LightPrimitive>& all() const { return primitives_; }
  size_t size() const { return primitives_.size(); }
  const LightPrimitive& operator[](size_t i) const { return primitives_[i]; }

  // The pieces [first, last) of a light.
  struct Range {
    uint32_t first = 0, last = 0;
  };
  Range of_light(uint32_t light) const { return ranges_[light]; }

  // The pieces that are infinite, in increasing order.
  const std::vector<uint32_t>& at_infinity() const { return at_infinity_; }

  // What was hit -> index of its piece, or no_primitive.
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
  std::vector<std::vector<Vec3>> vertices_;  // of polygons with more than 4
  std::vector<std::unique_ptr<const DirectionTable>> directions_;
  std::vector<std::unique_ptr<const Portal>> portals_;
  std::vector<Range> ranges_;  // per light
  std::vector<uint32_t> at_infinity_;
  std::vector<std::vector<int32_t>> triangle_table_;  // per mesh: empty, or per triangle
  std::vector<int32_t> disk_table_, sphere_table_;
  std::vector<std::unique_ptr<const WebSamples>> web_samples_;  // per web, while pieces are made
};

}  // namespace troffer
