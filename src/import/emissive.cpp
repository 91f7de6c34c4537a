#include "import/emissive.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>

#include "base/disjoint_sets.h"
#include "base/units.h"

namespace troffer {

namespace {

// Limits per mesh and per polygon. Beyond them triangles stay in the mesh light, because the exact
// irradiance of a polygon costs more than sampling.
constexpr size_t max_polygons = 1000;
constexpr size_t max_corners = 64;

constexpr double straightness = 1e-5;  // distance of a corner from its neighbours' line, relative
                                       // to the component's size
constexpr double area_agreement = 1e-3;  // relative difference between outline and triangles
constexpr double float_rounding = 4e-7;  // relative rounding of a coordinate in single precision;
                                         // at most plane_rounding() of light/polygon.h

using Triangles = std::vector<uint32_t>;  // indices into Mesh::triangles, ascending

// Returns the first vertex at the same position, for each vertex.
std::vector<uint32_t> weld(const Mesh& mesh) {
  const auto key = [&](uint32_t v) {
    const Vec3& p = mesh.positions[v];
    return std::tuple(p.x + 0.0f, p.y + 0.0f, p.z + 0.0f);  // -0 becomes 0
  };
  std::vector<uint32_t> order;
  std::vector<bool> is_used(mesh.positions.size(), false);
  for (const Triangle& t : mesh.triangles)
    for (const uint32_t v : t) {
      if (!is_used[v] && is_finite(mesh.positions[v])) order.push_back(v);
      is_used[v] = true;
    }
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return std::pair(key(a), a) < std::pair(key(b), b); });
  std::vector<uint32_t> welded(mesh.positions.size());
  std::iota(welded.begin(), welded.end(), 0u);
  for (size_t i = 1; i < order.size(); ++i)
    if (key(order[i]) == key(order[i - 1])) welded[order[i]] = welded[order[i - 1]];
  return welded;
}

// A directed edge of a triangle between welded vertices.
struct Edge {
  uint32_t from, to, triangle;
  std::pair<uint32_t, uint32_t> undirected() const { return std::minmax(from, to); }
};

Vec3d position(const Mesh& mesh, uint32_t v) {
  return Vec3d(mesh.positions[v]);
}

// Returns half the cross product of two sides: the area times the front normal.
Vec3d vector_area(const Mesh& mesh, uint32_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  const Vec3d a = position(mesh, t[0]);
  return cross(position(mesh, t[1]) - a, position(mesh, t[2]) - a) * 0.5;
}

// Triangles that are connected by edges. The edges are sorted so that both sides of an edge are
// adjacent. components_of() orders components by their first triangles.
struct Component {
  Triangles triangles;
  std::vector<Edge> edges;
};

std::vector<Component> components_of(const Mesh& mesh, const Triangles& triangles) {
  const std::vector<uint32_t> welded = weld(mesh);
  std::vector<Edge> edges;
  edges.reserve(triangles.size() * 3);
  for (const uint32_t t : triangles)
    for (size_t k = 0; k < 3; ++k)
      edges.push_back({welded[mesh.triangles[t][k]], welded[mesh.triangles[t][(k + 1) % 3]], t});
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tuple(a.undirected(), a.triangle) < std::tuple(b.undirected(), b.triangle);
  });
  DisjointSets sets(mesh.triangles.size());
  for (size_t i = 1; i < edges.size(); ++i)
    if (edges[i].undirected() == edges[i - 1].undirected())
      sets.join(edges[i].triangle, edges[i - 1].triangle);

  std::vector<uint32_t> number(mesh.triangles.size(), 0);
  std::vector<Component> components;
  for (const uint32_t t : triangles) {
    const uint32_t root = sets.find(t);
    if (root == t) {
      number[t] = uint32_t(components.size());
      components.emplace_back();
    }
    components[number[root]].triangles.push_back(t);
  }
  for (const Edge& e : edges) components[number[sets.find(e.triangle)]].edges.push_back(e);
  return components;
}

// Returns the corners of the boundary, in the winding of the triangles. Returns nothing unless the
// boundary is one simple loop, and every edge is shared by at most two triangles of the same
// orientation.
std::optional<std::vector<uint32_t>> boundary_loop(const std::vector<Edge>& edges) {
  std::map<uint32_t, uint32_t> next;
  for (size_t i = 0; i < edges.size();) {
    size_t end = i + 1;
    while (end < edges.size() && edges[end].undirected() == edges[i].undirected()) ++end;
    if (end - i == 1) {
      if (!next.emplace(edges[i].from, edges[i].to).second) return std::nullopt;
    } else if (end - i > 2 || edges[i].from != edges[i + 1].to) {
      return std::nullopt;
    }
    i = end;
  }
  if (next.empty()) return std::nullopt;
  std::vector<uint32_t> loop;
  uint32_t at = next.begin()->first;
  do {
    loop.push_back(at);
    const auto it = next.find(at);
    if (it == next.end()) return std::nullopt;
    at = it->second;
  } while (at != loop.front() && loop.size() <= next.size());
  if (loop.size() != next.size() || at != loop.front()) return std::nullopt;
  return loop;
}

// Plane of a component: every corner lies in it but for rounding, and every triangle faces along
// `normal`. A triangle that stood out farther would hide the polygon from shadow rays, which end
// just before the polygon's plane.
struct Plane {
  Vec3d normal;  // unit
  double size = 0, area = 0;
  double rounding = 0;  // rounding of positions, in the scene's units
};

std::optional<Plane> plane_of(const Mesh& mesh, const Triangles& triangles) {
  Plane plane;
  Boxd box;
  Vec3d sum;
  for (const uint32_t t : triangles) {
    const Vec3d area = vector_area(mesh, t);
    sum += area;
    plane.area += length(area);
    for (const uint32_t v : mesh.triangles[t]) box.grow(position(mesh, v));
  }
  if (!(length(sum) > 0)) return std::nullopt;
  plane.normal = normalize(sum);
  plane.size = box.diagonal();
  const Vec3d far = max(abs(box.lower), abs(box.upper));
  plane.rounding = float_rounding * std::max({far.x, far.y, far.z});
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (const uint32_t t : triangles) {
    if (!(dot(vector_area(mesh, t), plane.normal) > 0)) return std::nullopt;
    for (const uint32_t v : mesh.triangles[t]) {
      const double height = dot(position(mesh, v), plane.normal);
      lowest = std::min(lowest, height);
      highest = std::max(highest, height);
    }
  }
  if (highest - lowest > plane.rounding) return std::nullopt;
  return plane;
}

// True if every corner turns left and the turns add up to one full circle. The loop is then convex
// and does not cross itself.
bool goes_round_once(const std::vector<Vec3d>& loop, const Vec3d& normal) {
  const size_t n = loop.size();
  double angle = 0;
  for (size_t i = 0; i < n; ++i) {
    const Vec3d in = loop[(i + 1) % n] - loop[i], out = loop[(i + 2) % n] - loop[(i + 1) % n];
    const double sine = dot(cross(in, out), normal);
    if (!(sine > 0)) return false;
    angle += std::atan2(sine, dot(in, out));
  }
  return n >= 3 && angle < 3 * pi;
}

// Returns the corners without those on a straight line between their neighbours, or nothing if a
// corner turns inwards. A single pass with a look back removes whole runs of collinear corners.
std::optional<std::vector<Vec3d>> convex_outline(const std::vector<Vec3d>& loop,
                                                 const Plane& plane) {
  const double tolerance = straightness * plane.size + plane.rounding;
  // Distance of b from the line a c; positive where the loop turns left.
  const auto turn = [&](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const double base = length(c - a);
    const double twice_area = dot(cross(b - a, c - b), plane.normal);
    return base > 0 ? twice_area / base : 0;
  };
  // Start at a certain corner: the one farthest from the first.
  size_t start = 0;
  for (size_t i = 0; i < loop.size(); ++i)
    if (length_squared(loop[i] - loop[0]) > length_squared(loop[start] - loop[0])) start = i;

  std::vector<Vec3d> kept{loop[start]};
  for (size_t i = 1; i <= loop.size(); ++i) {
    const Vec3d& next = loop[(start + i) % loop.size()];
    while (kept.size() >= 2 &&
           std::abs(turn(kept[kept.size() - 2], kept.back(), next)) <= tolerance)
      kept.pop_back();
    kept.push_back(next);
  }
  kept.pop_back();  // the start again
  return goes_round_once(kept, plane.normal) ? std::optional(kept) : std::nullopt;
}

double polygon_area(const std::vector<Vec3d>& corners, const Vec3d& normal) {
  Vec3d sum;
  for (size_t i = 2; i < corners.size(); ++i)
    sum += cross(corners[i - 1] - corners[0], corners[i] - corners[0]) * 0.5;
  return dot(sum, normal);
}

// Returns the outline of a component that is one planar convex polygon, counterclockwise seen from
// the front; else nothing. Overlapping triangles fail the comparison of areas.
std::vector<Vec3> polygon_of(const Mesh& mesh, const Component& component) {
  const auto plane = plane_of(mesh, component.triangles);
  if (!plane) return {};
  const auto loop = boundary_loop(component.edges);
  if (!loop) return {};
  std::vector<Vec3d> corners;
  for (const uint32_t v : *loop) corners.push_back(position(mesh, v));
  const auto outline = convex_outline(corners, *plane);
  if (!outline || outline->size() > max_corners) return {};
  const double area = polygon_area(*outline, plane->normal);
  if (std::abs(area - plane->area) > area_agreement * plane->area) return {};
  std::vector<Vec3> polygon;
  for (const Vec3d& p : *outline) polygon.push_back(Vec3(p));
  return polygon;
}

// Multiplies a constant texture into the radiance.
void fold_constant_texture(const Scene& scene, EmissionSpec& spec) {
  if (spec.texture < 0) return;
  const Texture& texture = scene.textures[size_t(spec.texture)];
  if (texture.kind != TextureKind::constant) return;
  spec.radiance *= texture.value;
  spec.texture = no_texture;
}

bool is_alpha_masked(const Scene& scene, const Mesh& mesh) {
  return mesh.material < scene.materials.size() && scene.materials[mesh.material].is_alpha_masked;
}

void add_light(Scene& scene, uint32_t mesh, const EmissionSpec& spec, Triangles triangles,
               std::vector<Vec3> polygon) {
  Light e;
  e.name = spec.name;
  e.kind = polygon.empty() ? LightKind::mesh : LightKind::polygon;
  e.radiance = spec.radiance;
  e.texture = spec.texture;
  e.is_two_sided = spec.is_two_sided;
  e.is_alpha_masked = is_alpha_masked(scene, scene.meshes[mesh]);
  e.geometry = mesh;
  for (const uint32_t t : triangles) scene.meshes[mesh].lights[t] = int32_t(scene.lights.size());
  e.triangles = std::move(triangles);
  e.polygon = std::move(polygon);
  scene.lights.push_back(std::move(e));
}

}  // namespace

void add_mesh_lights(Scene& scene, uint32_t mesh_index, const EmissionSpec& given) {
  EmissionSpec spec = given;
  fold_constant_texture(scene, spec);
  if (spec.radiance.is_black()) return;
  const Mesh& mesh = scene.meshes[mesh_index];
  Triangles with_area;
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
    if (length(vector_area(mesh, t)) > 0) with_area.push_back(t);
  if (with_area.empty()) {
    scene.warnings.add("the light '" + spec.name + "' has no area and is left out");
    return;
  }
  scene.meshes[mesh_index].lights.assign(mesh.triangles.size(), no_light);

  Triangles rest;
  if (spec.texture == no_texture && !is_alpha_masked(scene, mesh)) {
    size_t polygons = 0;
    for (Component& component : components_of(mesh, with_area)) {
      std::vector<Vec3> polygon;
      if (polygons < max_polygons) polygon = polygon_of(mesh, component);
      if (polygon.empty()) {
        rest.insert(rest.end(), component.triangles.begin(), component.triangles.end());
      } else {
        ++polygons;
        add_light(scene, mesh_index, spec, std::move(component.triangles), std::move(polygon));
      }
    }
    std::sort(rest.begin(), rest.end());
  } else {
    rest = std::move(with_area);
  }
  if (!rest.empty()) add_light(scene, mesh_index, spec, std::move(rest), {});
}

}  // namespace troffer
