#include "radiosity/shooter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random.h"
#include "base/warp.h"
#include "light/polygon.h"

namespace troffer {

namespace {

constexpr size_t most_parts = 256;  // limit, because the parts are searched linearly
constexpr uint32_t purpose_shares = 1;

void finish(Shooter& s) {
  double sum = 0;
  for (const LightPrimitive& p : s.pieces) s.area_sums.push_back(sum += double(p.area));
  s.is_exact = s.pieces.size() <= max_exact_pieces;
}

float largest_coordinate(const Box& b) {
  const Vec3 a = max(abs(b.lower), abs(b.upper));
  return std::max({a.x, a.y, a.z});
}

void add_polygon(Shooter& s, const Vec3* corners, uint32_t count, Rgb radiance) {
  const Vec3d vector = area_vector({corners, count});
  LightPrimitive p;
  p.shape = count == 3 ? PrimitiveShape::triangle : PrimitiveShape::polygon;
  p.vertex_count = count;
  p.area = float(length(vector));
  if (!(p.area > 0)) return;
  p.normal = vector / length(vector);
  p.centroid = Vec3(centroid({corners, count}, p.normal));
  if (count <= 4)
    std::copy(corners, corners + count, p.vertices);
  else
    p.more_vertices = corners;  // points into the mesh
  for (uint32_t k = 0; k < count; ++k) {
    p.bounds.grow(corners[k]);
    p.radius = std::max(p.radius, length(corners[k] - p.centroid));
  }
  p.mean_radiance = radiance;
  s.pieces.push_back(p);
}

// Returns the mean share over the shooter's area. It normalises the shares: the nearest part is not
// always the part that a point belongs to, and the patch must not send more than it has.
double mean_share(const Shooter& s) {
  double sum = 0;
  for (const LightPrimitive& p : s.pieces) {
    const double part = double(p.area) / s.area_sums.back();
    const auto count = uint32_t(std::clamp(std::ceil(64 * part), 4.0, 64.0));
    double piece = 0;
    for (uint32_t k = 0; k < count; ++k)
      piece += double(share_at(s, point_on(p, SobolGroup(0, purpose_shares, k).get2())));
    sum += part * piece / count;
  }
  return sum;
}

}  // namespace

Vec3 point_on(const LightPrimitive& p, const Vec2& u) {
  if (p.shape == PrimitiveShape::sphere) return p.centroid + sphere_from_square(u) * p.radius;
  if (p.shape == PrimitiveShape::disk) {
    const Vec2 d = disk_from_square(u) * p.radius;
    return p.centroid + p.axis_x * d.x + Vec3(cross(p.normal, Vec3d(p.axis_x))) * d.y;
  }
  if (p.shape == PrimitiveShape::rectangle)
    return p.centroid + p.axis_x * ((u.x - 0.5f) * p.size_x) + p.axis_y * ((u.y - 0.5f) * p.size_y);
  if (p.vertex_count == 3) {
    const Vec2 w = triangle_from_square(u);
    return p.vertex(0) + (p.vertex(1) - p.vertex(0)) * w.x + (p.vertex(2) - p.vertex(0)) * w.y;
  }
  // fan about vertex 0; pieces have few vertices, so a linear scan suffices
  float x = u.x * p.area;
  for (uint32_t i = 1; i + 1 < p.vertex_count; ++i) {
    const Vec3 a = p.vertex(0), b = p.vertex(i), c = p.vertex(i + 1);
    const float area = 0.5f * length(cross(b - a, c - a));
    if (x < area || i + 2 == p.vertex_count) {
      const Vec2 w = triangle_from_square(Vec2{std::clamp(x / area, 0.0f, one_minus_epsilon), u.y});
      return a + (b - a) * w.x + (c - a) * w.y;
    }
    x -= area;
  }
  return p.centroid;
}

size_t nearest_part(std::span<const ElementPoint> parts, const Vec3& point) {
  size_t part = 0;
  float nearest = std::numeric_limits<float>::infinity();
  for (size_t i = 0; i < parts.size(); ++i) {
    const float d = length_squared(parts[i].position - point);
    if (d >= nearest) continue;
    nearest = d;
    part = i;
  }
  return part;
}

float share_at(const Shooter& s, const Vec3& point) {
  return s.parts.empty() ? 1.0f : s.share[nearest_part(s.parts, point)];
}

Shooter light_shooter(const LightPrimitives& primitives, uint32_t light) {
  Shooter s;
  const LightPrimitives::Range range = primitives.of_light(light);
  for (uint32_t i = range.first; i < range.last; ++i) {
    if (!primitives[i].has_surface()) continue;
    s.pieces.push_back(primitives[i]);
    s.offset = std::max(s.offset, 1.6e-5f * largest_coordinate(primitives[i].bounds));
  }
  finish(s);
  return s;
}

Shooter patch_shooter(const RadiosityMesh& mesh, uint32_t patch, Rgb radiance) {
  Shooter s;
  const Patch& from = mesh.patches[patch];
  const Sheet& sheet = mesh.sheets[from.sheet];
  for (uint32_t i = sheet.first_piece; i < sheet.last_piece; ++i) {
    const auto [first, count] = mesh.pieces[i];
    const Vec3* c = mesh.piece_corners.data() + first;
    if (!from.is_back) {
      add_polygon(s, c, count, radiance);
    } else if (count <= 4) {
      const Vec3 reversed[4] = {c[count - 1], c[count - 2], c[count - 3], c[0]};
      add_polygon(s, reversed, count, radiance);
    } else {  // there is no storage for reversed corners: use a fan
      for (uint32_t k = 1; k + 1 < count; ++k) {
        const Vec3 triangle[3] = {c[0], c[k + 1], c[k]};
        add_polygon(s, triangle, 3, radiance);
      }
    }
  }
  s.round_centre = sheet.round_centre;
  s.round_radius = sheet.round_radius;
  s.offset = sheet.offset;
  finish(s);
  return s;
}

void set_parts(Shooter& shooter, const RadiosityMesh& mesh, uint32_t patch,
               std::span<const float> luminances) {
  // relative deviation from the mean below which a patch counts as uniform
  constexpr double unequal = 0.02;
  const Patch& p = mesh.patches[patch];
  const std::span<const ElementPoint> parts(mesh.points.data() + p.first_point, luminances.size());
  double sum = 0, area = 0;
  for (size_t i = 0; i < parts.size(); ++i) {
    sum += double(luminances[i]) * double(parts[i].area);
    area += double(parts[i].area);
  }
  if (!shooter.is_exact || parts.size() > most_parts || !(sum > 0)) return;
  const double mean = sum / area;
  bool is_equal = true;
  for (const float l : luminances)
    is_equal = is_equal && std::abs(double(l) - mean) < unequal * mean;
  if (is_equal) return;
  shooter.parts = parts;
  for (const float l : luminances) shooter.share.push_back(float(double(l) / mean));
  const double scale = mean_share(shooter);
  if (!(scale > 0)) shooter.share.clear();
  if (shooter.share.empty()) shooter.parts = {};
  for (float& share : shooter.share) share = float(double(share) / scale);
}

}  // namespace troffer
