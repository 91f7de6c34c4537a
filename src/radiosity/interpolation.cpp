#include "radiosity/interpolation.h"

#include <algorithm>
#include <cmath>

namespace troffer {

namespace {

constexpr float cos_smooth = 0.8660254f;  // 30 degrees
constexpr uint32_t max_around = 64;       // limit on the fragments considered around a corner

// Adds `weight`, shared among the elements around a corner of a fragment; `own` is the fragment's
// own point.
void add_corner(const RadiosityMesh& mesh, uint32_t fragment, size_t corner, bool is_back,
                uint32_t own, float weight, Interpolation& out) {
  const Vec3 normal = fragment_normal(mesh, fragment);
  const uint32_t vertex = mesh.fragments[fragment].vertices[corner];
  const uint32_t first = mesh.vertex_first[vertex];
  const uint32_t last = std::min(mesh.vertex_first[vertex + 1], first + max_around);
  struct Around {
    uint32_t point;
    float area;
  } around[max_around];
  uint32_t count = 0;
  float sum = 0;
  for (uint32_t i = first; i < last; ++i) {
    const uint32_t f = mesh.vertex_fragments[i];
    const auto& c = mesh.fragments[f].vertices;
    const Vec3 a = mesh.geometry.positions[c[0]];
    const Vec3 n = cross(mesh.geometry.positions[c[1]] - a, mesh.geometry.positions[c[2]] - a);
    const float area = length(n), cosine = dot(n, normal);
    if (!(std::abs(cosine) >= cos_smooth * area) || !(area > 0)) continue;
    const bool is_other_side = is_back != (cosine < 0);
    const uint32_t p = mesh.element_points[mesh.fragments[f].element][is_other_side ? 1 : 0];
    if (p == no_point) continue;
    around[count++] = {p, area};
    sum += area;
  }
  if (!(sum > 0)) out.add(own, weight);
  for (uint32_t i = 0; i < count && sum > 0; ++i)
    out.add(around[i].point, weight * around[i].area / sum);
}

// True if the sample point lies at the centre of the fragment, which then is the whole element.
bool is_in_the_middle(const RadiosityMesh& mesh, uint32_t fragment, uint32_t point) {
  const auto& c = mesh.fragments[fragment].vertices;
  const std::vector<Vec3>& p = mesh.geometry.positions;
  const Vec3 middle = (p[c[0]] + p[c[1]] + p[c[2]]) / 3.0f;
  // the sample point of a round surface lies above the fragment
  const float close = 0.1f * std::min({length(p[c[0]] - middle), length(p[c[1]] - middle),
                                       length(p[c[2]] - middle)});
  return length(mesh.points[point].position - middle) <= close;
}

void add_knot(const RadiosityMesh& mesh, uint32_t fragment, size_t knot, bool is_back, uint32_t own,
              float weight, Interpolation& out) {
  if (knot < 3) {
    add_corner(mesh, fragment, knot, is_back, own, weight, out);
  } else if (is_in_the_middle(mesh, fragment, own)) {
    out.add(own, weight);
  } else {
    for (size_t k = 0; k < 3; ++k) add_corner(mesh, fragment, k, is_back, own, weight / 3, out);
  }
}

}  // namespace

void Interpolation::add(uint32_t point, float weight) {
  for (PointWeight& w : weights_) {
    if (w.point != point) continue;
    w.weight += weight;
    return;
  }
  weights_.push_back({point, weight});
}

void interpolate(const Scene& scene, const RadiosityMesh& mesh, uint32_t geometry,
                 uint32_t primitive, float u, float v, const Vec3& position, bool is_back,
                 Interpolation& out) {
  out.clear();
  Vec3 corner_weights;
  const uint32_t at =
      fragment_at(scene, mesh, geometry, primitive, u, v, position, is_back, corner_weights);
  if (at == no_fragment) return;
  const uint32_t own = mesh.element_points[mesh.fragments[at].element][is_back ? 1 : 0];
  if (own == no_point) return;
  for (size_t k = 0; k < 3; ++k) corner_weights[k] = std::clamp(corner_weights[k], 0.0f, 1.0f);
  const auto weights = knot_weights(corner_weights);
  for (size_t k = 0; k < knots_per_fragment; ++k)
    if (weights[k] > 0) add_knot(mesh, at, k, is_back, own, weights[k], out);
}

void interpolate_at_knot(const RadiosityMesh& mesh, uint32_t fragment, size_t knot, bool is_back,
                         Interpolation& out) {
  out.clear();
  const uint32_t own = mesh.element_points[mesh.fragments[fragment].element][is_back ? 1 : 0];
  if (own != no_point) add_knot(mesh, fragment, knot, is_back, own, 1, out);
}

}  // namespace troffer
