#include "bake/surfaces.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "export/scene_parts.h"

namespace troffer {

namespace {

constexpr float fineness_of_dark = 0.125f;

// True if light passes through and hardly any is reflected diffusely.
bool is_clear(const Material& m) {
  return m.kind == MaterialKind::dielectric || m.kind == MaterialKind::angular ||
         (m.transmission.value > 0.5f && m.transmission.texture < 0);
}

bool has_textures_by_second_set(const Scene& scene, const Material& m) {
  bool is_any = false;
  const auto look = [&](int32_t texture) {
    const Texture* image = nullptr;
    if (texture >= 0) image = &scene.textures[size_t(texture)];
    while (image && image->kind == TextureKind::product) {
      is_any = is_any || scene.textures[image->factor_b].mapping == TextureMapping::second_uv;
      image = &scene.textures[image->factor_a];
    }
    is_any = is_any || (image && image->mapping == TextureMapping::second_uv);
  };
  for_each_input(m, [&](const auto& input) { look(input.texture); });
  look(m.alpha.texture);
  look(m.normal_texture);
  look(m.coat_normal_texture);
  return is_any;
}

// Result for one mesh. The caller collects warnings, since meshes are charted in parallel.
struct Charting {
  ChartedMesh charted;
  bool has_unfit_set = false;
};

Charting charting_of(const Scene& scene, const Mesh& mesh) {
  Charting out;
  if (!mesh.lights.empty() || is_clear(scene.materials[mesh.material])) return out;
  const bool is_used = has_textures_by_second_set(scene, scene.materials[mesh.material]);
  if (!mesh.uvs_2.empty() && chart_of_uvs(mesh, mesh.uvs_2, out.charted)) {
    if (!is_used) out.charted.mesh.uvs_2.clear();
    return out;
  }
  out.has_unfit_set = !mesh.uvs_2.empty();
  out.charted = charted(mesh);
  if (!is_used) out.charted.mesh.uvs_2.clear();
  return out;
}

float scale_of(const Instance& instance) {
  return float(std::cbrt(std::abs(double(instance.world_from_mesh.determinant()))));
}

void list_stands(BakedSurfaces& s) {
  s.stands.clear();
  const size_t meshes = s.scene.meshes.size();
  for (uint32_t i = 0; i < meshes; ++i)
    if (!s.charted[i].charts.empty()) s.stands.push_back({i, false, i, 1});
  for (uint32_t i = 0; i < s.scene.instances.size(); ++i) {
    const auto charted = uint32_t(meshes + s.scene.instances[i].mesh);
    if (!s.charted[charted].charts.empty())
      s.stands.push_back({charted, true, i, scale_of(s.scene.instances[i])});
  }
  s.charts = s.degenerate = 0;
  for (const ChartedMesh& c : s.charted) {
    s.charts += c.charts.size();
    s.degenerate += c.degenerate;
  }
}

// Turns spheres and disks that do not emit into meshes, and renumbers the others.
void round_to_meshes(Scene& scene) {
  std::vector<Sphere> spheres;
  std::vector<Disk> disks;
  for (const Sphere& s : scene.spheres) {
    if (s.light < 0) {
      scene.meshes.push_back(sphere_mesh(s));
      continue;
    }
    scene.lights[size_t(s.light)].geometry = uint32_t(spheres.size());
    spheres.push_back(s);
  }
  for (const Disk& d : scene.disks) {
    if (d.light < 0) {
      scene.meshes.push_back(disk_mesh(d));
      continue;
    }
    scene.lights[size_t(d.light)].geometry = uint32_t(disks.size());
    disks.push_back(d);
  }
  scene.spheres = std::move(spheres);
  scene.disks = std::move(disks);
}

// Builds a mesh from some charts of another.
class ChartPicker {
 public:
  ChartPicker(const ChartedMesh& from, bool is_layer) : from_(from), is_layer_(is_layer) {
    out_.mesh.name = from.mesh.name;
    out_.mesh.material = from.mesh.material;
    number_.assign(from.mesh.positions.size(), none);
  }
  void add(const Chart& chart, bool is_turned, float fineness) {
    Chart added;
    added.size = chart.size;
    added.fineness = fineness;
    added.is_layer = is_layer_;
    add_triangles(chart.triangles, is_turned, &added);
    out_.charts.push_back(std::move(added));
  }
  // Adds the triangles that belong to no chart.
  void add_rest() {
    std::vector<uint8_t> is_in(from_.mesh.triangles.size(), 0);
    for (const Chart& c : from_.charts)
      for (const uint32_t t : c.triangles) is_in[t] = 1;
    std::vector<uint32_t> rest;
    for (uint32_t t = 0; t < is_in.size(); ++t)
      if (!is_in[t]) rest.push_back(t);
    add_triangles(rest, false, nullptr);
    out_.degenerate = rest.size();
  }
  ChartedMesh take() { return std::move(out_); }

 private:
  static constexpr uint32_t none = 0xffffffffu;
  const ChartedMesh& from_;
  const bool is_layer_;
  ChartedMesh out_;
  std::vector<uint32_t> number_;

  void add_triangles(const std::vector<uint32_t>& triangles, bool is_turned, Chart* chart) {
    std::vector<uint32_t> used;
    for (const uint32_t t : triangles) {
      Triangle to;
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t v = from_.mesh.triangles[t][k];
        if (number_[v] == none) {
          used.push_back(v);
          number_[v] = uint32_t(out_.mesh.positions.size());
          add_vertex(v, is_turned);
        }
        to[k] = number_[v];
      }
      if (is_turned) std::swap(to[1], to[2]);
      if (chart) chart->triangles.push_back(uint32_t(out_.mesh.triangles.size()));
      out_.mesh.triangles.push_back(to);
    }
    for (const uint32_t v : used) number_[v] = none;  // another layer copies its vertices again
  }
  void add_vertex(uint32_t v, bool is_turned) {
    const Mesh& m = from_.mesh;
    out_.mesh.positions.push_back(m.positions[v]);
    out_.places.push_back(from_.places[v]);
    if (!m.normals.empty()) out_.mesh.normals.push_back(is_turned ? -m.normals[v] : m.normals[v]);
    if (!m.uvs.empty()) out_.mesh.uvs.push_back(m.uvs[v]);
    if (!m.uvs_2.empty()) out_.mesh.uvs_2.push_back(m.uvs_2[v]);
  }
};

// Charts lit on one side, and charts lit on both.
struct Divided {
  ChartedMesh single, layers;
};

Divided divided(const ChartedMesh& from, const std::vector<LitSides>& sides) {
  ChartPicker single(from, false), layers(from, true);
  for (size_t c = 0; c < from.charts.size(); ++c) {
    const Chart& chart = from.charts[c];
    if (sides[c] == LitSides::front || sides[c] == LitSides::back) {
      single.add(chart, sides[c] == LitSides::back, 1);
      continue;
    }
    layers.add(chart, false, sides[c] == LitSides::back_more ? fineness_of_dark : 1);
    layers.add(chart, true, sides[c] == LitSides::front_more ? fineness_of_dark : 1);
  }
  single.add_rest();
  return {single.take(), layers.take()};
}

// Copies materials as one-sided ones, each at most once.
class OneSided {
 public:
  explicit OneSided(Scene& scene) : scene_(scene) { made_.assign(scene.materials.size(), 0); }
  uint32_t of(uint32_t material) {
    if (scene_.materials[material].back_faces == BackFaces::unseen) return material;
    if (made_[material] == 0) {
      made_[material] = uint32_t(scene_.materials.size());
      Material copy = scene_.materials[material];
      copy.back_faces = BackFaces::unseen;
      scene_.materials.push_back(std::move(copy));
    }
    return made_[material];
  }

 private:
  Scene& scene_;
  std::vector<uint32_t> made_;
};

}  // namespace

Scene as_meshes(Scene scene) {
  round_to_meshes(scene);
  std::vector<Mesh> dark;
  for (Mesh& mesh : scene.meshes) {
    std::vector<Triangle> lit, other;
    std::vector<int32_t> lights;
    for (size_t t = 0; t < mesh.lights.size(); ++t) {
      (mesh.lights[t] >= 0 ? lit : other).push_back(mesh.triangles[t]);
      if (mesh.lights[t] >= 0) lights.push_back(mesh.lights[t]);
    }
    if (lit.empty()) mesh.lights.clear();
    if (lit.empty() || other.empty()) continue;
    for (const int32_t light : lights) scene.lights[size_t(light)].triangles.clear();
    for (uint32_t t = 0; t < lights.size(); ++t)
      scene.lights[size_t(lights[t])].triangles.push_back(t);
    dark.push_back(extracted(mesh, other));
    Mesh shining = extracted(mesh, lit);
    shining.lights = std::move(lights);
    mesh = std::move(shining);
  }
  for (Mesh& mesh : dark) scene.meshes.push_back(std::move(mesh));
  return scene;
}

BakedSurfaces surfaces_of(Scene scene, int threads) {
  BakedSurfaces out;
  const size_t meshes = scene.meshes.size(), all = meshes + scene.instanced_meshes.size();
  std::vector<Charting> made(all);
  const auto mesh_of = [&](size_t i) -> Mesh& {
    return i < meshes ? scene.meshes[i] : scene.instanced_meshes[i - meshes];
  };
  parallel_for(all, threads, [&](size_t i) { made[i] = charting_of(scene, mesh_of(i)); });
  for (size_t i = 0; i < all; ++i) {
    if (made[i].has_unfit_set)
      out.warnings.add(
          "a second set of texture coordinates cannot hold a lightmap (outside of [0,1], or "
          "overlapping); a new one is made");
    if (!made[i].charted.charts.empty()) mesh_of(i) = made[i].charted.mesh;
    out.charted.push_back(std::move(made[i].charted));
  }
  out.scene = std::move(scene);
  list_stands(out);
  return out;
}

BakedSurfaces with_sides(BakedSurfaces from, const std::vector<std::vector<LitSides>>& sides) {
  BakedSurfaces out;
  out.warnings = from.warnings;
  Scene& scene = from.scene;
  OneSided one_sided(scene);
  const size_t meshes = scene.meshes.size();
  std::vector<Mesh> added, added_instanced;
  std::vector<ChartedMesh> charted_added, charted_added_instanced;
  std::vector<Instance> instances = scene.instances;
  for (size_t i = 0; i < from.charted.size(); ++i) {
    if (sides[i].empty()) continue;
    const bool is_plain = i < meshes;
    Divided d = divided(from.charted[i], sides[i]);
    if (!d.layers.charts.empty()) {
      d.layers.mesh.material = one_sided.of(d.layers.mesh.material);
      // If all charts are layers, they replace the mesh.
      if (d.single.mesh.triangles.empty()) {
        d.single = std::move(d.layers);
      } else if (is_plain) {
        added.push_back(d.layers.mesh);
        charted_added.push_back(std::move(d.layers));
      } else {
        const auto number = uint32_t(scene.instanced_meshes.size() + added_instanced.size());
        for (const Instance& of : scene.instances)
          if (of.mesh == i - meshes) {
            instances.push_back(of);
            instances.back().mesh = number;
          }
        added_instanced.push_back(d.layers.mesh);
        charted_added_instanced.push_back(std::move(d.layers));
      }
    }
    (is_plain ? scene.meshes[i] : scene.instanced_meshes[i - meshes]) = d.single.mesh;
    from.charted[i] = std::move(d.single);
  }
  scene.instances = std::move(instances);
  for (size_t i = 0; i < meshes; ++i) out.charted.push_back(std::move(from.charted[i]));
  for (ChartedMesh& c : charted_added) out.charted.push_back(std::move(c));
  for (size_t i = meshes; i < from.charted.size(); ++i)
    out.charted.push_back(std::move(from.charted[i]));
  for (ChartedMesh& c : charted_added_instanced) out.charted.push_back(std::move(c));
  for (Mesh& m : added) scene.meshes.push_back(std::move(m));
  for (Mesh& m : added_instanced) scene.instanced_meshes.push_back(std::move(m));
  out.scene = std::move(scene);
  list_stands(out);
  return out;
}

void lift_layers(BakedSurfaces& s) {
  constexpr float roundings = 8e-6f;
  for (size_t i = 0; i < s.charted.size(); ++i) {
    ChartedMesh& m = s.charted[i];
    const Vec3 reach = reach_of(m.mesh);
    const float lift = std::max(1e-5f, roundings * std::max({reach.x, reach.y, reach.z}));
    bool is_any = false;
    for (const Chart& chart : m.charts) {
      if (!chart.is_layer) continue;
      is_any = true;
      Vec3d normal;
      std::vector<uint32_t> vertices;
      for (const uint32_t t : chart.triangles) {
        const auto& [a, b, c] = m.mesh.triangles[t];
        const Vec3d p(m.mesh.positions[a]);
        normal += cross(Vec3d(m.mesh.positions[b]) - p, Vec3d(m.mesh.positions[c]) - p);
        vertices.insert(vertices.end(), {a, b, c});
      }
      std::sort(vertices.begin(), vertices.end());
      vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
      const Vec3 way = Vec3(normal / std::max(length(normal), 1e-300)) * lift;
      for (const uint32_t v : vertices) m.mesh.positions[v] += way;
    }
    if (!is_any) continue;
    const size_t meshes = s.scene.meshes.size();
    (i < meshes ? s.scene.meshes[i] : s.scene.instanced_meshes[i - meshes]) = m.mesh;
  }
}

}  // namespace troffer
