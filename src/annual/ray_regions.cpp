#include "annual/ray_regions.h"

#include <algorithm>
#include <cmath>

#include "base/hasher.h"
#include "base/simd.h"
#include "scene/mesh_in_world.h"

namespace troffer {

namespace {

// Boxes are wider than what they hold by this much, plus a share of their coordinates, so that rays
// that touch a surface count as crossing.
constexpr float margin_m = 1e-3f, margin_share = 1e-5f;
// Boxes are merged if the area of the merged box is at most so many times that of both: a few more
// rays meet it, but each ray is compared with fewer boxes.
constexpr float most_of_areas = 1.3f;
// Boxes kept while others are added.
constexpr size_t most_open = 24;

void add_value(Hasher& h, uint64_t v) {
  h.add(v);
}
void add_value(Hasher& h, float v) {
  h.add(v);
}
void add_value(Hasher& h, const Rgb& v) {
  h.add(v);
}
void add_value(Hasher& h, const ColorInput& in) {
  h.add(in.value);
  h.add(in.texture);
}
void add_value(Hasher& h, const FloatInput& in) {
  h.add_all(in.value, in.texture, in.channel);
}

uint64_t look_of(const Material& m) {
  Hasher h(3);
  for_each_value(m, [&](const auto& v) { add_value(h, v); });
  h.add_all(m.normal_texture, m.normal_scale, m.bump.value, m.bump.texture, m.bump.channel,
            m.has_coat_normal, m.coat_normal_texture, m.coat_normal_scale, m.is_mirror_pane);
  return h.value();
}

float area_of(const Box& b) {
  const Vec3 e = b.extent();
  return e.x * e.y + e.y * e.z + e.z * e.x;
}

Box joined(Box a, const Box& b) {
  a.grow(b);
  return a;
}

// True if a box around both is hardly larger than they are.
bool are_neighbours(const Box& a, const Box& b) {
  return area_of(joined(a, b)) <= most_of_areas * (area_of(a) + area_of(b));
}

// Merges the two boxes whose merging adds least area; only neighbours, unless it must. Returns
// false if it did not.
bool merge_two(std::vector<Box>& boxes, bool must) {
  if (boxes.size() < 2) return false;
  size_t first = 0, second = 1;
  float least = std::numeric_limits<float>::infinity();
  for (size_t i = 0; i < boxes.size(); ++i)
    for (size_t k = i + 1; k < boxes.size(); ++k) {
      const float more =
          area_of(joined(boxes[i], boxes[k])) - area_of(boxes[i]) - area_of(boxes[k]);
      if (!(more < least)) continue;
      least = more;
      first = i;
      second = k;
    }
  if (!must && !are_neighbours(boxes[first], boxes[second])) return false;
  boxes[first].grow(boxes[second]);
  boxes.erase(boxes.begin() + std::ptrdiff_t(second));
  return true;
}

// Sets out[i] to 1 if a ray meets box i. inverse: of the direction, finite.
TROFFER_MULTIVERSION
void meet_boxes(const float* const* sides, size_t n, const float* origin, const float* inverse,
                uint8_t* out) {
  for (size_t i = 0; i < n; ++i) {
    float near = 0, far = std::numeric_limits<float>::max();
    for (size_t a = 0; a < 3; ++a) {
      const float t = (sides[a][i] - origin[a]) * inverse[a];
      const float u = (sides[a + 3][i] - origin[a]) * inverse[a];
      const float low = t < u ? t : u, high = t < u ? u : t;
      near = near > low ? near : low;
      far = far < high ? far : high;
    }
    out[i] = near <= far ? 1 : 0;
  }
}

float inverse_of(float d) {
  constexpr float least = 1e-12f;
  return 1 / (std::abs(d) > least ? d : std::copysign(least, d));
}

}  // namespace

SceneSurfaces::SceneSurfaces(const Scene& scene)
    : origin_(scene.origin), textures_(scene.textures.size()) {
  std::vector<uint64_t> materials;
  for (const Material& m : scene.materials) materials.push_back(look_of(m));
  add_meshes(scene, materials);
  add_shapes(scene, materials);
  std::sort(surfaces_.begin(), surfaces_.end(),
            [](const Surface& a, const Surface& b) { return a.first < b.first; });
}

void SceneSurfaces::add_meshes(const Scene& scene, std::span<const uint64_t> materials) {
  for_each_mesh(scene, [&](uint32_t, const MeshInWorld& mesh) {
    const Mesh& m = mesh.mesh();
    for (size_t t = 0; t < mesh.size(); ++t) {
      Hasher h(4);
      h.add(materials[m.material]);
      Box box;
      const std::array<Vec3, 3> corners = mesh.corners(t);
      const Triangle vertices = mesh.triangle(t);
      for (size_t k = 0; k < 3; ++k) {
        h.add(corners[k]);
        box.grow(corners[k]);
        if (!m.normals.empty()) h.add(mesh.normal(vertices[k]));
        if (!m.uvs.empty()) h.add(m.uvs[vertices[k]]);
        if (!m.uvs_2.empty()) h.add(m.uvs_2[vertices[k]]);
      }
      surfaces_.emplace_back(h.value(), box);
    }
  });
}

void SceneSurfaces::add_shapes(const Scene& scene, std::span<const uint64_t> materials) {
  const auto add = [&](const Hasher& h, const Vec3& centre, float radius) {
    surfaces_.emplace_back(h.value(), Box{centre - Vec3(radius), centre + Vec3(radius)});
  };
  for (const Sphere& s : scene.spheres) {
    Hasher h(5);
    h.add_all(materials[s.material], s.centre, s.radius, s.is_inside_out);
    add(h, s.centre, s.radius);
  }
  for (const Disk& d : scene.disks) {
    Hasher h(6);
    h.add_all(materials[d.material], d.centre, d.normal, d.radius);
    add(h, d.centre, d.radius);
  }
}

std::optional<std::vector<Box>> SceneSurfaces::boxes_of_change(const SceneSurfaces& other) const {
  if (origin_ != other.origin_ || textures_ != other.textures_) return {};
  std::vector<Box> boxes;
  const std::vector<Surface>&a = surfaces_, &b = other.surfaces_;
  for (size_t i = 0, k = 0; i < a.size() || k < b.size();) {
    if (i < a.size() && k < b.size() && a[i].first == b[k].first) {
      ++i;
      ++k;
    } else if (k == b.size() || (i < a.size() && a[i].first < b[k].first)) {
      boxes.push_back(a[i++].second);
    } else {
      boxes.push_back(b[k++].second);
    }
  }
  return boxes;
}

std::vector<Box> few_boxes(std::span<const Box> boxes, size_t most) {
  std::vector<Box> few;
  for (const Box& b : boxes) {
    const auto at =
        std::find_if(few.begin(), few.end(), [&](const Box& f) { return are_neighbours(f, b); });
    if (at != few.end())
      at->grow(b);
    else
      few.push_back(b);
    if (few.size() > most_open) merge_two(few, true);
  }
  while (merge_two(few, few.size() > most)) {
  }
  return few;
}

bool ends_all_walks(const Scene& scene) {
  const auto is_matte = [&](uint32_t material) {
    return scene.materials[material].kind == MaterialKind::diffuse;
  };
  bool ends = true;
  for_each_mesh(scene, [&](uint32_t, const MeshInWorld& mesh) {
    ends = ends && is_matte(mesh.mesh().material);
  });
  for (const Sphere& s : scene.spheres) ends = ends && is_matte(s.material);
  for (const Disk& d : scene.disks) ends = ends && is_matte(d.material);
  return ends;
}

void RayRegions::add(std::span<const Box> boxes) {
  for (const Box& b : boxes) {
    const Vec3 reach = max(abs(b.lower), abs(b.upper));
    for (size_t a = 0; a < 3; ++a) {
      const float margin = margin_m + margin_share * reach[a];
      sides_[a].push_back(b.lower[a] - margin);
      sides_[a + 3].push_back(b.upper[a] + margin);
    }
    region_of_.push_back(uint32_t(regions_));
  }
  ++regions_;
}

void RayRegions::find(const Ray& ray, std::vector<uint32_t>& out) const {
  const size_t n = region_of_.size();
  if (n == 0) return;
  std::array<const float*, 6> sides{};
  for (size_t a = 0; a < 6; ++a) sides[a] = sides_[a].data();
  const std::array<float, 3> origin{ray.origin.x, ray.origin.y, ray.origin.z};
  const std::array<float, 3> inverse{inverse_of(ray.direction.x), inverse_of(ray.direction.y),
                                     inverse_of(ray.direction.z)};
  constexpr size_t at_a_time = 256;
  std::array<uint8_t, at_a_time> met;
  for (size_t first = 0; first < n; first += at_a_time) {
    const size_t count = std::min(at_a_time, n - first);
    meet_boxes(sides.data(), count, origin.data(), inverse.data(), met.data());
    for (size_t i = 0; i < count; ++i) {
      const uint32_t region = region_of_[first + i];
      if (met[i] != 0 && (out.empty() || out.back() != region)) out.push_back(region);
    }
    for (const float*& s : sides) s += count;
  }
}

RayRegions RayRegions::widened(float margin) const {
  RayRegions wide = *this;
  for (size_t a = 0; a < 6; ++a)
    for (float& side : wide.sides_[a]) side += a < 3 ? -margin : margin;
  return wide;
}

bool RayRegions::holds(size_t region, const Vec3& point, float margin) const {
  for (size_t i = 0; i < region_of_.size(); ++i) {
    bool is_in = region_of_[i] == region;
    for (size_t a = 0; a < 3; ++a)
      is_in = is_in && point[a] >= sides_[a][i] - margin && point[a] <= sides_[a + 3][i] + margin;
    if (is_in) return true;
  }
  return false;
}

}  // namespace troffer
