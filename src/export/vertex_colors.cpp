#include "export/vertex_colors.h"

#include <algorithm>
#include <cmath>

#include "export/texture_look.h"

namespace troffer {

namespace {

// Collects the images within a texture.
void collect(const Scene& scene, int32_t texture, std::vector<int32_t>& images) {
  if (texture < 0) return;
  const Texture& t = scene.textures[size_t(texture)];
  if (t.kind == TextureKind::image) images.push_back(texture);
  if (t.kind != TextureKind::product) return;
  collect(scene, int32_t(t.factor_a), images);
  collect(scene, int32_t(t.factor_b), images);
}

bool is_second(const Scene& scene, int32_t texture) {
  return scene.textures[size_t(texture)].mapping == TextureMapping::second_uv;
}

const std::vector<Vec2>& uvs_of(const Mesh& mesh, bool second) {
  return second ? mesh.uvs_2 : mesh.uvs;
}

bool is_near(const TextureValue& a, const TextureValue& b) {
  constexpr float most = 2e-5f;
  for (size_t k = 0; k < 3; ++k)
    if (!(std::abs(a.rgb[k] - b.rgb[k]) <= most)) return false;
  return std::abs(a.alpha - b.alpha) <= most;
}

bool is_unit(const TextureValue& v) {
  constexpr float most = 1 + 1e-5f, least = -1e-5f;
  return std::min({v.rgb.r, v.rgb.g, v.rgb.b, v.alpha}) >= least &&
         std::max({v.rgb.r, v.rgb.g, v.rgb.b, v.alpha}) <= most;
}

TextureValue between(const TextureValue& a, const TextureValue& b) {
  return {(a.rgb + b.rgb) * 0.5f, (a.alpha + b.alpha) * 0.5f};
}

// True if the corners lie at texel centres of one 2 × 2 block, over which bilinear interpolation is
// linear.
bool is_linear_over(const Scene& scene, int32_t texture, const std::array<Vec2, 3>& uv) {
  constexpr float off = 0.02f;  // texels
  const Texture& t = scene.textures[size_t(texture)];
  std::array<int, 3> column{}, row{};
  for (size_t k = 0; k < 3; ++k) {
    const Vec2 at = place_in_image(t, uv[k]);
    const float x = at.x * float(t.width) - 0.5f, y = at.y * float(t.height) - 0.5f;
    column[k] = int(std::lround(std::clamp(x, -1e6f, 1e6f)));
    row[k] = int(std::lround(std::clamp(y, -1e6f, 1e6f)));
    if (!(std::abs(x - float(column[k])) < off && std::abs(y - float(row[k])) < off)) return false;
    if (column[k] < 0 || row[k] < 0 || column[k] >= t.width || row[k] >= t.height) return false;
  }
  const auto span = [](const std::array<int, 3>& v) {
    const auto [low, high] = std::minmax_element(v.begin(), v.end());
    return *high - *low;
  };
  if (span(column) > 1 || span(row) > 1) return false;
  std::array<TextureValue, 3> corner;
  for (size_t k = 0; k < 3; ++k) {
    corner[k] = evaluate(scene.textures, uint32_t(texture), TexturePlace(uv[k], uv[k]));
    if (!is_unit(corner[k])) return false;
  }
  for (size_t k = 0; k < 3; ++k) {
    const Vec2 middle = (uv[k] + uv[(k + 1) % 3]) * 0.5f;
    const TextureValue v =
        evaluate(scene.textures, uint32_t(texture), TexturePlace(middle, middle));
    if (!is_near(v, between(corner[k], corner[(k + 1) % 3]))) return false;
  }
  return true;
}

bool is_linear(const Scene& scene, const Mesh& mesh, int32_t texture) {
  const Texture& t = scene.textures[size_t(texture)];
  const std::vector<Vec2>& uvs = uvs_of(mesh, is_second(scene, texture));
  if (!t.is_filtered || uvs.size() != mesh.positions.size() || mesh.triangles.empty()) return false;
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& v) {
    return is_linear_over(scene, texture, {uvs[v[0]], uvs[v[1]], uvs[v[2]]});
  });
}

// Returns the texture without one of its direct factors.
int32_t without(const Scene& scene, int32_t texture, int32_t factor) {
  if (texture == factor) return no_texture;
  if (texture < 0 || scene.textures[size_t(texture)].kind != TextureKind::product) return texture;
  const Texture& t = scene.textures[size_t(texture)];
  if (int32_t(t.factor_a) == factor) return int32_t(t.factor_b);
  if (int32_t(t.factor_b) == factor) return int32_t(t.factor_a);
  return texture;
}

TextureValue mean_over(const Scene& scene, const Mesh& mesh, int32_t texture) {
  const std::vector<Vec2>& uvs = uvs_of(mesh, is_second(scene, texture));
  Vec3d sum;
  double alpha = 0, total = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d p(mesh.positions[t[0]]);
    const double area =
        length(cross(Vec3d(mesh.positions[t[1]]) - p, Vec3d(mesh.positions[t[2]]) - p));
    for (const uint32_t v : t) {
      if (v >= uvs.size()) continue;
      const TextureValue c =
          evaluate(scene.textures, uint32_t(texture), TexturePlace(uvs[v], uvs[v]));
      sum += Vec3d(double(c.rgb.r), double(c.rgb.g), double(c.rgb.b)) * area;
      alpha += double(c.alpha) * area;
      total += area;
    }
  }
  if (!(total > 0)) return {};
  return {{float(sum.x / total), float(sum.y / total), float(sum.z / total)}, float(alpha / total)};
}

}  // namespace

int32_t vertex_color_texture(const Scene& scene, const Mesh& mesh) {
  const int32_t base = scene.materials[mesh.material].base_color.texture;
  if (base < 0) return no_texture;
  const Texture& t = scene.textures[size_t(base)];
  std::vector<int32_t> candidates;
  if (t.kind == TextureKind::image)
    candidates = {base};
  else if (t.kind == TextureKind::product)
    candidates = {int32_t(t.factor_b), int32_t(t.factor_a)};
  for (const int32_t c : candidates)
    if (scene.textures[size_t(c)].kind == TextureKind::image && is_linear(scene, mesh, c)) return c;
  return no_texture;
}

std::vector<TextureValue> colors_of_vertices(const Scene& scene, const Mesh& mesh,
                                             int32_t texture) {
  const std::vector<Vec2>& uvs = uvs_of(mesh, is_second(scene, texture));
  std::vector<TextureValue> colors;
  colors.reserve(uvs.size());
  for (const Vec2& uv : uvs) {
    const TextureValue v = evaluate(scene.textures, uint32_t(texture), TexturePlace(uv, uv));
    colors.push_back({clamp01(v.rgb), std::clamp(v.alpha, 0.0f, 1.0f)});
  }
  return colors;
}

Material without_vertex_colors(const Scene& scene, Material m, int32_t texture) {
  m.base_color.texture = without(scene, m.base_color.texture, texture);
  if (m.alpha.channel == 3) m.alpha.texture = without(scene, m.alpha.texture, texture);
  return m;
}

bool uses_uv_set(const Scene& scene, const Material& m, const Light* light, bool second) {
  std::vector<int32_t> images;
  for_each_input(m, [&](const auto& input) { collect(scene, input.texture, images); });
  for (const int32_t t :
       {m.normal_texture, m.coat_normal_texture, m.bump.texture,
        m.is_alpha_masked ? m.alpha.texture : no_texture, light ? light->texture : no_texture})
    collect(scene, t, images);
  return std::any_of(images.begin(), images.end(),
                     [&](int32_t t) { return is_second(scene, t) == second; });
}

void flatten_second_sets(Scene& scene, bool keeps_vertex_colors, WarningLog& warnings) {
  const auto flatten = [&](Mesh& mesh) {
    const ColorInput base = scene.materials[mesh.material].base_color;
    if (base.texture < 0) return;
    const Texture& t = scene.textures[size_t(base.texture)];
    if (t.kind != TextureKind::product) return;
    std::vector<int32_t> a, b;
    collect(scene, int32_t(t.factor_a), a);
    collect(scene, int32_t(t.factor_b), b);
    if (a.size() != 1 || b.size() != 1 || is_second(scene, a[0]) == is_second(scene, b[0])) return;
    if (keeps_vertex_colors && vertex_color_texture(scene, mesh) != no_texture) return;
    const int32_t second = is_second(scene, a[0]) ? a[0] : b[0];
    const TextureValue mean = mean_over(scene, mesh, second);
    Material m = without_vertex_colors(scene, scene.materials[mesh.material], second);
    m.base_color.value *= mean.rgb;
    mesh.material = uint32_t(scene.materials.size());
    scene.materials.push_back(std::move(m));
    warnings.add(
        "vertex colours, or an image on a second set of texture coordinates, that multiply another "
        "image are written as their mean over each mesh");
  };
  for (Mesh& m : scene.meshes) flatten(m);
  for (Mesh& m : scene.instanced_meshes) flatten(m);
}

void flatten_round_shapes(Scene& scene) {
  const auto flat = [&](uint32_t material) {
    Material m = scene.materials[material];
    bool is_changed = false;
    const auto change = [&](auto& input) {
      if (!has_image(scene, input.texture)) return;
      input.value = evaluate(scene.textures, input, Vec2{0, 0});
      input.texture = no_texture;
      is_changed = true;
    };
    for_each_input(m, [&](const auto& input) {
      change(const_cast<std::remove_cvref_t<decltype(input)>&>(input));
    });
    change(m.alpha);
    if (!is_changed) return material;
    m.normal_texture = m.coat_normal_texture = m.bump.texture = no_texture;
    scene.materials.push_back(std::move(m));
    return uint32_t(scene.materials.size() - 1);
  };
  for (Sphere& s : scene.spheres) s.material = flat(s.material);
  for (Disk& d : scene.disks) d.material = flat(d.material);
}

}  // namespace troffer
