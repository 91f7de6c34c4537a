#include "light/irradiance.h"

#include <array>
#include <cmath>

#include "base/gauss_legendre.h"
#include "base/units.h"
#include "light/arctangent.h"

namespace troffer {

namespace {

// One edge's term of Lambert's sum: n·(v × w) / |v × w| times the angle between v and w. The cross
// product uses the edge w - v, so that it stays accurate if v and w are nearly parallel.
double edge_share(const Vec3d& v, const Vec3d& w, const Vec3d& n) {
  const Vec3d c = cross(v, w - v);
  const double sine = length(c);
  if (!(sine > 0)) return 0;
  return dot(n, c) / sine * upper_angle(sine, dot(v, w));
}

// Lambert's sum over the vertices relative to the receiver, clipped at the horizon. Edges below the
// horizon are dropped, and one edge along it closes the rest.
template <class Vertex>
double lambert_sum(size_t count, const Vertex& vertex, const Vec3d& n) {
  double sum = 0;
  Vec3d v = vertex(count - 1), leaving, entering;
  double height_v = dot(n, v);
  bool is_clipped = false;
  for (size_t i = 0; i < count; ++i) {
    const Vec3d w = vertex(i);
    const double height_w = dot(n, w);
    if (height_v > 0 && height_w > 0) {
      sum += edge_share(v, w, n);
    } else if (height_v > 0 || height_w > 0) {
      is_clipped = true;
      const Vec3d crossing = v + (w - v) * (height_v / (height_v - height_w));
      if (height_v > 0) {
        leaving = crossing;
        sum += edge_share(v, crossing, n);
      } else {
        entering = crossing;
        sum += edge_share(crossing, w, n);
      }
    }
    v = w;
    height_v = height_w;
  }
  if (is_clipped) sum += edge_share(leaving, entering, n);
  return sum;
}

// From the front the vertices run counterclockwise, which makes Lambert's sum negative.
double irradiance_from_sum(double sum, bool is_front) {
  return std::clamp(is_front ? -0.5 * sum : 0.5 * sum, 0.0, pi);
}

}  // namespace

double polygon_irradiance(std::span<const Vec3d> vertices, const Vec3d& x, const Vec3d& n,
                          Sides sides) {
  if (vertices.size() < 3) return 0;
  Vec3d vector;
  for (size_t i = 1; i + 1 < vertices.size(); ++i)
    vector += cross(vertices[i] - vertices[0], vertices[i + 1] - vertices[0]);
  const double height = dot(vector, x - vertices[0]);
  if (!(height > 0 || (sides == Sides::both && height < 0))) return 0;
  const auto vertex = [&](size_t i) { return vertices[i] - x; };
  return irradiance_from_sum(lambert_sum(vertices.size(), vertex, n), height > 0);
}

double irradiance(const LightPrimitive& p, const Vec3d& x, const Vec3d& n) {
  const Sides sides = p.is_two_sided ? Sides::both : Sides::front;
  const Vec3d centre(p.centroid);
  if (p.shape == PrimitiveShape::sphere)
    return sphere_irradiance(centre, double(p.radius), x, n, sides, p.is_inside_out);
  if (p.shape == PrimitiveShape::disk)
    return disk_irradiance(centre, p.normal, double(p.radius), x, n, sides);
  const double height = dot(p.normal, x - Vec3d(p.vertex(0)));
  if (!(height > 0 || (sides == Sides::both && height < 0))) return 0;
  const auto vertex = [&](size_t i) { return Vec3d(p.vertex(uint32_t(i))) - x; };
  return irradiance_from_sum(lambert_sum(p.vertex_count, vertex, n), height > 0);
}

double irradiance(const LightPrimitives& primitives, uint32_t light, const Vec3d& x,
                  const Vec3d& n) {
  const LightPrimitives::Range range = primitives.of_light(light);
  double sum = 0;
  for (uint32_t i = range.first; i < range.last; ++i) sum += irradiance(primitives[i], x, n);
  return sum;
}

namespace {

// 3 × 3 Gauss–Legendre quadrature over a cell that is small relative to its distance and entirely
// above the horizon. At a distance of 12 half diagonals, the relative error is below 1e-6.
//   corner, gu, gv: the cell's first corner from x, and its sides;
//   n0, nu, nv: their dot products with the normal, which cancel low over the horizon;
//   area_and_height: the cell's area times the height of x over its plane.
float quadrature_irradiance(const Vec3& corner, const Vec3& gu, const Vec3& gv, float n0, float nu,
                            float nv, float area_and_height) {
  const float q0 = dot(corner, corner), qu = 2 * dot(corner, gu), qv = 2 * dot(corner, gv);
  const float uu = dot(gu, gu), uv = 2 * dot(gu, gv), vv = dot(gv, gv);
  float sum = 0;
  for (size_t i = 0; i < 3; ++i) {
    const float a = gauss_nodes<float>[i];
    for (size_t j = 0; j < 3; ++j) {
      const float b = gauss_nodes<float>[j];
      const float cosine = n0 + a * nu + b * nv;  // cosine times distance
      const float square = q0 + a * (qu + a * uu + b * uv) + b * (qv + b * vv);
      sum += gauss_weights<float>[i] * gauss_weights<float>[j] * cosine / (square * square);
    }
  }
  return sum * area_and_height;
}

}  // namespace

float cell_irradiance(const Parallelogram& source, const SourceCell& cell, const Vec3& x,
                      const Vec3& n, Sides sides) {
  const double height = dot(source.normal, Vec3d(x) - source.origin);
  if (!(height > 0 || (sides == Sides::both && height < 0))) return 0;
  const Vec3d gu = source.u * (double(cell.u1) - double(cell.u0));
  const Vec3d gv = source.v * (double(cell.v1) - double(cell.v0));
  const Vec3d p0 =
      source.origin + source.u * double(cell.u0) + source.v * double(cell.v0) - Vec3d(x);
  const std::array<Vec3d, 4> corners{p0, p0 + gu, p0 + gu + gv, p0 + gv};
  const Vec3d normal(n);
  double lowest = dot(normal, corners[0]), highest = lowest;
  for (size_t i = 1; i < 4; ++i) {
    const double h = dot(normal, corners[i]);
    lowest = std::min(lowest, h);
    highest = std::max(highest, h);
  }
  if (highest <= 0) return 0;
  const Vec3d middle = p0 + (gu + gv) * 0.5;
  const double half_diagonal2 = 0.25 * std::max(length_squared(gu + gv), length_squared(gu - gv));
  if (lowest >= 0 && length_squared(middle) > 144 * half_diagonal2)
    return quadrature_irradiance(Vec3(p0), Vec3(gu), Vec3(gv), float(dot(normal, p0)),
                                 float(dot(normal, gu)), float(dot(normal, gv)),
                                 float(std::abs(height) * length(cross(gu, gv))));
  const auto vertex = [&](size_t i) { return corners[i]; };
  return float(irradiance_from_sum(lambert_sum(4, vertex, normal), height > 0));
}

}  // namespace troffer
