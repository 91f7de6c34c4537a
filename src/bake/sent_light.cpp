#include "bake/sent_light.h"

#include <algorithm>
#include <cmath>

#include "bake/flat_triangles.h"

namespace troffer {

namespace {

Rgb reflectance_of_metal(const Material& m) {
  const Rgb one{1}, below = m.eta - one, above = m.eta + one, k2 = m.k * m.k;
  return (below * below + k2) / (above * above + k2);
}

// Texture coordinates at a place on a page, and their change per texel.
struct Look {
  Vec2 at, along_x, along_y;
};
Look look_at(const std::array<Vec2, 3>& uv, const FlatTriangle& flat, const Vec2d& where) {
  const double all = doubled_area(flat);
  const auto uv_at = [&](const Vec2d& p) {
    const double a = doubled_area({p, flat[1], flat[2]}) / all;
    const double b = doubled_area({flat[0], p, flat[2]}) / all;
    return Vec2d(uv[0]) * a + Vec2d(uv[1]) * b + Vec2d(uv[2]) * (1 - a - b);
  };
  const Vec2d middle = uv_at(where);
  return {Vec2(middle), Vec2(uv_at(where + Vec2d{1, 0}) - middle),
          Vec2(uv_at(where + Vec2d{0, 1}) - middle)};
}

}  // namespace

PageTexel SentLight::base(const BakedSurfaces& surfaces, const Atlas& atlas,
                          const TexelSites& sites, size_t site) const {
  const TexelSites::Texel& texel = sites.texels()[site];
  const Stand& stand = surfaces.stands[texel.stand];
  const Mesh& mesh = surfaces.charted[stand.charted].mesh;
  const Material& m = surfaces.scene.materials[mesh.material];
  const MeshInWorld in_world = surfaces.mesh(stand);
  Rgb color{0};
  double alpha = 0, weights = 0;
  for (const uint32_t t : sites.triangles_of(site)) {
    const Triangle& v = mesh.triangles[t];
    const std::vector<Vec2>& at = atlas.texel_of_vertex[texel.stand];
    const FlatTriangle flat{Vec2d(at[v[0]]), Vec2d(at[v[1]]), Vec2d(at[v[2]])};
    const FlatPolygon p = in_square(flat, texel.x, texel.y, texel.x + 1, texel.y + 1);
    const double weight = p.area();
    if (!(weight > 0)) continue;
    Vec2d middle;
    for (size_t k = 0; k < p.size; ++k) middle = middle + p.corners[k] * (1.0 / double(p.size));
    TexturePlace place;
    const auto set = [&](const std::vector<Vec2>& uvs, Vec2& uv, Vec2& x, Vec2& y) {
      if (uvs.empty()) return;
      const Look look = look_at({uvs[v[0]], uvs[v[1]], uvs[v[2]]}, flat, middle);
      uv = look.at, x = look.along_x, y = look.along_y;
    };
    set(mesh.uvs, place.uv, place.axis_a, place.axis_b);
    set(mesh.uvs_2, place.uv_2, place.axis_2a, place.axis_2b);
    place.position =
        (in_world.position(v[0]) + in_world.position(v[1]) + in_world.position(v[2])) / 3.0f;
    const bool is_metal = m.kind == MaterialKind::conductor && !m.is_reflectance;
    const Rgb base = evaluate(scene_.textures, is_metal ? m.specular_color : m.base_color, place) *
                     (is_metal ? reflectance_of_metal(m) : Rgb{1});
    const float there = m.is_alpha_masked ? coverage(scene_.textures, m, place) : 1.0f;
    color += clamp01(base) * float(weight);
    alpha += double(there) * weight;
    weights += weight;
  }
  if (!(weights > 0)) return {};
  return {color / float(weights), float(alpha / weights), 0};
}

}  // namespace troffer
