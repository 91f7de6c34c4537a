// A map from the unit square to a whole light source that preserves area up to a constant factor.
// The bintree of `kj92` and other subdivisions of a source in (u,v) rely on it.
//
//   parallelogram   o + u U + v V, o the first vertex, U to the second, V to the last
//   other polygon   fan of triangles about vertex 0; u runs round the fan, each triangle taking
//                   its share of the area; v runs outwards, in the square of the distance
//   polygons        one after the other along u, each mapped as it would be alone
//   mesh            its triangles by index, each mapped as in a fan about its first vertex
//   disk            concentric map [1]
//   sphere          z = 1 - 2v, azimuth 2 pi u about world z (Archimedes)
// References: [1] Shirley & Chiu, "A Low Distortion Map Between Disk and Square", JGT 2(3), 1997.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/box.h"
#include "base/frame.h"
#include "base/vec.h"
#include "scene/scene.h"

namespace troffer {

// The points origin + u U + v V. normal: unit, on the front.
struct Parallelogram {
  Vec3d origin, u, v, normal;
};

// The part [u0,u1] × [v0,v1] of the square.
struct SourceCell {
  float u0 = 0, u1 = 1, v0 = 0, v1 = 1;
  float measure() const { return (u1 - u0) * (v1 - v0); }
};

// A point of a light source.
struct SourcePoint {
  Vec3 point;
  Vec3 normal;      // unit, on the emitting side
  Vec2 texture_uv;  // mesh lights; else (0,0)
  // Index of a triangle in the source's mesh (for a polygon light, its first one), or index of one
  // of several polygons; -1: none.
  int32_t triangle = -1;
};

class SourceSurface {
 public:
  // The surface of scene.lights[light]. Triangles without area are left out. Lights without surface
  // have area 0.
  SourceSurface(const Scene& scene, uint32_t light);

  // Convex polygons, counterclockwise seen from the front; those without area are left out. Order
  // them so that neighbours follow each other, to keep cells compact. Only a single polygon can be
  // a parallelogram.
  explicit SourceSurface(std::span<const std::vector<Vec3>> polygons);

  // Area of one side, m². If it is 0, point_at() must not be called.
  double area() const { return area_; }
  // Density of point_at() per unit area, for u uniform on the square.
  double pdf_area() const { return 1 / area_; }
  double cell_area(const SourceCell& c) const { return double(c.measure()) * area_; }

  SourcePoint point_at(const Vec2& uv) const;
  // Inverse of point_at(). triangle: for a mesh, index of the triangle in the mesh; for polygons,
  // index of the polygon. With -1 it searches for the piece that contains the point best, which is
  // slower.
  Vec2 uv_at(const Vec3& point, int32_t triangle = -1) const;

  bool is_parallelogram() const { return is_parallelogram_; }
  // only if is_parallelogram()
  const Parallelogram& parallelogram() const { return parallelogram_; }
  // Corners of a cell of a parallelogram: (u0,v0), (u1,v0), (u1,v1), (u0,v1).
  std::array<Vec3, 4> cell_corners(const SourceCell& c) const;
  // A bounding box of the cell, widened by rounding. It is tight except for disks, where it is the
  // disk's box cut by a ball around the cell's middle.
  Box cell_bounds(const SourceCell& c) const;

 private:
  // A triangle of a fan or mesh, and the part [first_u, last_u) of the square that it takes.
  struct Piece {
    Vec3 apex, from, to;  // u runs from `from` to `to`
    Vec3 normal;
    double first_u = 0, last_u = 0;
    int32_t triangle = -1;
    Vec2 uvs[3];
  };
  void add_polygon(std::span<const Vec3> corners, int32_t index);
  void set_parallelogram(std::span<const Vec3> corners);
  void finish_pieces();
  void add_piece(const Vec3& apex, const Vec3& from, const Vec3& to, int32_t triangle);
  const Piece& piece_at(double u) const;
  Box round_bounds(const SourceCell& c) const;

  LightKind shape_;
  double area_ = 0;
  bool is_parallelogram_ = false;
  Parallelogram parallelogram_;
  int32_t first_triangle_ = -1;
  std::vector<Piece> pieces_;
  Vec3 centre_;  // disk, sphere
  float radius_ = 0;
  bool is_inside_out_ = false;
  Frame frame_;  // disk: its normal and the axes of its plane
};

}  // namespace troffer
