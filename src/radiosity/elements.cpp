#include "radiosity/elements.h"

#include <cmath>

#include "base/units.h"

namespace troffer {

namespace {

void note_base(const RadiosityMesh& mesh, int32_t root, uint32_t triangle,
               std::vector<uint32_t>& base) {
  std::vector<int32_t> stack{root};
  while (!stack.empty()) {
    const int32_t at = stack.back();
    stack.pop_back();
    if (at < 0) {
      base[size_t(~at)] = triangle;
    } else {
      for (const int32_t c : mesh.nodes[size_t(at)].child) stack.push_back(c);
    }
  }
}

double true_area(const Scene& scene, const BaseSurface& s) {
  if (s.bulge == Bulge::sphere) return 4 * pi * sqr(double(scene.spheres[s.index].radius));
  return pi * sqr(double(scene.disks[s.index].radius));
}

}  // namespace

Vec3d middle(const RadiosityMesh& mesh, uint32_t fragment) {
  Vec3d sum;
  for (const uint32_t v : mesh.fragments[fragment].vertices)
    sum += Vec3d(mesh.geometry.positions[v]);
  return sum / 3;
}

Elements gather_elements(const Scene& scene, const RadiosityMesh& mesh) {
  Elements e;
  const auto n = uint32_t(mesh.fragments.size());
  e.infos.resize(mesh.element_count);
  e.base_triangle.resize(n);
  e.area.resize(n);
  for (uint32_t t = 0; t < mesh.roots.size(); ++t)
    if (mesh.roots[t] != RadiosityMesh::no_root) note_base(mesh, mesh.roots[t], t, e.base_triangle);
  std::vector<double> surface_area(mesh.geometry.surfaces.size());
  const auto surface_of = [&](uint32_t f) {
    return mesh.geometry.triangles[e.base_triangle[f]].surface;
  };
  for (uint32_t f = 0; f < n; ++f) {
    const auto& v = mesh.fragments[f].vertices;
    const Vec3d a(mesh.geometry.positions[v[0]]);
    e.area[f] = 0.5 * length(cross(Vec3d(mesh.geometry.positions[v[1]]) - a,
                                   Vec3d(mesh.geometry.positions[v[2]]) - a));
    surface_area[surface_of(f)] += e.area[f];
    ++e.infos[mesh.fragments[f].element].last;
  }
  uint32_t sum = 0;
  for (ElementInfo& info : e.infos) {
    info.first = sum;
    sum += info.last;
    info.last = info.first;
  }
  e.order.resize(n);
  for (uint32_t f = 0; f < n; ++f) {
    const BaseSurface& s = mesh.geometry.surfaces[surface_of(f)];
    if (s.bulge != Bulge::none) e.area[f] *= true_area(scene, s) / surface_area[surface_of(f)];
    ElementInfo& info = e.infos[mesh.fragments[f].element];
    e.order[info.last++] = f;
    info.area += e.area[f];
    info.centroid += middle(mesh, f) * e.area[f];
  }
  for (ElementInfo& info : e.infos) {
    info.centroid = info.area > 0 ? info.centroid / info.area : middle(mesh, e.order[info.first]);
    double nearest = INFINITY;
    for (uint32_t i = info.first; i < info.last; ++i) {
      const double d = length_squared(middle(mesh, e.order[i]) - info.centroid);
      if (d < nearest) {
        nearest = d;
        info.fragment = e.order[i];
      }
    }
  }
  return e;
}

}  // namespace troffer
