#include "scene/up_hints.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include "scene/mesh_in_world.h"
#include "scene/standing_objects.h"

namespace troffer {

namespace {

constexpr size_t directions = 6;  // +x, +y, +z, -x, -y, -z

Vec3 direction(size_t i) {
  Vec3 v{0};
  v[i % 3] = i < 3 ? 1.0f : -1.0f;
  return v;
}

// Weight by direction.
using Shares = std::array<double, directions>;

// Adds the weight to the axis within 18 degrees of the unit vector.
void add_along(const Vec3& v, double weight, Shares& shares) {
  for (size_t i = 0; i < directions; ++i)
    if (dot(v, direction(i)) > 0.95f) shares[i] += weight;
}

double total(const Shares& shares) {
  double sum = 0;
  for (const double s : shares) sum += s;
  return sum;
}

// Distributes `weight` by `shares` to hints. Shares below `least` of the total give none.
void add_hints(const Shares& shares, double weight, double least, const char* source,
               std::vector<UpHint>& hints) {
  const double all = total(shares);
  for (size_t i = 0; i < directions; ++i)
    if (all > 0 && shares[i] >= least * all)
      hints.push_back({direction(i), weight * shares[i] / all, source});
}

void add_skies(const Scene& scene, std::vector<UpHint>& hints) {
  Shares skies{}, images{};
  for (const Light& e : scene.lights) {
    if (e.kind == LightKind::sky) add_along(normalize(e.axes[2]), 1, skies);
    if (e.kind == LightKind::environment && e.environment != no_environment)
      add_along(normalize(e.axes[2]), 1, images);
  }
  add_hints(skies, 4, 0.5, "its sky", hints);
  add_hints(images, 2, 0.5, "the image of its surroundings", hints);
}

// The `right` vector of a level camera is perpendicular to up. If two axes remain, up is the one
// closer to the camera's up. A camera that looks along an axis may be looking down on a plan.
void add_cameras(const Scene& scene, std::vector<UpHint>& hints) {
  Shares shares{};
  double strength = 0;
  for (const Camera& c : scene.cameras) {
    size_t best = directions;
    for (size_t i = 0; i < directions; ++i) {
      if (std::abs(c.right[i % 3]) > 0.05f) continue;
      const float along = dot(c.up, direction(i));
      if (along > 0.1f && (best == directions || along > dot(c.up, direction(best)))) best = i;
    }
    if (best == directions) continue;
    const bool is_along_axis =
        std::max({std::abs(c.forward.x), std::abs(c.forward.y), std::abs(c.forward.z)}) > 0.999f;
    const bool is_steep = dot(c.up, direction(best)) < 0.8f;
    if (is_along_axis && best >= 3) continue;  // a plan: its up may point north
    const double weight = is_along_axis || is_steep ? 1.5 : 3;
    shares[best] += weight;
    strength = std::max(strength, weight);
  }
  add_hints(shares, strength, 0.2, scene.cameras.size() == 1 ? "its camera" : "its cameras", hints);
}

// True if a word of the name is in the list. Words are letters in lower case; "FloorPlane.001" has
// two.
bool has_word(const std::string& name, const std::vector<std::string_view>& words) {
  std::string word;
  const auto is_word = [&] { return std::find(words.begin(), words.end(), word) != words.end(); };
  bool was_lower = false;
  for (const char c : name) {
    const auto u = static_cast<unsigned char>(c);
    const bool is_letter = u < 128 && std::isalpha(u) != 0;
    const bool is_upper = is_letter && std::isupper(u) != 0;
    if (!is_letter || (is_upper && was_lower)) {
      if (is_word()) return true;
      word.clear();
    }
    if (is_letter) word += char(std::tolower(u));
    was_lower = is_letter && !is_upper;
  }
  return is_word();
}

bool is_floor(const std::string& name) {
  static const std::vector<std::string_view> words{
      "floor", "flooring", "ground",    "terrain", "boden", "fussboden", "suelo",
      "piso",  "plancher", "pavimento", "vloer",   "golv",  "podlaha"};
  return has_word(name, words);
}

bool is_ceiling(const std::string& name) {
  static const std::vector<std::string_view> words{"ceiling", "roof", "decke",   "plafond",
                                                   "techo",   "teto", "soffitto"};
  return has_word(name, words);
}

// Areas of triangles perpendicular to the axes, of one mesh or of many.
struct FlatAreas {
  double all = 0;
  std::array<double, 3> by_axis{};
  std::array<double, 6> at_side{};  // at a box's lower x, y, z and upper x, y, z sides

  void add(const std::array<Vec3, 3>& p, const Box& box, float tolerance, double weight) {
    const Vec3 n = cross(p[1] - p[0], p[2] - p[0]);
    const double area = 0.5 * double(length(n)) * weight;
    all += area;
    for (size_t a = 0; a < 3; ++a) {
      if (!(std::abs(n[a]) > 0.99f * length(n))) continue;
      by_axis[a] += area;
      const float at = (p[0][a] + p[1][a] + p[2][a]) / 3;
      if (at - box.lower[a] <= tolerance) at_side[a] += area;
      if (box.upper[a] - at <= tolerance) at_side[a + 3] += area;
    }
  }
};

// Step between the triangles that are examined; above 1 in scenes of millions of triangles.
size_t stride_of(const Scene& scene) {
  return 1 + triangle_count(scene) / 2'000'000;
}

// Large flat meshes that are named floor or ceiling, or whose material is.
class NamedFloors {
 public:
  NamedFloors(const Scene& scene, const Box& box) : scene_(scene), box_(box) {}

  void add(const MeshInWorld& mesh, const FlatAreas& areas) {
    const std::string& material = mesh.mesh().material < scene_.materials.size()
                                      ? scene_.materials[mesh.mesh().material].name
                                      : mesh.name();
    const bool floor = is_floor(mesh.name()) || is_floor(material);
    const bool ceiling = is_ceiling(mesh.name()) || is_ceiling(material);
    if (floor == ceiling) return;
    Box own;
    for (const Vec3& p : mesh.mesh().positions)
      own.grow(mesh.instance() != nullptr ? Vec3(mesh.instance()->world_from_mesh.point(Vec3d(p)))
                                          : p);
    const Vec3 size = box_.extent();
    for (size_t a = 0; a < 3; ++a) {
      const double section = double(size[(a + 1) % 3]) * double(size[(a + 2) % 3]);
      if (areas.by_axis[a] < 0.9 * areas.all || areas.all < 0.05 * section) continue;
      const float above = box_.centre()[a] - own.centre()[a];
      const bool is_low = above > -0.02f * size[a], is_high = above < 0.02f * size[a];
      const bool is_positive = floor ? is_low : is_high;
      shares_[is_positive ? a : a + 3] += areas.all;
      has_floor_ |= floor;
      has_ceiling_ |= ceiling;
    }
  }

  void add_to(std::vector<UpHint>& hints) const {
    add_hints(shares_, 3, 0.2,
              has_floor_ && has_ceiling_ ? "the names of floor and ceiling"
              : has_floor_               ? "the name of its floor"
                                         : "the name of its ceiling",
              hints);
  }

 private:
  const Scene& scene_;
  const Box& box_;
  Shares shares_{};
  bool has_floor_ = false, has_ceiling_ = false;
};

// Adds a hint if a surface fills exactly one side of the scene's bounds, and that is a low one: the
// ground below everything. Or if the whole scene is flat.
void add_lone_ground(const FlatAreas& areas, const Box& box, std::vector<UpHint>& hints) {
  constexpr double filled = 0.8;
  constexpr float flat = 1e-6f;
  const Vec3 size = box.extent();
  size_t sides = 0, side = 0;
  for (size_t s = 0; s < 6; ++s) {
    const size_t a = s % 3;
    if (size[a] <= flat * box.diagonal()) {
      if (a > 0) hints.push_back({direction(a), 2, "its one flat surface"});
      return;
    }
    const double section = double(size[(a + 1) % 3]) * double(size[(a + 2) % 3]);
    if (areas.at_side[s] < filled * section) continue;
    ++sides;
    side = s;
  }
  if (sides == 1 && (side == 1 || side == 2))
    hints.push_back({direction(side), 2, "the ground below all else"});
}

void add_surfaces(const Scene& scene, std::vector<UpHint>& hints) {
  const Box box = bounds(scene);
  if (box.is_empty()) return;
  const float tolerance = 1e-4f * box.diagonal();
  const size_t stride = stride_of(scene);
  FlatAreas all;
  NamedFloors named(scene, box);
  for_each_mesh(scene, [&](uint32_t, const MeshInWorld& mesh) {
    FlatAreas own;
    for (size_t i = 0; i < mesh.size(); i += stride) {
      const std::array<Vec3, 3> p = mesh.corners(i);
      own.add(p, box, tolerance, double(stride));
      all.add(p, box, tolerance, double(stride));
    }
    named.add(mesh, own);
  });
  named.add_to(hints);
  add_lone_ground(all, box, hints);
}

void add_standing(const Scene& scene, std::vector<UpHint>& hints) {
  const std::array<size_t, 3> standing = count_standing_objects(scene);
  const size_t up = standing[1] >= standing[2] ? 1 : 2;
  const auto most = double(standing[up]), other = double(standing[3 - up]);
  if (most > 0 && most >= 1.5 * other)
    hints.push_back(
        {direction(up), 4 * (most - other) / (most + other + 1),
         most > 1 ? "objects that stand on others" : "an object that stands on another"});
}

// Area times mean unit normal of a light with a surface. For curved lights it is shorter than the
// area.
Vec3 area_vector(const Scene& scene, const Light& e, double& area) {
  Vec3 sum{0};
  area = 0;
  if (e.kind == LightKind::disk) {
    const Disk& disk = scene.disks[e.geometry];
    area = double(disk.radius) * double(disk.radius) * 3.14159265358979;
    return disk.normal * float(area);
  }
  if (e.kind == LightKind::sphere) return sum;
  const Mesh& mesh = scene.meshes[e.geometry];
  for (const uint32_t t : e.triangles) {
    const Triangle& v = mesh.triangles[t];
    const Vec3 n = cross(mesh.positions[v[1]] - mesh.positions[v[0]],
                         mesh.positions[v[2]] - mesh.positions[v[0]]) *
                   0.5f;
    area += double(length(n));
    sum = sum + n;
  }
  return sum;
}

// Lamps mostly hang from ceilings. Windows modelled as lights face sideways, so this hint is never
// strong.
void add_lamps(const Scene& scene, std::vector<UpHint>& hints) {
  Shares shares{};
  std::array<size_t, directions> counts{};
  double other = 0;
  for (const Light& e : scene.lights) {
    Vec3 faces{0};
    double flux = 0;
    if (has_surface(e.kind) && !e.is_two_sided) {
      double area = 0;
      const Vec3 sum = area_vector(scene, e, area);
      if (area > 0) faces = sum * float(1 / area);
      flux = area * double(luminance(e.radiance));
    } else if (e.kind == LightKind::spot) {
      faces = e.direction;
      flux = double(luminance(e.radiance)) * double(1 - e.cos_outer);
    } else {
      continue;
    }
    const double before = total(shares);
    add_along(-faces, flux, shares);
    if (total(shares) == before) other += flux;
    for (size_t i = 0; i < directions; ++i) counts[i] += dot(-faces, direction(i)) > 0.95f;
  }
  for (size_t i = 1; i < 3; ++i)
    if (shares[i] > 0.7 * (total(shares) + other))
      hints.push_back({direction(i), counts[i] > 2 ? 3.0 : 2.0,
                       counts[i] > 1 ? "lamps that face down" : "a lamp that faces down"});
}

void add_suns(const Scene& scene, std::vector<UpHint>& hints) {
  Shares shares{};
  for (const Light& e : scene.lights)
    if (e.kind == LightKind::sun || e.kind == LightKind::distant)
      for (const size_t i : {size_t(1), size_t(2)}) {
        const float high = -e.direction[i], other = -e.direction[3 - i];
        if (high > 0.4f && other < 0.2f) shares[i] += 1;
      }
  add_hints(shares, 1, 0.5, "the height of its sun", hints);
}

}  // namespace

std::vector<UpHint> up_hints(const Scene& scene) {
  std::vector<UpHint> hints;
  add_skies(scene, hints);
  add_cameras(scene, hints);
  add_surfaces(scene, hints);
  add_standing(scene, hints);
  add_lamps(scene, hints);
  add_suns(scene, hints);
  std::stable_sort(hints.begin(), hints.end(),
                   [](const UpHint& a, const UpHint& b) { return a.weight > b.weight; });
  return hints;
}

}  // namespace troffer
