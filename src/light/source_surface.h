// The unit square laid over a whole light source so that equal areas of the square are equal areas
// of the source: what splitting a source in (u,v) stands on.
//
//   parallelogram   o + u U + v V, o the first vertex, U to the second, V to the last
//   other polygon   fan of triangles about vertex 0; u runs round the fan, each triangle having the
//                   part of [0,1] that is its part of the area; v goes outwards (its root is
//                   linear)
//   polygons        one after the other along u, each as it would be alone
//   mesh            its triangles in order of index, each as in a fan, about its first vertex
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

// origin + u U + v V; `normal` is unit, on the front.
struct Parallelogram {
  Vec3d origin, u, v, normal;
};

// The part [u0,u1] × [v0,v1] of the square.
struct SourceCell {
  float u0 = 0, u1 = 1, v0 = 0, v1 = 1;
  float measure() const { return (u1 - u0) * (v1 - v0); }
};

struct SourcePoint {
  Vec3 point;
  Vec3 normal;            // unit, on the emitting side
  Vec2 texture_uv;        // mesh sources; else (0,0)
  int32_t triangle = -1;  // polygon, mesh: index into the triangles of the source's mesh; a polygon
                          // counts as its first one; polygons: which of them
};

class SourceSurface {
 public:
  // The surface of scene.lights[light]. Triangles without area are left out; lights without surface
  // have area 0.
  SourceSurface(const Scene& scene, uint32_t light);

  // Convex polygons, counterclockwise seen from the front; those without area are left out. Cells
  // are compact where neighbours follow each other. Only one polygon alone can be a parallelogram.
  explicit SourceSurface(std::span<const std::vector<Vec3>> polygons);

  // m², one side; 0 where there is nothing to sample (then point_at must not be called).
  double area() const { return area_; }
  // Density of point_at per unit area, for u uniform on the square.
  double pdf_area() const { return 1 / area_; }
  double cell_area(const SourceCell& c) const { return double(c.measure()) * area_; }

  SourcePoint point_at(const Vec2& uv) const;
  // Inverse: (u,v) of a point on the source. A mesh needs the triangle it lies in (index into the
  // mesh's triangles), polygons which one; -1 searches for the piece that holds the point best,
  // which costs time.
  Vec2 uv_at(const Vec3& point, int32_t triangle = -1) const;

  bool is_parallelogram() const { return is_parallelogram_; }
  const Parallelogram& parallelogram() const { return parallelogram_; }  // where it is one
  // Parallelogram: the cell's corners, (u0,v0), (u1,v0), (u1,v1), (u0,v1).
  std::array<Vec3, 4> cell_corners(const SourceCell& c) const;
  // A box that holds the cell: its own bounds but for disks (the whole disk's, cut down to a ball
  // about the cell's middle), and for rounding, by which it is widened.
  Box cell_bounds(const SourceCell& c) const;

 private:
  // Triangle of a fan or a mesh, and the part [first_u, last_u) of the square that it gets.
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
  Frame frame_;  // disk: normal and directions of its plane
};

}  // namespace troffer
