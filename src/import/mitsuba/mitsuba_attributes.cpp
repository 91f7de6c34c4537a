#include "import/mitsuba/mitsuba_attributes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace troffer {

namespace {

// Layout of an attribute's image: one square of 2 x 2 texels per triangle.
struct AttributeLayout {
  size_t columns, rows;
  explicit AttributeLayout(size_t n)
      : columns(std::max<size_t>(1, size_t(std::ceil(std::sqrt(double(n)))))),
        rows((n + columns - 1) / columns) {}
  // Centre of texel (dx, dy) of triangle i, in (u,v).
  Vec2 middle(size_t i, size_t dx, size_t dy) const {
    return {float((double(2 * (i % columns) + dx) + 0.5) / double(2 * columns)),
            float((double(2 * (i / columns) + dy) + 0.5) / double(2 * rows))};
  }
};

// Gives every triangle its own three vertices.
void give_own_vertices(Mesh& mesh) {
  Mesh out;
  const auto take = [](auto& to, const auto& from, uint32_t v) {
    if (!from.empty()) to.push_back(from[v]);
  };
  for (Triangle& t : mesh.triangles) {
    for (uint32_t& v : t) {
      out.positions.push_back(mesh.positions[v]);
      take(out.normals, mesh.normals, v);
      take(out.uvs, mesh.uvs, v);
      v = uint32_t(out.positions.size() - 1);
    }
  }
  mesh.positions = std::move(out.positions);
  mesh.normals = std::move(out.normals);
  mesh.uvs = std::move(out.uvs);
}

}  // namespace

void add_corner_uvs(Mesh& mesh) {
  give_own_vertices(mesh);
  mesh.uvs.clear();
  for (size_t i = 0; i < mesh.triangles.size(); ++i)
    mesh.uvs.insert(mesh.uvs.end(), {Vec2{0, 0}, Vec2{1, 0}, Vec2{0, 1}});
}

std::optional<int32_t> MitsubaAttributes::texture(const std::string& name) {
  if (!is_read_) attributes_ = read_ply_attributes(file_);
  is_read_ = true;
  for (const PlyAttribute& a : attributes_) {
    if (a.name != name || a.channels == 4) continue;
    ++uses_;
    const auto known = made_.find(name);
    return known != made_.end() ? known->second : made_[name] = make(a);
  }
  return std::nullopt;
}

int32_t MitsubaAttributes::make(const PlyAttribute& a) {
  const size_t n = triangles_.size(), channels = a.channels == 3 ? 3 : 1;
  const AttributeLayout layout(n);
  Texture image;
  image.name = "attribute '" + a.name + "'";
  image.kind = TextureKind::image;
  image.is_srgb = false;
  image.wrap_u = image.wrap_v = WrapMode::clamp;
  image.channels = int(channels);
  if (has_images_) image.mapping = TextureMapping::second_uv;
  image.width = int(2 * layout.columns);
  image.height = int(2 * layout.rows);
  image.texels_float.resize(4 * layout.columns * layout.rows * channels);
  for (size_t i = 0; i < n; ++i) {
    const auto at = [&](size_t corner, size_t k) {
      const size_t row = a.is_of_faces ? i : triangles_[i][corner];
      const size_t index = row * a.channels + k;
      return index < a.values.size() ? a.values[index] : 0.0f;
    };
    for (size_t k = 0; k < channels; ++k) {
      const auto texel = [&](size_t dx, size_t dy) -> float& {
        const size_t x = 2 * (i % layout.columns) + dx, y = 2 * (i / layout.columns) + dy;
        return image.texels_float[(y * size_t(image.width) + x) * channels + k];
      };
      texel(0, 0) = at(0, k);
      texel(1, 0) = at(1, k);
      texel(0, 1) = at(2, k);
      texel(1, 1) = at(1, k) + at(2, k) - at(0, k);  // makes the bilinear interpolation linear
    }
  }
  scene_.textures.push_back(std::move(image));
  return int32_t(scene_.textures.size()) - 1;
}

void MitsubaAttributes::finish(Mesh& mesh) {
  if (uses_ == 0 || is_finished_) return;
  is_finished_ = true;
  const AttributeLayout layout(mesh.triangles.size());
  give_own_vertices(mesh);
  std::vector<Vec2>& uvs = has_images_ ? mesh.uvs_2 : mesh.uvs;
  uvs.clear();
  for (size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const auto& [dx, dy] : {std::pair<size_t, size_t>{0, 0}, {1, 0}, {0, 1}})
      uvs.push_back(layout.middle(i, dx, dy));
}

}  // namespace troffer
