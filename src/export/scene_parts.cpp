#include "export/scene_parts.h"

#include <algorithm>
#include <cmath>

#include "base/frame.h"
#include "base/units.h"

namespace troffer {

namespace {

constexpr int around = 96, from_pole_to_pole = 48;

}  // namespace

Mesh extracted(const Mesh& from, const std::vector<Triangle>& triangles) {
  Mesh to;
  to.name = from.name;
  to.material = from.material;
  constexpr uint32_t unused = 0xffffffffu;
  std::vector<uint32_t> renumbered(from.positions.size(), unused);
  for (const Triangle& t : triangles) {
    Triangle out;
    for (size_t k = 0; k < 3; ++k) {
      uint32_t& v = renumbered[t[k]];
      if (v == unused) {
        v = uint32_t(to.positions.size());
        to.positions.push_back(from.positions[t[k]]);
        if (!from.normals.empty()) to.normals.push_back(from.normals[t[k]]);
        if (!from.uvs.empty()) to.uvs.push_back(from.uvs[t[k]]);
        if (!from.uvs_2.empty()) to.uvs_2.push_back(from.uvs_2[t[k]]);
      }
      out[k] = v;
    }
    to.triangles.push_back(out);
  }
  return to;
}

namespace {

double area_of_triangles(const Mesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d p(mesh.positions[t[0]]);
    sum += length(cross(Vec3d(mesh.positions[t[1]]) - p, Vec3d(mesh.positions[t[2]]) - p)) / 2;
  }
  return sum;
}

}  // namespace

Mesh sphere_mesh(const Sphere& s) {
  Mesh m;
  m.name = "sphere";
  m.material = s.material;
  for (int j = 0; j <= from_pole_to_pole; ++j) {
    for (int i = 0; i <= around; ++i) {
      const double theta = pi * j / from_pole_to_pole, phi = 2 * pi * (i % around) / around;
      const double sine = j == 0 || j == from_pole_to_pole ? 0 : std::sin(theta);
      const Vec3d n(std::cos(phi) * sine, std::sin(phi) * sine, std::cos(theta));
      m.positions.emplace_back(Vec3d(s.centre) + n * double(s.radius));
      m.normals.emplace_back(s.is_inside_out ? -n : n);
    }
  }
  const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
    m.triangles.push_back(s.is_inside_out ? Triangle{a, c, b} : Triangle{a, b, c});
  };
  for (int j = 0; j < from_pole_to_pole; ++j) {
    for (int i = 0; i < around; ++i) {
      const auto a = uint32_t(j * (around + 1) + i), below = a + around + 1;
      if (j > 0) add(a, below, a + 1);
      if (j + 1 < from_pole_to_pole) add(a + 1, below, below + 1);
    }
  }
  return m;
}

Mesh disk_mesh(const Disk& d) {
  Mesh m;
  m.name = "disk";
  m.material = d.material;
  const Frame f(d.normal);
  for (int i = 0; i < around; ++i) {
    const double phi = 2 * pi * i / around;
    m.positions.push_back(d.centre +
                          (f.tangent * float(std::cos(phi)) + f.bitangent * float(std::sin(phi))) *
                              d.radius);
    if (i >= 2) m.triangles.push_back({0, uint32_t(i - 1), uint32_t(i)});
  }
  return m;
}

namespace {

void add_round(SceneParts& out, Mesh mesh, int32_t light, double area) {
  if (light >= 0) out.radiances[size_t(light)] *= float(area / area_of_triangles(mesh));
  out.parts.push_back({std::move(mesh), light});
}

}  // namespace

SceneParts parts_of(const Scene& scene, bool with_round) {
  SceneParts out;
  for (const Light& e : scene.lights) out.radiances.push_back(e.radiance);
  for (const Mesh& mesh : scene.meshes) {
    if (mesh.lights.empty()) {
      out.parts.push_back({mesh, no_light, uint32_t(&mesh - scene.meshes.data())});
      continue;
    }
    std::vector<size_t> order(mesh.triangles.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return mesh.lights[a] < mesh.lights[b]; });
    for (size_t begin = 0; begin < order.size();) {
      const int32_t light = mesh.lights[order[begin]];
      std::vector<Triangle> triangles;
      for (; begin < order.size() && mesh.lights[order[begin]] == light; ++begin)
        triangles.push_back(mesh.triangles[order[begin]]);
      out.parts.push_back({extracted(mesh, triangles), light});
    }
  }
  if (with_round) {
    for (const Sphere& s : scene.spheres)
      add_round(out, sphere_mesh(s), s.light, 4 * pi * sqr(double(s.radius)));
    for (const Disk& d : scene.disks)
      add_round(out, disk_mesh(d), d.light, pi * sqr(double(d.radius)));
  }
  std::stable_sort(out.parts.begin(), out.parts.end(), [](const ScenePart& a, const ScenePart& b) {
    return uint32_t(a.light) < uint32_t(b.light);  // none: last
  });
  return out;
}

}  // namespace troffer
