#include "import/vertex_paint.h"

#include <algorithm>
#include <cmath>

#include "import/mesh_clean.h"

namespace troffer {

namespace {

// Limit for all images together: about a gigabyte.
constexpr uint64_t max_texels = uint64_t(1) << 26;

float unit(float v) {
  return v >= 0 ? std::min(v, 1.0f) : v < 0 ? 0.0f : 1.0f;  // 1 for NaN
}

TextureValue usable(const TextureValue& c) {
  return {{unit(c.rgb.r), unit(c.rgb.g), unit(c.rgb.b)}, unit(c.alpha)};
}

bool are_equal(const TextureValue& a, const TextureValue& b) {
  return a.rgb == b.rgb && a.alpha == b.alpha;
}

TextureValue mean_over(const Mesh& mesh, const std::vector<TextureValue>& colors) {
  std::array<double, 4> sum{};
  double total = 0;
  for (const Triangle& t : mesh.triangles) {
    const double area = length(area_vector(mesh, t));
    total += 3 * area;
    for (const uint32_t v : t) {
      const TextureValue c = usable(colors[v]);
      for (size_t k = 0; k < 3; ++k) sum[k] += area * double(c.rgb[k]);
      sum[3] += area * double(c.alpha);
    }
  }
  if (!(total > 0)) return {};
  return {{float(sum[0] / total), float(sum[1] / total), float(sum[2] / total)},
          float(sum[3] / total)};
}

bool has_alpha(const Mesh& mesh, const std::vector<TextureValue>& colors) {
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
    return std::any_of(t.begin(), t.end(), [&](uint32_t v) { return unit(colors[v].alpha) < 1; });
  });
}

// Gives every triangle vertices of its own.
void separate_triangles(Mesh& mesh) {
  std::vector<Vec3> positions, normals;
  std::vector<Vec2> uvs, uvs_2;
  positions.reserve(3 * mesh.triangles.size());
  for (Triangle& t : mesh.triangles) {
    for (uint32_t& v : t) {
      positions.push_back(mesh.positions[v]);
      if (!mesh.normals.empty()) normals.push_back(mesh.normals[v]);
      if (!mesh.uvs.empty()) uvs.push_back(mesh.uvs[v]);
      if (!mesh.uvs_2.empty()) uvs_2.push_back(mesh.uvs_2[v]);
      v = uint32_t(positions.size() - 1);
    }
  }
  mesh.positions = std::move(positions);
  mesh.normals = std::move(normals);
  mesh.uvs = std::move(uvs);
  mesh.uvs_2 = std::move(uvs_2);
}

bool uses_second_uvs(const Scene& scene, const Material& m) {
  bool is_any = false;
  const auto look = [&](int32_t texture) {
    is_any |= texture >= 0 && scene.textures[size_t(texture)].mapping == TextureMapping::second_uv;
  };
  look(m.normal_texture);
  look(m.coat_normal_texture);
  for_each_input(m, [&](const auto& input) { look(input.texture); });
  return is_any;
}

}  // namespace

uint32_t VertexPainter::tinted(uint32_t material, const TextureValue& factor) {
  if (are_equal(factor, {})) return material;
  const std::array<float, 4> key{factor.rgb.r, factor.rgb.g, factor.rgb.b, factor.alpha};
  const auto known = tinted_.find({material, key});
  if (known != tinted_.end()) return known->second;
  Material m = scene_.materials[material];
  m.base_color.value *= factor.rgb;
  m.alpha.value *= factor.alpha;
  scene_.materials.push_back(std::move(m));
  return tinted_[{material, key}] = uint32_t(scene_.materials.size() - 1);
}

// Adds the image of a mesh's colours and a material that uses it. `with_uvs`: the mesh keeps its
// (u,v), and the image multiplies the other textures.
uint32_t VertexPainter::add_image(Mesh& mesh, const std::vector<TextureValue>& colors,
                                  bool with_uvs) {
  Material m = scene_.materials[mesh.material];
  Texture image;
  image.name = "colours of the vertices of '" + mesh.name + "'";
  image.kind = TextureKind::image;
  image.is_srgb = false;
  image.wrap_u = image.wrap_v = WrapMode::clamp;
  image.channels = m.is_alpha_masked && !with_uvs ? 4 : 3;
  if (with_uvs) image.mapping = TextureMapping::second_uv;
  const size_t n = mesh.triangles.size();
  const auto columns = size_t(std::ceil(std::sqrt(double(n)))), rows = (n + columns - 1) / columns;
  image.width = int(2 * columns);
  image.height = int(2 * rows);
  const auto channels = size_t(image.channels);
  image.texels_float.resize(4 * columns * rows * channels);
  std::vector<Vec2> uvs;
  uvs.reserve(3 * n);
  for (size_t i = 0; i < n; ++i) {
    const size_t x = 2 * (i % columns), y = 2 * (i / columns);
    const std::array<TextureValue, 3> c{usable(colors[mesh.triangles[i][0]]),
                                        usable(colors[mesh.triangles[i][1]]),
                                        usable(colors[mesh.triangles[i][2]])};
    const auto put = [&](size_t dx, size_t dy, const Rgb& rgb, float alpha) {
      float* const texel =
          &image.texels_float[((y + dy) * size_t(image.width) + x + dx) * channels];
      for (size_t k = 0; k < 3; ++k) texel[k] = rgb[k];
      if (channels == 4) texel[3] = alpha;
    };
    put(0, 0, c[0].rgb, c[0].alpha);
    put(1, 0, c[1].rgb, c[1].alpha);
    put(0, 1, c[2].rgb, c[2].alpha);
    // This value makes the mixed term of the bilinear interpolation vanish.
    put(1, 1, c[1].rgb + c[2].rgb - c[0].rgb, c[1].alpha + c[2].alpha - c[0].alpha);
    for (const auto& [dx, dy] : {std::pair{0.5, 0.5}, {1.5, 0.5}, {0.5, 1.5}})
      uvs.emplace_back(float((double(x) + dx) / double(image.width)),
                       float((double(y) + dy) / double(image.height)));
  }
  separate_triangles(mesh);
  (with_uvs ? mesh.uvs_2 : mesh.uvs) = std::move(uvs);
  auto texture = int32_t(scene_.textures.size());
  scene_.textures.push_back(std::move(image));
  if (with_uvs && m.base_color.texture >= 0) {
    Texture both;
    both.name = "colours of the vertices on an image";
    both.kind = TextureKind::product;
    both.factor_a = uint32_t(m.base_color.texture);
    both.factor_b = uint32_t(texture++);
    scene_.textures.push_back(std::move(both));
  }
  m.base_color.texture = texture;
  if (m.is_alpha_masked && !with_uvs) m.alpha = {m.alpha.value, texture, 3};
  scene_.materials.push_back(std::move(m));
  return uint32_t(scene_.materials.size() - 1);
}

// Returns a copy of the material with alpha blending, or the material itself if it has alpha
// already.
uint32_t VertexPainter::blended(uint32_t material) {
  if (scene_.materials[material].is_alpha_masked) return material;
  const auto [known, is_new] = blended_.emplace(material, uint32_t(scene_.materials.size()));
  if (is_new) {
    Material m = scene_.materials[material];
    m.is_alpha_masked = m.is_alpha_blended = true;
    m.alpha = {1, no_texture, 3};
    scene_.materials.push_back(std::move(m));
  }
  return known->second;
}

void VertexPainter::paint(Mesh& mesh, const std::vector<TextureValue>& colors, bool needs_uvs,
                          bool is_blended) {
  if (colors.empty() || colors.size() != mesh.positions.size() || mesh.triangles.empty()) return;
  if (is_blended && has_alpha(mesh, colors)) mesh.material = blended(mesh.material);
  const TextureValue first = usable(colors[mesh.triangles[0][0]]);
  const bool is_one = std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](auto& t) {
    return std::all_of(t.begin(), t.end(),
                       [&](uint32_t v) { return are_equal(usable(colors[v]), first); });
  });
  if (is_one) {
    mesh.material = tinted(mesh.material, first);
    return;
  }
  const Material& m = scene_.materials[mesh.material];
  const bool is_textured = needs_uvs || has_textured_input(m) || m.normal_texture >= 0 ||
                           has_own_coat_normal(m) || m.alpha.texture >= 0;
  const bool is_second_free = mesh.uvs_2.empty() && !uses_second_uvs(scene_, m);
  if ((is_textured && !is_second_free) || 4 * mesh.triangles.size() > max_texels - texels_) {
    scene_.warnings.add(is_textured && !is_second_free
                            ? "vertex colours of meshes with two sets of texture coordinates are "
                              "shown as their mean"
                            : "too many coloured vertices: the mean of each mesh is shown");
    mesh.material = tinted(mesh.material, mean_over(mesh, colors));
    return;
  }
  texels_ += 4 * mesh.triangles.size();
  if (is_textured && m.is_alpha_masked) {
    const TextureValue mean = mean_over(mesh, colors);
    if (mean.alpha < 1) {
      scene_.warnings.add("vertex alpha of textured meshes is shown as its mean");
      mesh.material = tinted(mesh.material, {Rgb{1}, mean.alpha});
    }
  }
  mesh.material = add_image(mesh, colors, is_textured);
}

}  // namespace troffer
