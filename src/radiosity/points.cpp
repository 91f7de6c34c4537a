// Makes sample points with their reflectances, and finds the sides that light can reach
// (meshing.h).
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/disjoint_sets.h"
#include "base/frame.h"
#include "base/parallel.h"
#include "base/random.h"
#include "bsdf/bsdf.h"
#include "radiosity/elements.h"
#include "radiosity/meshing_parts.h"
#include "scene/mesh_in_world.h"
#include "trace/surface.h"

namespace troffer {

namespace {

constexpr int reach_rays = 8, reach_rays_of_lights = 64;
constexpr uint32_t purpose_reach = 0;

TexturePlace uv_at(const Scene& scene, const RadiosityMesh& mesh, uint32_t triangle,
                   uint32_t fragment, const Vec3& weights) {
  const BaseTriangle& t = mesh.geometry.triangles[triangle];
  const BaseSurface& s = mesh.geometry.surfaces[t.surface];
  if (s.bulge != Bulge::none) return {};
  const MeshInWorld in_world = mesh_at(scene, s.index);
  const Mesh& m = in_world.mesh();
  if (m.uvs.empty()) return {};
  // weights in the fragment to weights in its triangle, by areas
  const auto& v = mesh.fragments[fragment].vertices;
  const std::vector<Vec3>& p = mesh.geometry.positions;
  const Vec3d at = Vec3d(p[v[0]]) * double(weights.x) + Vec3d(p[v[1]]) * double(weights.y) +
                   Vec3d(p[v[2]]) * double(weights.z);
  const Vec3d a(p[t.vertices[0]]), ab = Vec3d(p[t.vertices[1]]) - a,
                                   ac = Vec3d(p[t.vertices[2]]) - a, n = cross(ab, ac);
  const double nn = dot(n, n);
  const auto w1 = float(dot(cross(at - a, ac), n) / nn), w2 = float(dot(cross(ab, at - a), n) / nn);
  const Triangle c = in_world.triangle(triangle - s.first_triangle);
  const auto between = [&](const std::vector<Vec2>& uvs) {
    return uvs[c[0]] * (1 - w1 - w2) + uvs[c[1]] * w1 + uvs[c[2]] * w2;
  };
  return m.uvs_2.empty() ? TexturePlace(between(m.uvs))
                         : TexturePlace(between(m.uvs), between(m.uvs_2));
}

struct ElementSurface {
  Reflectances sides[2];
  float coverage = 1;  // opaque share (alpha)
};

ElementSurface average_surface(const Scene& scene, const BsdfTables& tables,
                               const RadiosityMesh& mesh, const Elements& e, uint32_t element) {
  constexpr uint32_t max_fragments = 16;
  constexpr Vec3 weights[4] = {{1.0f / 3, 1.0f / 3, 1.0f / 3},
                               {2.0f / 3, 1.0f / 6, 1.0f / 6},
                               {1.0f / 6, 2.0f / 3, 1.0f / 6},
                               {1.0f / 6, 1.0f / 6, 2.0f / 3}};
  const ElementInfo& info = e.infos[element];
  const uint32_t first_base = e.base_triangle[info.fragment];
  const uint32_t material =
      mesh.geometry.surfaces[mesh.geometry.triangles[first_base].surface].material;
  const Material& m = scene.materials[material];
  ElementSurface out;
  if (!has_textured_input(m) && !m.is_alpha_masked) {
    for (size_t side = 0; side < 2; ++side)
      out.sides[side] = reflectances(tables, scene, material, {}, side == 0);
    return out;
  }
  const uint32_t count = info.last - info.first;
  const uint32_t step = std::max(1u, (count + max_fragments - 1) / max_fragments);
  double total = 0, solid = 0;
  Rgb sums[2][2];
  for (uint32_t i = info.first; i < info.last; i += step) {
    const uint32_t f = e.order[i];
    const double share = std::max(e.area[f], 1e-30);
    for (const Vec3& w : weights) {
      const TexturePlace uv = uv_at(scene, mesh, e.base_triangle[f], f, w);
      total += share;
      const double there =
          m.is_alpha_masked ? double(coverage(scene.textures, m, uv)) * share : share;
      if (there <= 0) continue;
      solid += there;
      for (size_t side = 0; side < 2; ++side) {
        const Reflectances r = reflectances(tables, scene, material, uv, side == 0);
        sums[side][0] += r.diffuse * float(there);
        sums[side][1] += r.other * float(there);
      }
    }
  }
  out.coverage = float(solid / total);
  if (solid > 0)
    for (size_t side = 0; side < 2; ++side)
      out.sides[side] = {sums[side][0] / float(solid), sums[side][1] / float(solid)};
  return out;
}

ElementPoint point_of(const Scene& scene, const RadiosityMesh& mesh, const Elements& e,
                      const ElementSurface& surface, uint32_t element, bool is_back) {
  const ElementInfo& info = e.infos[element];
  ElementPoint p;
  const Vec3d at = middle(mesh, info.fragment);
  p.position = Vec3(at);
  p.normal = fragment_normal(mesh, info.fragment);
  const BaseSurface& s =
      mesh.geometry.surfaces[mesh.geometry.triangles[e.base_triangle[info.fragment]].surface];
  if (s.bulge == Bulge::sphere) {
    const Sphere& sphere = scene.spheres[s.index];
    p.normal = Vec3(normalize(at - Vec3d(sphere.centre)));
    p.position = sphere.centre + p.normal * sphere.radius;
    if (sphere.is_inside_out) p.normal = -p.normal;
  }
  if (is_back) p.normal = -p.normal;
  p.area = float(info.area) * surface.coverage;
  const Vec3 a = abs(p.position) + Vec3{mesh.element_size};
  p.offset = 4 * ray_offset(std::max({a.x, a.y, a.z}));
  p.reflectance = surface.sides[is_back ? 1 : 0].diffuse;
  p.specular_albedo = surface.sides[is_back ? 1 : 0].other;
  return p;
}

bool emits(const Scene& scene, int32_t light, bool is_back) {
  if (light < 0) return false;
  const Light& e = scene.lights[size_t(light)];
  return !e.radiance.is_black() && (!is_back || e.is_two_sided);
}

// Returns the normal on the front. Spheres use their own, because their fragments are not aligned
// with it.
Vec3 hit_normal(const Scene& scene, const RadiosityMesh& mesh, const Hit& hit, uint32_t fragment,
                const Vec3& at) {
  if (hit.geometry != scene.meshes.size()) return fragment_normal(mesh, fragment);
  const Sphere& s = scene.spheres[hit.primitive];
  return s.is_inside_out ? s.centre - at : at - s.centre;
}

// Results of the rays from each side of each element.
struct Looks {
  std::vector<uint8_t> reached;  // 1: light can reach the side
  std::vector<uint32_t> rays, leaving;
};

// Traces rays from all sides. A side is reached if a chain of sides that see each other connects it
// to a side that emits.
Looks look_around(const Scene& scene, const Tracer& tracer, const RadiosityMesh& mesh,
                  const Elements& e, const std::vector<ElementPoint>& sides, int threads) {
  const size_t n = sides.size();
  Looks looks;
  looks.rays.resize(n);
  looks.leaving.resize(n);
  // One node stands for the outside: sides that rays leave through are connected with each other.
  // In open scenes the few rays of a side may otherwise miss the path by which light reaches it.
  const auto lit = uint32_t(n), outside = uint32_t(n + 1);
  std::vector<uint8_t> is_source(n);
  for (uint32_t f = 0; f < mesh.fragments.size(); ++f)
    for (uint32_t side = 0; side < 2; ++side)
      if (emits(scene, mesh.geometry.triangles[e.base_triangle[f]].light, side == 1))
        is_source[2 * mesh.fragments[f].element + side] = 1;
  std::vector<std::vector<uint32_t>> seen(n);
  parallel_for((n + 63) / 64, threads, [&](size_t block) {
    std::vector<Ray> rays;
    std::vector<Hit> hits;
    for (size_t i = block * 64; i < std::min(n, block * 64 + 64); ++i) {
      const ElementPoint& p = sides[i];
      const Frame frame(p.normal);
      rays.clear();
      const int count = is_source[i] ? reach_rays_of_lights : reach_rays;
      for (int k = 0; k < count; ++k) {
        const Vec2 u = SobolGroup(hash_of(i), purpose_reach, uint32_t(k)).get2();
        Ray r;
        r.origin = p.position + p.normal * p.offset;
        r.direction = frame.to_world(cosine_hemisphere_from_square(u));
        rays.push_back(r);
      }
      hits.assign(rays.size(), {});
      tracer.closest(rays, hits);
      for (size_t k = 0; k < rays.size(); ++k) {
        ++looks.rays[i];
        if (!hits[k].is_valid()) {
          ++looks.leaving[i];
          seen[i].push_back(outside);
          continue;
        }
        Vec3 weights;
        bool is_turned = false;  // unused: the fragment's own normal decides below
        const Vec3 at = rays[k].origin + rays[k].direction * hits[k].t;
        const uint32_t f = fragment_at(scene, mesh, hits[k].geometry, hits[k].primitive, hits[k].u,
                                       hits[k].v, at, is_turned, weights);
        if (f == no_fragment) continue;
        const Vec3 normal = hit_normal(scene, mesh, hits[k], f, at);
        const bool is_back = dot(normal, rays[k].direction) > 0;
        seen[i].push_back(2 * mesh.fragments[f].element + (is_back ? 1 : 0));
      }
    }
  });
  DisjointSets rooms(n + 2);  // over 2 element + side, and the two nodes above
  for (uint32_t i = 0; i < n; ++i) {
    if (is_source[i]) rooms.join(i, lit);
    for (const uint32_t j : seen[i]) rooms.join(i, j);
  }
  looks.reached.resize(n);
  for (uint32_t i = 0; i < n; ++i) looks.reached[i] = rooms.find(i) == rooms.find(lit);
  return looks;
}

}  // namespace

Reflectances reflectances(const BsdfTables& tables, const Scene& scene, uint32_t material,
                          const TexturePlace& uv, bool is_front) {
  Bsdf b = make_bsdf(tables, scene, material, uv, is_front);
  b.through = Rgb{0};  // diffuse transmission takes no part in radiosity
  Rgb rho;
  if (is_lambertian(b, &rho)) return {rho, Rgb{0}};
  // Gauss-Legendre quadrature over cos²: the cosine-weighted mean of the directional albedo.
  constexpr float nodes[3] = {0.11270166538f, 0.5f, 0.88729833462f};
  constexpr float weights[3] = {5.0f / 18, 8.0f / 18, 5.0f / 18};
  Rgb all;
  for (size_t i = 0; i < 3; ++i) all += albedo(b, std::sqrt(nodes[i])) * weights[i];
  // The coat passes the share diffuse_mean of incoming light, and the same of outgoing light.
  const float mean = b.coat == Bsdf::Coat::none ? 1.0f : b.diffuse_mean;
  const Rgb diffuse = b.diffuse * (mean * mean);
  // The gloss of a coat reflects little and spreads it widely, so it counts as diffuse. Pure
  // mirrors and glass have no diffuse light to add it to.
  if (!diffuse.is_black() && !b.has_transmission) return {all, Rgb{0}};
  const auto above = [](float a, float d) { return std::max(0.0f, a - d); };
  return {diffuse, {above(all.r, diffuse.r), above(all.g, diffuse.g), above(all.b, diffuse.b)}};
}

void make_points(const Scene& scene, const Tracer& tracer, const BsdfTables& tables,
                 const MeshingOptions& options, int threads, const Cut& cut, RadiosityMesh& mesh) {
  const Elements e = gather_elements(scene, mesh);
  const size_t n = mesh.element_count;
  std::vector<ElementPoint> sides(2 * n);
  parallel_for((n + 63) / 64, threads, [&](size_t block) {
    for (size_t i = block * 64; i < std::min(n, block * 64 + 64); ++i) {
      const auto element = uint32_t(i);
      const ElementSurface s = average_surface(scene, tables, mesh, e, element);
      for (size_t side = 0; side < 2; ++side)
        sides[2 * i + side] = point_of(scene, mesh, e, s, element, side == 1);
    }
  });
  Looks looks = look_around(scene, tracer, mesh, e, sides, threads);
  if (!options.prune_hidden_sides) looks.reached.assign(sides.size(), 1);

  std::vector<uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return cut.element_sheet[a] < cut.element_sheet[b];
  });
  mesh.element_points.assign(n, {no_point, no_point});
  for (size_t first = 0, last = 0; first < n; first = last) {
    const uint32_t sheet = cut.element_sheet[order[first]];
    while (last < n && cut.element_sheet[order[last]] == sheet) ++last;
    for (uint32_t side = 0; side < 2; ++side) {
      Patch patch;
      patch.sheet = sheet;
      patch.first_point = uint32_t(mesh.points.size());
      patch.is_back = side == 1;
      double open = 0;
      for (size_t k = first; k < last; ++k) {
        const size_t i = 2 * size_t(order[k]) + side;
        if (looks.reached[i] == 0 || !(sides[i].area > 0)) continue;
        mesh.element_points[order[k]][side] = uint32_t(mesh.points.size());
        sides[i].patch = uint32_t(mesh.patches.size());
        mesh.points.push_back(sides[i]);
        patch.area += sides[i].area;
        patch.open_rays += looks.rays[i];
        open += double(sides[i].area) * looks.leaving[i] / std::max(1u, looks.rays[i]);
      }
      patch.open = patch.area > 0 ? float(open / double(patch.area)) : 0.0f;
      patch.last_point = uint32_t(mesh.points.size());
      if (patch.last_point > patch.first_point) mesh.patches.push_back(patch);
    }
  }
}

}  // namespace troffer
