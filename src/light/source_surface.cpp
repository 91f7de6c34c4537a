#include "light/source_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"
#include "base/warp.h"
#include "light/polygon.h"

namespace troffer {

void SourceSurface::add_piece(const Vec3& apex, const Vec3& from, const Vec3& to,
                              int32_t triangle) {
  const Vec3d twice = cross(Vec3d(from) - Vec3d(apex), Vec3d(to) - Vec3d(apex));
  const double area = length(twice) / 2;
  if (!(area > 0) || !std::isfinite(area)) return;
  Piece p{apex, from, to, Vec3(twice / (2 * area)), area_, area_ + area, triangle, {}};
  area_ += area;
  pieces_.push_back(p);
}

void SourceSurface::add_polygon(std::span<const Vec3> v, int32_t index) {
  for (size_t i = 1; i + 1 < v.size(); ++i) add_piece(v[0], v[i], v[i + 1], index);
}

void SourceSurface::finish_pieces() {
  for (Piece& p : pieces_) {
    p.first_u /= area_;
    p.last_u /= area_;
  }
  if (!pieces_.empty()) pieces_.back().last_u = 1;
}

void SourceSurface::set_parallelogram(std::span<const Vec3> v) {
  const Vec3d vector = area_vector(v);
  area_ = length(vector);
  is_parallelogram_ = area_ > 0;
  parallelogram_ = {Vec3d(v[0]), Vec3d(v[1]) - Vec3d(v[0]), Vec3d(v[3]) - Vec3d(v[0]),
                    area_ > 0 ? vector / area_ : Vec3d{0, 0, 1}};
}

SourceSurface::SourceSurface(std::span<const std::vector<Vec3>> polygons)
    : shape_(LightKind::mesh) {
  if (polygons.size() == 1 && troffer::is_parallelogram(polygons[0])) {
    shape_ = LightKind::polygon;
    first_triangle_ = 0;
    set_parallelogram(polygons[0]);
    return;
  }
  for (size_t i = 0; i < polygons.size(); ++i) add_polygon(polygons[i], int32_t(i));
  finish_pieces();
}

SourceSurface::SourceSurface(const Scene& scene, uint32_t light)
    : shape_(scene.lights[light].kind) {
  const Light& e = scene.lights[light];
  switch (shape_) {
    case LightKind::polygon: {
      const std::vector<Vec3>& v = e.polygon;
      if (!e.triangles.empty()) first_triangle_ = int32_t(e.triangles[0]);
      if (troffer::is_parallelogram(v))
        set_parallelogram(v);
      else
        add_polygon(v, first_triangle_);
      break;
    }
    case LightKind::mesh: {
      const Mesh& mesh = scene.meshes[e.geometry];
      for (const uint32_t t : e.triangles) {
        const Triangle& c = mesh.triangles[t];
        const size_t before = pieces_.size();
        add_piece(mesh.positions[c[0]], mesh.positions[c[1]], mesh.positions[c[2]], int32_t(t));
        if (pieces_.size() > before && !mesh.uvs.empty())
          for (size_t i = 0; i < 3; ++i) pieces_.back().uvs[i] = mesh.uvs[c[i]];
      }
      break;
    }
    case LightKind::disk: {
      const Disk& disk = scene.disks[e.geometry];
      centre_ = disk.centre;
      radius_ = disk.radius;
      frame_ = Frame(normalize(disk.normal));
      area_ = pi * sqr(double(radius_));
      break;
    }
    case LightKind::sphere: {
      const Sphere& sphere = scene.spheres[e.geometry];
      centre_ = sphere.centre;
      radius_ = sphere.radius;
      is_inside_out_ = sphere.is_inside_out;
      area_ = 4 * pi * sqr(double(radius_));
      break;
    }
    case LightKind::point:
    case LightKind::spot:
    case LightKind::distant:
    case LightKind::environment:
    case LightKind::sky:
    case LightKind::sun:
      return;  // without surface
  }
  finish_pieces();
}

const SourceSurface::Piece& SourceSurface::piece_at(double u) const {
  const auto it = std::upper_bound(pieces_.begin(), pieces_.end(), u,
                                   [](double value, const Piece& p) { return value < p.last_u; });
  return it == pieces_.end() ? pieces_.back() : *it;
}

SourcePoint SourceSurface::point_at(const Vec2& uv) const {
  SourcePoint s;
  if (is_parallelogram_) {
    const Parallelogram& p = parallelogram_;
    s.point = Vec3(p.origin + p.u * double(uv.x) + p.v * double(uv.y));
    s.normal = Vec3(p.normal);
    s.triangle = first_triangle_;
  } else if (shape_ == LightKind::disk) {
    const Vec2 d = disk_from_square(uv) * radius_;
    s.point = centre_ + frame_.tangent * d.x + frame_.bitangent * d.y;
    s.normal = frame_.normal;
  } else if (shape_ == LightKind::sphere) {
    const Vec3 out = sphere_from_square({uv.y, uv.x});
    s.point = centre_ + out * radius_;
    s.normal = is_inside_out_ ? -out : out;
  } else {
    const Piece& p = piece_at(double(uv.x));
    const float along =
        std::clamp(float((double(uv.x) - p.first_u) / (p.last_u - p.first_u)), 0.0f, 1.0f);
    const float outwards = std::sqrt(uv.y);
    const float b1 = outwards * (1 - along), b2 = outwards * along;
    s.point = p.apex + (p.from - p.apex) * b1 + (p.to - p.apex) * b2;
    s.normal = p.normal;
    s.texture_uv = p.uvs[0] + (p.uvs[1] - p.uvs[0]) * b1 + (p.uvs[2] - p.uvs[0]) * b2;
    s.triangle = p.triangle;
  }
  return s;
}

Vec2 SourceSurface::uv_at(const Vec3& point, int32_t triangle) const {
  if (is_parallelogram_) {
    const Parallelogram& p = parallelogram_;
    const Vec3d d = Vec3d(point) - p.origin;
    const double whole = dot(cross(p.u, p.v), p.normal);
    return {float(dot(cross(d, p.v), p.normal) / whole),
            float(dot(cross(p.u, d), p.normal) / whole)};
  }
  if (shape_ == LightKind::disk) {
    const Vec3 local = frame_.to_local(point - centre_) / radius_;
    return square_from_disk(Vec2{local.x, local.y});
  }
  if (shape_ == LightKind::sphere) {
    const Vec2 uv = square_from_sphere(normalize(point - centre_));
    return {uv.y, uv.x};
  }
  // Find the piece of the triangle that the point is nearest to, by distance outside its edges or
  // off its plane, relative to its size.
  Vec2 best;
  double least = std::numeric_limits<double>::infinity();
  for (const Piece& p : pieces_) {
    if (triangle >= 0 && shape_ == LightKind::mesh && p.triangle != triangle) continue;
    const Vec3d e = Vec3d(p.from) - Vec3d(p.apex), f = Vec3d(p.to) - Vec3d(p.apex);
    const Vec3d d = Vec3d(point) - Vec3d(p.apex), n = cross(e, f);
    const double nn = length_squared(n);
    const double b1 = dot(cross(d, f), n) / nn, b2 = dot(cross(e, d), n) / nn;
    const double stray =
        std::max({-b1, -b2, b1 + b2 - 1, std::abs(dot(d, n)) / std::pow(nn, 0.75)});
    if (stray >= least) continue;
    least = stray;
    const double out = std::clamp(b1 + b2, 0.0, 1.0);
    const double along = b1 + b2 > 0 ? std::clamp(b2 / (b1 + b2), 0.0, 1.0) : 0;
    best = {float(p.first_u + along * (p.last_u - p.first_u)), float(out * out)};
  }
  return best;
}

std::array<Vec3, 4> SourceSurface::cell_corners(const SourceCell& c) const {
  return {point_at({c.u0, c.v0}).point, point_at({c.u1, c.v0}).point, point_at({c.u1, c.v1}).point,
          point_at({c.u0, c.v1}).point};
}

Box SourceSurface::cell_bounds(const SourceCell& c) const {
  Box box;
  if (is_parallelogram_) {
    for (const Vec3& p : cell_corners(c)) box.grow(p);
  } else if (shape_ == LightKind::disk || shape_ == LightKind::sphere) {
    box = round_bounds(c);
  } else {
    // Within a piece a cell is a quadrilateral.
    const float inner = std::sqrt(c.v0), outer = std::sqrt(c.v1);
    for (const Piece& p : pieces_) {
      if (p.last_u < double(c.u0) || p.first_u > double(c.u1)) continue;
      const double width = p.last_u - p.first_u;
      for (const float u : {c.u0, c.u1}) {
        const float along = float(std::clamp((double(u) - p.first_u) / width, 0.0, 1.0));
        const Vec3 edge = (p.from - p.apex) + (p.to - p.from) * along;
        box.grow(p.apex + edge * inner);
        box.grow(p.apex + edge * outer);
      }
    }
  }
  // Allow for rounding in point_at(): a few units in the last place of the coordinates.
  const Vec3 magnitude = max(abs(box.lower), abs(box.upper)) + box.extent();
  box.lower = box.lower - magnitude * 1e-6f;
  box.upper = box.upper + magnitude * 1e-6f;
  return box;
}

Box SourceSurface::round_bounds(const SourceCell& c) const {
  Box box;
  if (shape_ == LightKind::disk) {
    // The concentric map stretches by less than 1.5 (Frobenius norm of its derivative) from the
    // square [-1,1]², which is twice the unit square.
    const Vec3 middle = point_at({0.5f * (c.u0 + c.u1), 0.5f * (c.v0 + c.v1)}).point;
    const float reach = 1.5f * radius_ * std::hypot(c.u1 - c.u0, c.v1 - c.v0);
    for (size_t a = 0; a < 3; ++a) {
      // Half extents of a disk along axis a.
      const float flat = std::sqrt(std::max(0.0f, 1 - sqr(frame_.normal[a])));
      box.lower[a] = std::max(middle[a] - reach * flat, centre_[a] - radius_ * flat);
      box.upper[a] = std::min(middle[a] + reach * flat, centre_[a] + radius_ * flat);
    }
    return box;
  }
  // A cell of the sphere lies between two heights and two azimuths. Its extreme points are at its
  // corners, on the equator, and where it crosses the x and y axes.
  const float z0 = 1 - 2 * c.v1, z1 = 1 - 2 * c.v0;
  std::array<float, 3> heights{z0, z1, z0 <= 0 && z1 >= 0 ? 0.0f : z0};
  const auto grow = [&](float azimuth) {
    for (const float z : heights) {
      const float r = std::sqrt(std::max(0.0f, 1 - z * z));
      box.grow(centre_ + Vec3{r * std::cos(azimuth), r * std::sin(azimuth), z} * radius_);
    }
  };
  grow(2 * pi_f * c.u0);
  grow(2 * pi_f * c.u1);
  for (int quarter = 0; quarter <= 4; ++quarter) {
    const float u = 0.25f * float(quarter);
    if (c.u0 <= u && u <= c.u1) grow(2 * pi_f * u);
  }
  return box;
}

}  // namespace troffer
