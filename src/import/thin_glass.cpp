#include "import/thin_glass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "base/frame.h"

namespace troffer {

bool may_be_thin_glass(const Material& m) {
  const bool is_glass =
      m.kind == MaterialKind::dielectric || (m.kind == MaterialKind::metallic_roughness &&
                                             m.transmission.value >= 1 && m.metallic.value <= 0);
  return is_glass && !m.is_thin && !m.is_alpha_masked && m.roughness.value <= 0 &&
         m.normal_texture < 0 && m.coat_normal_texture < 0 && !has_textured_input(m);
}

namespace {

constexpr double most_thickness = 1.0 / 30;  // relative to the smaller side
constexpr double cap_flatness = 1e-3;        // relative to the thickness
constexpr size_t most_triangles = 1 << 17;   // a larger mesh is not examined

// Returns the same glass as a sheet. The tint is squared, because light crosses both faces of the
// body.
Material sheet_of(const Material& solid, float thickness) {
  Material m = solid;
  m.is_thin = true;
  m.base_color.value *= m.base_color.value;
  m.absorption *= thickness;
  return m;
}

// Sheet materials for solid ones. An absorbing material needs one for each thickness.
class SheetMaterials {
 public:
  explicit SheetMaterials(Scene& scene) : scene_(scene) {}
  uint32_t of(uint32_t solid, double thickness) {
    const bool is_absorbing = !scene_.materials[solid].absorption.is_black();
    const auto steps = int64_t(std::lround(std::log(thickness) * 1000));  // .1 %
    const std::pair key{solid, is_absorbing ? steps : 0};
    const auto found = made_.find(key);
    if (found != made_.end()) return found->second;
    const auto index = uint32_t(scene_.materials.size());
    scene_.materials.push_back(sheet_of(scene_.materials[solid], float(thickness)));
    return made_[key] = index;
  }

 private:
  Scene& scene_;
  std::map<std::pair<uint32_t, int64_t>, uint32_t> made_;
};

// A mesh divided into bodies that share no corner.
class Bodies {
 public:
  explicit Bodies(const Mesh& mesh) : mesh_(mesh), corner_(mesh.positions.size()) {
    std::map<std::array<float, 3>, uint32_t> first;
    for (uint32_t i = 0; i < corner_.size(); ++i) {
      const Vec3& p = mesh.positions[i];
      corner_[i] = first.emplace(std::array<float, 3>{p.x, p.y, p.z}, i).first->second;
    }
    parent_ = corner_;
    for (const Triangle& t : mesh.triangles)
      for (const uint32_t i : {t[1], t[2]}) parent_[root(corner_[i])] = root(corner_[t[0]]);
    std::map<uint32_t, std::vector<uint32_t>> of_root;
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
      of_root[root(corner_[mesh.triangles[t][0]])].push_back(t);
    for (auto& [r, triangles] : of_root) bodies_.push_back(std::move(triangles));
  }
  const std::vector<std::vector<uint32_t>>& all() const { return bodies_; }

  // True if each edge belongs to exactly two triangles with opposite directions.
  bool is_closed(const std::vector<uint32_t>& triangles) const {
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    for (const uint32_t t : triangles)
      for (size_t i = 0; i < 3; ++i) {
        const uint32_t a = corner_[mesh_.triangles[t][i]],
                       b = corner_[mesh_.triangles[t][(i + 1) % 3]];
        if (a == b || ++edges[{a, b}] > 1) return false;
      }
    return std::all_of(edges.begin(), edges.end(), [&](const auto& e) {
      return edges.count({e.first.second, e.first.first}) == 1;
    });
  }

 private:
  uint32_t root(uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  const Mesh& mesh_;
  std::vector<uint32_t> corner_, parent_;  // per vertex: the first at its place; set parent
  std::vector<std::vector<uint32_t>> bodies_;
};

struct Sheet {
  std::vector<std::array<Vec3, 3>> triangles;  // empty: no sheet
  double thickness = 0;
};

// Returns the sheet in the middle of a thin prism: one of its caps, shifted; an empty sheet for
// other bodies.
Sheet sheet_in(const Mesh& mesh, const std::vector<uint32_t>& body) {
  const auto corners = [&](uint32_t t) {
    const Triangle& v = mesh.triangles[t];
    return std::array<Vec3, 3>{mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]};
  };
  Vec3d largest;
  for (const uint32_t t : body) {
    const auto c = corners(t);
    const Vec3d n = cross(Vec3d(c[1]) - Vec3d(c[0]), Vec3d(c[2]) - Vec3d(c[0]));
    if (length_squared(n) > length_squared(largest)) largest = n;
  }
  if (!(length_squared(largest) > 0)) return {};
  const Framed frame(normalize(largest));
  const Vec3d axes[3] = {frame.normal, frame.tangent, frame.bitangent};
  Vec3d low{1e300, 1e300, 1e300}, high = low * -1.0;
  for (const uint32_t t : body)
    for (const Vec3& p : corners(t))
      for (size_t a = 0; a < 3; ++a) {
        low[a] = std::min(low[a], dot(Vec3d(p), axes[a]));
        high[a] = std::max(high[a], dot(Vec3d(p), axes[a]));
      }
  const double thickness = high[0] - low[0];
  if (!(thickness > 0) || thickness > most_thickness * std::min(high[1] - low[1], high[2] - low[2]))
    return {};
  double upper = 0, lower = 0;  // areas of the caps
  Sheet sheet{{}, thickness};
  for (const uint32_t t : body) {
    auto c = corners(t);
    int above = 0;
    for (const Vec3& p : c) {
      const double h = dot(Vec3d(p), axes[0]);
      const bool is_high = high[0] - h < cap_flatness * thickness;
      if (!is_high && h - low[0] >= cap_flatness * thickness) return {};
      above += is_high ? 1 : 0;
    }
    const double area =
        0.5 * dot(cross(Vec3d(c[1]) - Vec3d(c[0]), Vec3d(c[2]) - Vec3d(c[0])), axes[0]);
    if (above == 0) lower -= area;
    if (above != 3) continue;
    upper += area;
    for (Vec3& p : c) p = Vec3(Vec3d(p) - axes[0] * (0.5 * thickness));
    sheet.triangles.push_back(c);
  }
  if (!(upper > 0) || std::abs(upper - lower) > 0.01 * upper) return {};
  return sheet;
}

void add_sheet(const Sheet& sheet, Mesh& mesh) {
  for (const auto& t : sheet.triangles) {
    const auto first = uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), t.begin(), t.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
}

}  // namespace

void replace_thin_glass(Scene& scene) {
  SheetMaterials sheets(scene);
  const size_t n = scene.meshes.size();
  for (size_t i = 0; i < n; ++i) {
    const uint32_t material = scene.meshes[i].material;
    if (!scene.meshes[i].lights.empty() || scene.meshes[i].triangles.size() > most_triangles ||
        !may_be_thin_glass(scene.materials[material]))
      continue;
    Bodies bodies(scene.meshes[i]);
    std::map<uint32_t, Mesh> panes;  // by material
    std::vector<Triangle> kept;
    for (const std::vector<uint32_t>& body : bodies.all()) {
      const Sheet sheet = bodies.is_closed(body) ? sheet_in(scene.meshes[i], body) : Sheet{};
      if (!sheet.triangles.empty()) add_sheet(sheet, panes[sheets.of(material, sheet.thickness)]);
      if (sheet.triangles.empty())
        for (const uint32_t t : body) kept.push_back(scene.meshes[i].triangles[t]);
    }
    if (panes.empty()) continue;
    const std::string name = scene.meshes[i].name;
    bool is_free = kept.empty();  // the mesh's slot can be reused
    if (!is_free) scene.meshes[i].triangles = std::move(kept);
    for (auto& [pane_material, mesh] : panes) {
      mesh.name = name;
      mesh.material = pane_material;
      if (is_free)
        scene.meshes[i] = std::move(mesh);
      else
        scene.meshes.push_back(std::move(mesh));
      is_free = false;
    }
  }
}

}  // namespace troffer
