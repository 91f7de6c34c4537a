#include "import/subdivide_loop.h"

#include <algorithm>
#include <unordered_map>

#include "import/mesh_clean.h"

namespace troffer {

namespace {

// A mesh in double precision: rounding over several levels would be visible in the normals.
struct Shape {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;
};

struct LoopEdge {
  uint32_t a = 0, b = 0;
  std::array<uint32_t, 2> opposite{};  // third corners of the first two triangles
  uint32_t triangles = 0;

  bool is_inside() const { return triangles == 2; }
};

struct Ring {
  Vec3d sum, boundary_sum;  // sums over all neighbours, and over those along boundaries
  uint32_t neighbours = 0, boundary = 0;
};

uint64_t key_of(uint32_t a, uint32_t b) {
  return (uint64_t(std::min(a, b)) << 32) | std::max(a, b);
}

// Edges in order of first occurrence, with an index by their ends.
struct Edges {
  std::vector<LoopEdge> all;
  std::unordered_map<uint64_t, uint32_t> index;

  explicit Edges(const Shape& shape) {
    index.reserve(shape.triangles.size() * 2);
    for (const Triangle& t : shape.triangles)
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t a = t[k], b = t[(k + 1) % 3];
        const auto [at, is_new] = index.try_emplace(key_of(a, b), uint32_t(all.size()));
        if (is_new) all.push_back({a, b, {}, 0});
        LoopEdge& e = all[at->second];
        if (e.triangles < 2) e.opposite[e.triangles] = t[(k + 2) % 3];
        ++e.triangles;
      }
  }
};

std::vector<Ring> rings_of(const Shape& shape, const Edges& edges) {
  std::vector<Ring> rings(shape.positions.size());
  const auto add = [&](uint32_t to, uint32_t from, bool is_boundary) {
    Ring& r = rings[to];
    r.sum += shape.positions[from];
    ++r.neighbours;
    if (!is_boundary) return;
    r.boundary_sum += shape.positions[from];
    ++r.boundary;
  };
  for (const LoopEdge& e : edges.all) {
    add(e.a, e.b, !e.is_inside());
    add(e.b, e.a, !e.is_inside());
  }
  return rings;
}

// Returns Warren's weight of one neighbour.
double neighbour_weight(uint32_t neighbours) {
  return neighbours == 3 ? 3.0 / 16 : 3.0 / (8.0 * neighbours);
}

Vec3d moved(const Vec3d& p, const Ring& r, double inside_weight, double boundary_weight) {
  if (r.neighbours == 0) return p;
  if (r.boundary == 0) return p * (1 - r.neighbours * inside_weight) + r.sum * inside_weight;
  if (r.boundary != 2) return p;
  return p * (1 - 2 * boundary_weight) + r.boundary_sum * boundary_weight;
}

Shape subdivided(const Shape& coarse) {
  const Edges edges(coarse);
  const std::vector<Ring> rings = rings_of(coarse, edges);
  Shape fine;
  const auto n = uint32_t(coarse.positions.size());
  fine.positions.reserve(n + edges.all.size());
  for (uint32_t i = 0; i < n; ++i)
    fine.positions.push_back(
        moved(coarse.positions[i], rings[i], neighbour_weight(rings[i].neighbours), 1.0 / 8));
  for (const LoopEdge& e : edges.all) {
    const Vec3d ends = coarse.positions[e.a] + coarse.positions[e.b];
    fine.positions.push_back(e.is_inside() ? ends * 0.375 + (coarse.positions[e.opposite[0]] +
                                                             coarse.positions[e.opposite[1]]) *
                                                                0.125
                                           : ends * 0.5);
  }
  fine.triangles.reserve(coarse.triangles.size() * 4);
  for (const Triangle& t : coarse.triangles) {
    std::array<uint32_t, 3> middle{};
    for (size_t k = 0; k < 3; ++k) middle[k] = n + edges.index.at(key_of(t[k], t[(k + 1) % 3]));
    for (size_t k = 0; k < 3; ++k) fine.triangles.push_back({t[k], middle[k], middle[(k + 2) % 3]});
    fine.triangles.push_back({middle[0], middle[1], middle[2]});
  }
  return fine;
}

// Moves vertices to their limit positions.
void push_to_limit(Shape& shape) {
  const std::vector<Ring> rings = rings_of(shape, Edges(shape));
  const std::vector<Vec3d> before = shape.positions;
  for (size_t i = 0; i < before.size(); ++i) {
    const uint32_t n = rings[i].neighbours;
    const double limit = n == 0 ? 0 : 1 / (n + 3 / (8 * neighbour_weight(n)));
    shape.positions[i] = moved(before[i], rings[i], limit, 1.0 / 6);
  }
}

}  // namespace

Mesh subdivide_loop(const Mesh& control, int levels) {
  Shape shape;
  for (const Vec3& p : control.positions) shape.positions.emplace_back(p);
  // A triangle that repeats a corner has an edge of length zero, for which no rule exists.
  for (const Triangle& t : control.triangles)
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) shape.triangles.push_back(t);
  for (int i = 0; i < levels; ++i) shape = subdivided(shape);
  push_to_limit(shape);
  Mesh mesh;
  for (const Vec3d& p : shape.positions) mesh.positions.emplace_back(p);
  mesh.triangles = std::move(shape.triangles);
  std::vector<Vec3d> normals(mesh.positions.size());
  for (const Triangle& t : mesh.triangles)
    for (const uint32_t v : t) normals[v] += area_vector(mesh, t);
  for (const Vec3d& n : normals) {
    const double size = length(n);
    mesh.normals.push_back(size > 0 ? Vec3(n / size) : Vec3{0, 0, 1});
  }
  return mesh;
}

}  // namespace troffer
