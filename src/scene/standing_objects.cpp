#include "scene/standing_objects.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "base/disjoint_sets.h"
#include "scene/mesh_in_world.h"

namespace troffer {

namespace {

constexpr size_t most_split_triangles = 300'000;
// Contact tolerance, as a share of the scene's diagonal: 5 mm in 10 m.
constexpr float contact_share = 5e-4f;
constexpr float least_cosine = 0.9999f;  // between an axis and the normal of a level surface

// A flat piece of an object, perpendicular to an axis.
struct LevelFace {
  uint32_t object = 0;
  float level = 0;                        // along that axis
  std::array<float, 2> lower{}, upper{};  // along the other two
  double area = 0;
};

double extent_area(const std::array<float, 2>& lower, const std::array<float, 2>& upper) {
  return double(upper[0] - lower[0]) * double(upper[1] - lower[1]);
}

size_t across(size_t axis, size_t i) {
  return (axis + 1 + i) % 3;
}

class Contacts {
 public:
  explicit Contacts(const Scene& scene)
      : tolerance_(contact_share * bounds(scene).diagonal()),
        is_split_(triangle_count(scene) <= most_split_triangles) {
    for_each_mesh(scene, [&](uint32_t, const MeshInWorld& mesh) { add(mesh); });
    for (std::vector<LevelFace>& faces : faces_) merge(faces);
  }

  size_t most_on_one_plane(size_t axis) const {
    std::vector<float> levels;
    for (uint32_t i = 0; i < objects_.size(); ++i)
      if (stands(i, axis)) levels.push_back(objects_[i].lower[axis]);
    std::sort(levels.begin(), levels.end());
    size_t most = 0;
    for (size_t first = 0, i = 0; i < levels.size(); ++i) {
      while (levels[i] - levels[first] > 2 * tolerance_) ++first;
      most = std::max(most, i - first + 1);
    }
    return most;
  }

 private:
  void add(const MeshInWorld& mesh) {
    const std::vector<uint32_t> pieces = pieces_of(mesh);
    std::vector<uint32_t> object_of(pieces.size(), no_object);
    for (size_t i = 0; i < mesh.size(); ++i) {
      uint32_t& object = object_of[pieces[mesh.triangle(i)[0]]];
      if (object == no_object) {
        object = uint32_t(objects_.size());
        objects_.emplace_back();
      }
      const std::array<Vec3, 3> p = mesh.corners(i);
      for (const Vec3& corner : p) objects_[object].grow(corner);
      add_face(p, object);
    }
  }

  // A representative vertex of its connected piece, for each vertex.
  std::vector<uint32_t> pieces_of(const MeshInWorld& mesh) const {
    const std::vector<Vec3>& positions = mesh.mesh().positions;
    std::vector<uint32_t> pieces(positions.size(), 0);
    if (!is_split_) return pieces;
    DisjointSets sets(positions.size());
    std::vector<uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](uint32_t v) {
      const Vec3& p = positions[v];
      return std::array<float, 3>{p.x, p.y, p.z};
    };
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
    for (size_t i = 1; i < order.size(); ++i)
      if (key(order[i - 1]) == key(order[i])) sets.join(order[i - 1], order[i]);
    for (const Triangle& t : mesh.mesh().triangles) {
      sets.join(t[0], t[1]);
      sets.join(t[0], t[2]);
    }
    for (uint32_t v = 0; v < pieces.size(); ++v) pieces[v] = sets.find(v);
    return pieces;
  }

  void add_face(const std::array<Vec3, 3>& p, uint32_t object) {
    const Vec3 n = cross(p[1] - p[0], p[2] - p[0]);
    const float twice_area = length(n);
    for (size_t axis = 0; axis < 3; ++axis) {
      if (!(std::abs(n[axis]) > least_cosine * twice_area)) continue;
      LevelFace f;
      f.object = object;
      f.level = (p[0][axis] + p[1][axis] + p[2][axis]) / 3;
      f.area = 0.5 * double(twice_area);
      for (size_t i = 0; i < 2; ++i) {
        const size_t a = across(axis, i);
        f.lower[i] = std::min({p[0][a], p[1][a], p[2][a]});
        f.upper[i] = std::max({p[0][a], p[1][a], p[2][a]});
      }
      faces_[axis].push_back(f);
    }
  }

  // Merges the triangles of one object in one plane, and sorts all faces by level.
  void merge(std::vector<LevelFace>& faces) const {
    std::sort(faces.begin(), faces.end(), [](const LevelFace& a, const LevelFace& b) {
      return a.object != b.object ? a.object < b.object : a.level < b.level;
    });
    std::vector<LevelFace> merged;
    for (const LevelFace& f : faces) {
      const bool is_same = !merged.empty() && merged.back().object == f.object &&
                           f.level - merged.back().level <= tolerance_;
      if (!is_same) {
        merged.push_back(f);
        continue;
      }
      LevelFace& m = merged.back();
      m.area += f.area;
      for (size_t i = 0; i < 2; ++i) {
        m.lower[i] = std::min(m.lower[i], f.lower[i]);
        m.upper[i] = std::max(m.upper[i], f.upper[i]);
      }
    }
    std::sort(merged.begin(), merged.end(), [](const LevelFace& a, const LevelFace& b) {
      return a.level != b.level ? a.level < b.level : a.object < b.object;
    });
    faces = std::move(merged);
  }

  // True if the object has volume and stands on a larger flat surface of another one.
  bool stands(uint32_t number, size_t axis) const {
    const Box& object = objects_[number];
    const Vec3 size = object.extent();
    if (!(std::min({size.x, size.y, size.z}) > 2 * tolerance_)) return false;
    const std::vector<LevelFace>& faces = faces_[axis];
    const float level = object.lower[axis];
    auto face = std::lower_bound(faces.begin(), faces.end(), level - tolerance_,
                                 [](const LevelFace& f, float least) { return f.level < least; });
    for (; face != faces.end() && face->level <= level + tolerance_; ++face)
      if (face->object != number && carries(*face, object, axis)) return true;
    return false;
  }

  static bool carries(const LevelFace& face, const Box& object, size_t axis) {
    constexpr double larger = 1.5, least_filled = 0.2;
    const double whole = extent_area(face.lower, face.upper);
    const Vec3 size = object.extent(), middle = object.centre();
    const double footprint = double(size[across(axis, 0)]) * double(size[across(axis, 1)]);
    if (!(whole > larger * footprint) || face.area < least_filled * whole) return false;
    for (size_t i = 0; i < 2; ++i) {
      const float at = middle[across(axis, i)];
      if (at < face.lower[i] || at > face.upper[i]) return false;
    }
    return true;
  }

  static constexpr uint32_t no_object = ~0u;
  float tolerance_;
  bool is_split_;
  std::vector<Box> objects_;
  std::array<std::vector<LevelFace>, 3> faces_;  // by axis
};

}  // namespace

std::array<size_t, 3> count_standing_objects(const Scene& scene) {
  const Contacts contacts(scene);
  return {contacts.most_on_one_plane(0), contacts.most_on_one_plane(1),
          contacts.most_on_one_plane(2)};
}

}  // namespace troffer
