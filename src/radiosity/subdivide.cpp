#include "radiosity/subdivide.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/frame.h"
#include "base/random.h"
#include "scene/mesh_in_world.h"

namespace troffer {

namespace {

struct PositionHash {
  size_t operator()(const Vec3& p) const {
    return size_t(hash_of(std::bit_cast<uint32_t>(p.x + 0.0f), std::bit_cast<uint32_t>(p.y + 0.0f),
                          std::bit_cast<uint32_t>(p.z + 0.0f)));
  }
};

bool has_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3d n = cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a));
  const double twice_area = length(n);
  if (!std::isfinite(twice_area)) return false;
  const double longest =
      std::max({length_squared(b - a), length_squared(c - b), length_squared(a - c)});
  return float(twice_area) > 0 && twice_area > 1e-9 * longest;
}

bool is_too_far(const Vec3& p, float radius = 0) {
  const Vec3 a = abs(p);
  return !(std::max({a.x, a.y, a.z}) + radius < farthest_surface);
}

void add_mesh(const MeshInWorld& in_world, uint32_t geometry, BaseGeometry& g) {
  const Mesh& mesh = in_world.mesh();
  BaseSurface s;
  s.index = geometry;
  s.material = mesh.material;
  s.first_triangle = uint32_t(g.triangles.size());
  s.triangle_count = uint32_t(mesh.triangles.size());
  std::unordered_map<Vec3, uint32_t, PositionHash> welded;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    BaseTriangle out;
    out.surface = uint32_t(g.surfaces.size());
    out.light = mesh.lights.empty() ? no_light : mesh.lights[t];
    const std::array<Vec3, 3> p = in_world.corners(t);
    const bool is_far = is_too_far(p[0]) || is_too_far(p[1]) || is_too_far(p[2]);
    g.left_out += is_far ? 1 : 0;
    out.is_degenerate = is_far || !has_area(p[0], p[1], p[2]);
    for (size_t k = 0; k < 3 && !out.is_degenerate; ++k) {
      const auto [it, is_new] = welded.try_emplace(p[k], uint32_t(g.positions.size()));
      if (is_new) g.positions.push_back(p[k]);
      out.vertices[k] = it->second;
    }
    g.triangles.push_back(out);
  }
  g.flat.resize(g.positions.size());
  g.surfaces.push_back(s);
}

// Octants 0 to 7 by the signs of x, y, z (bits 0, 1, 2 set if negative); disks have four.
void add_round(const Scene& scene, Bulge bulge, uint32_t index, uint32_t material, int32_t light,
               bool is_inside_out, bool is_far, BaseGeometry& g) {
  g.left_out += is_far ? 1 : 0;
  BaseSurface s;
  s.bulge = bulge;
  s.index = index;
  s.material = material;
  s.first_triangle = uint32_t(g.triangles.size());
  s.triangle_count = bulge == Bulge::sphere ? 8 : 4;
  const auto first = uint32_t(g.positions.size());
  const Vec3 corners[6] = {
      {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, bulge == Bulge::sphere ? 1.0f : 0.0f},
      {0, 0, -1}};
  for (size_t i = 0; i < (bulge == Bulge::sphere ? 6u : 5u); ++i) {
    g.flat.push_back(corners[i]);
    g.positions.push_back(bulged(scene, s, corners[i]));
  }
  for (uint32_t octant = 0; octant < s.triangle_count; ++octant) {
    BaseTriangle t;
    t.surface = uint32_t(g.surfaces.size());
    t.light = light;
    t.is_degenerate = is_far;
    t.vertices = {first + (octant & 1), first + 2 + (octant >> 1 & 1), first + 4 + (octant >> 2)};
    // x, y, z run counterclockwise seen from outside if no or two signs are negative
    const bool is_odd = (std::popcount(octant) & 1) != 0;
    if (is_odd != is_inside_out) std::swap(t.vertices[1], t.vertices[2]);
    g.triangles.push_back(t);
  }
  g.surfaces.push_back(s);
}

}  // namespace

BaseGeometry base_geometry(const Scene& scene) {
  BaseGeometry g;
  for (uint32_t i = 0; i < scene.meshes.size(); ++i) add_mesh(mesh_at(scene, i), i, g);
  for (uint32_t i = 0; i < scene.spheres.size(); ++i) {
    const Sphere& s = scene.spheres[i];
    add_round(scene, Bulge::sphere, i, s.material, s.light, s.is_inside_out,
              is_too_far(s.centre, s.radius), g);
  }
  for (uint32_t i = 0; i < scene.disks.size(); ++i) {
    const Disk& d = scene.disks[i];
    add_round(scene, Bulge::disk, i, d.material, d.light, false, is_too_far(d.centre, d.radius), g);
  }
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const uint32_t geometry = first_instance(scene) + i;
    add_mesh(mesh_at(scene, geometry), geometry, g);
  }
  return g;
}

Vec3 bulged(const Scene& scene, const BaseSurface& surface, const Vec3& flat) {
  const float l = length(flat), manhattan = std::abs(flat.x) + std::abs(flat.y) + std::abs(flat.z);
  if (surface.bulge == Bulge::sphere) {
    const Sphere& s = scene.spheres[surface.index];
    return s.centre + flat * (s.radius / l);
  }
  const Disk& d = scene.disks[surface.index];
  const Frame frame(d.normal);
  const Vec3 p = l > 0 ? flat * (d.radius * manhattan / l) : Vec3{};
  return d.centre + frame.tangent * p.x + frame.bitangent * p.y;
}

uint32_t flat_triangle(const Scene& scene, const BaseSurface& surface, const Vec3& position,
                       Vec3& weights) {
  Vec3 p;
  bool is_inside_out = false;
  if (surface.bulge == Bulge::sphere) {
    const Sphere& s = scene.spheres[surface.index];
    p = position - s.centre;
    is_inside_out = s.is_inside_out;
    const float manhattan = std::abs(p.x) + std::abs(p.y) + std::abs(p.z);
    weights = manhattan > 0 ? abs(p) / manhattan : Vec3{1, 0, 0};
  } else {
    const Disk& d = scene.disks[surface.index];
    p = Frame(d.normal).to_local(position - d.centre);
    p.z = 0;
    const float l = length(p) / d.radius, manhattan = std::abs(p.x) + std::abs(p.y);
    const float scale = manhattan > 0 ? std::min(l, 1.0f) / manhattan : 0.0f;
    weights = abs(p) * scale;
    weights.z = std::max(0.0f, 1 - weights.x - weights.y);
  }
  const uint32_t octant = (p.x < 0 ? 1u : 0u) | (p.y < 0 ? 2u : 0u) | (p.z < 0 ? 4u : 0u);
  if (((std::popcount(octant) & 1) != 0) != is_inside_out) std::swap(weights.y, weights.z);
  return surface.first_triangle + octant;
}

float Subdivider::longest_edge(const std::array<uint32_t, 3>& t, uint8_t& edge) const {
  const auto& p = geometry_.positions;
  const LongestEdge longest = troffer::longest_edge(std::array{p[t[0]], p[t[1]], p[t[2]]});
  edge = uint8_t(longest.number);
  return std::sqrt(longest.square);
}

uint32_t Subdivider::midpoint(uint32_t surface, uint32_t a, uint32_t b) {
  const uint64_t key = uint64_t(std::min(a, b)) << 32 | std::max(a, b);
  const auto [it, is_new] = midpoints_.try_emplace(key, uint32_t(geometry_.positions.size()));
  if (is_new) {
    const BaseSurface& s = geometry_.surfaces[surface];
    const Vec3 flat = (geometry_.flat[a] + geometry_.flat[b]) * 0.5f;
    const Vec3 pa = geometry_.positions[a], pb = geometry_.positions[b];
    geometry_.flat.push_back(flat);
    geometry_.positions.push_back(s.bulge == Bulge::none ? pa * 0.5f + pb * 0.5f
                                                         : bulged(scene_, s, flat));
  }
  return it->second;
}

std::array<std::array<uint32_t, 3>, 2> Subdivider::split(uint32_t surface,
                                                         const std::array<uint32_t, 3>& t,
                                                         uint8_t edge) {
  const uint32_t a = t[edge], b = t[(edge + 1u) % 3];
  const uint32_t m = midpoint(surface, a, b);
  std::array<std::array<uint32_t, 3>, 2> halves{t, t};
  halves[0][(edge + 1u) % 3] = m;
  halves[1][edge] = m;
  return halves;
}

namespace {

size_t count_parts(const std::array<Vec3, 3>& p, float size2, size_t limit) {
  struct Part {
    std::array<Vec3, 3> p;
    int depth;
  };
  std::vector<Part> stack{{p, 0}};
  size_t count = 0;
  while (!stack.empty() && count < limit) {
    const Part part = stack.back();
    stack.pop_back();
    const auto [edge, longest] = longest_edge(part.p);
    if (!(longest > size2) || part.depth >= 40) {
      ++count;
      continue;
    }
    const Vec3 m = part.p[edge] * 0.5f + part.p[(edge + 1) % 3] * 0.5f;
    Part a = part, b = part;
    a.p[(edge + 1) % 3] = b.p[edge] = m;
    ++a.depth;
    ++b.depth;
    stack.push_back(a);
    stack.push_back(b);
  }
  return count;
}

}  // namespace

LongestEdge longest_edge(std::span<const Vec3, 3> triangle) {
  LongestEdge longest;
  for (size_t k = 0; k < 3; ++k) {
    const float square = length_squared(triangle[(k + 1) % 3] - triangle[k]);
    if (square > longest.square) longest = {k, square};
  }
  return longest;
}

size_t count_fragments(const BaseGeometry& geometry, uint32_t triangle, double size, size_t limit) {
  const BaseTriangle& t = geometry.triangles[triangle];
  return count_parts({geometry.positions[t.vertices[0]], geometry.positions[t.vertices[1]],
                      geometry.positions[t.vertices[2]]},
                     float(size * size), limit);
}

}  // namespace troffer
