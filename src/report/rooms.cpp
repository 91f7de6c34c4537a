#include "report/rooms.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "base/disjoint_sets.h"
#include "base/random.h"
#include "base/units.h"
#include "report/above.h"
#include "report/floor_outline.h"
#include "report/plane_cut.h"

namespace troffer {

namespace {

constexpr double usual_cut = 2.3;              // m; above usual doors, below usual ceilings
constexpr double least_cut_to_ceiling = 0.15;  // m; least distance of the cut from the ceiling
constexpr double open_cut = 1.9;               // m; cut where there is no ceiling
constexpr double body_cut = 0.1;               // m; above skirting boards, below seats and shelves
constexpr double least_outline = 0.25;         // m; narrower outlines are legs, cords and leaves
constexpr double tallest_furniture = 2.45;     // m; wardrobes are at most 2.36 m high
constexpr double widest_gap = 0.05;            // m; between walls that were meant to meet
constexpr double joint = 0.01;                 // m; gap between boards or tiles
constexpr double least_thickness = 0.35;  // m, twice the area over the perimeter: hollow walls are
                                          // thinner
constexpr double highest_podium = 0.6;    // m; tables are higher
constexpr size_t most_segments = 6000;

enum class CellUse : uint8_t { outside, open, furniture, wall };

double length_of(const CellContact& c) {
  const Vec2d d = c.to - c.from;
  return std::sqrt(dot(d, d));
}

bool has_wall(const CellContact& c) {
  return (c.kinds & segment_wall) != 0;
}

class RoomFinder {
 public:
  RoomFinder(const PreparedScene& scene, const std::vector<const FlatFace*>& faces, const Vec3d& n,
             const Vec3d& up)
      : scene_(scene), faces_(faces) {
    plane_.normal = n;
    plane_.up = up;
    const Vec3d axis = std::abs(n.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    plane_.along = normalize(axis - n * dot(axis, n));
    plane_.across = cross(n, plane_.along);
    plane_.origin = faces[0]->triangles[0][0];
    double most = 0;
    for (const FlatFace* f : faces)
      for (const auto& t : f->triangles)
        for (const Vec3d& p : t) most = std::max(most, dot(p - plane_.origin, n));
    plane_.origin += n * most;
  }

  std::vector<Room> find() {
    if (!measure_headroom()) return {};
    cells_ = cells_between(segments());
    classify();
    join_cells();
    std::vector<size_t> roots = room_roots();
    absorb_islands(roots);
    exclude_shell();
    std::vector<Room> rooms;
    for (const size_t r : roots)
      if (Room room; make_room(r, room)) rooms.push_back(std::move(room));
    return rooms;
  }

 private:
  // Sets the cut height from the median free height above the faces. Returns false if hardly any
  // place has headroom.
  bool measure_headroom() {
    constexpr size_t places = 256;
    std::vector<double> heights;
    for (const Above& a : above(scene_, places_on(faces_, places), plane_.up))
      if (!a.is_within && a.height >= headroom) heights.push_back(a.height);
    if (heights.size() < places / 50) return false;
    std::nth_element(heights.begin(), heights.begin() + std::ptrdiff_t(heights.size() / 2),
                     heights.end());
    const double ceiling = heights[heights.size() / 2];
    cut_ = std::isfinite(ceiling) ? std::min(usual_cut, ceiling - least_cut_to_ceiling) : open_cut;
    wall_height_ =
        std::isfinite(ceiling) ? std::max(cut_, std::min(ceiling - 0.1, tallest_furniture)) : cut_;
    return true;
  }

  std::vector<PlaneSegment> segments() {
    std::vector<PlaneSegment> all = outline_of(faces_, plane_);
    PlaneBounds b{all.empty() ? Vec2d{} : all[0].a, all.empty() ? Vec2d{} : all[0].a};
    for (const PlaneSegment& s : all)
      for (const Vec2d& p : {s.a, s.b}) {
        b.lower = {std::min(b.lower.x, p.x), std::min(b.lower.y, p.y)};
        b.upper = {std::max(b.upper.x, p.x), std::max(b.upper.y, p.y)};
      }
    // Surfaces often end at round heights: cut slightly above them.
    constexpr double odd = 1.37e-3;
    const Scene& scene = scene_.scene;
    const auto add = [&](double height, SegmentKind kind) {
      auto cut = plane_cut(scene, plane_, height + odd, b, least_outline, kind);
      if (kind == segment_wall)
        for (PlaneSegment& s : cut) s.is_solid = false;
      if (kind == segment_wall) close_gaps(cut, widest_gap);
      if (all.size() + cut.size() <= most_segments) all.insert(all.end(), cut.begin(), cut.end());
    };
    add(cut_, segment_wall);
    add(body_cut, segment_body);
    return all;
  }

  void classify() {
    const auto& cells = cells_.cells;
    uses_.assign(cells.size(), CellUse::outside);
    tops_.assign(cells.size(), 0);
    std::vector<double> beside(cells.size(), 0), around(cells.size(), 0);
    for (const CellContact& c : cells_.contacts)
      for (const auto& [one, other] : {std::pair{c.left, c.right}, std::pair{c.right, c.left}}) {
        if (one == no_plane_cell) continue;
        around[one] += length_of(c);
        if (other != no_plane_cell && cells[other].cover > 0) beside[one] += length_of(c);
      }
    std::vector<Vec3d> places;
    std::vector<size_t> which;
    for (size_t i = 0; i < cells.size(); ++i) {
      const bool is_joint = 2 * cells[i].area < joint * around[i] && beside[i] > 0.8 * around[i];
      if (cells[i].cover <= 0 && !is_joint) continue;
      which.push_back(i);
      places.push_back(plane_.place(cells[i].middle) + plane_.up * rug);
    }
    const std::vector<Above> found = above(scene_, places, plane_.up);
    for (size_t k = 0; k < which.size(); ++k) {
      const size_t i = which[k];
      tops_[i] = rug + found[k].height;
      // A body on feet shows its underside, which hides its top. It is no podium, so its top counts
      // as the highest a podium may have.
      if (!found[k].is_within && cells[i].solid > 0 && tops_[i] < wall_height_)
        tops_[i] = highest_podium;
      const bool is_body = found[k].is_within || cells[i].solid > 0;
      uses_[i] = !is_body                   ? CellUse::open
                 : tops_[i] >= wall_height_ ? CellUse::wall
                                            : CellUse::furniture;
    }
  }

  // Joins cells that no wall separates.
  void join_cells() {
    sets_ = DisjointSets(cells_.cells.size());
    for (const CellContact& c : cells_.contacts)
      if (is_floor(c.left) && is_floor(c.right) && !has_wall(c) && length_of(c) > 1e-4)
        sets_.join(uint32_t(c.left), uint32_t(c.right));
  }

  bool is_floor(size_t cell) const {
    return cell != no_plane_cell && uses_[cell] != CellUse::outside;
  }
  size_t set_of(size_t cell) { return sets_.find(uint32_t(cell)); }

  std::vector<double> areas_of_sets() {
    std::vector<double> areas(cells_.cells.size(), 0);
    for (size_t i = 0; i < cells_.cells.size(); ++i)
      if (is_floor(i)) areas[set_of(i)] += cells_.cells[i].area;
    return areas;
  }

  std::vector<double> areas_of(CellUse use) {
    std::vector<double> areas(cells_.cells.size(), 0);
    for (size_t i = 0; i < cells_.cells.size(); ++i)
      if (uses_[i] == use) areas[set_of(i)] += cells_.cells[i].area;
    return areas;
  }

  std::vector<size_t> room_roots() {
    const std::vector<double> areas = areas_of_sets(), walls = areas_of(CellUse::wall);
    std::vector<double> rims(areas.size(), 0);
    for (const CellContact& c : cells_.contacts)
      for (const size_t k : {c.left, c.right})
        if (is_floor(k) && is_rim(c)) rims[set_of(k)] += length_of(c);
    std::vector<size_t> roots;
    for (size_t i = 0; i < areas.size(); ++i)
      if (areas[i] >= least_floor && walls[i] < 0.5 * areas[i] &&
          2 * areas[i] >= least_thickness * rims[i])
        roots.push_back(i);
    return roots;
  }

  bool is_rim(const CellContact& c) {
    return !is_floor(c.left) || !is_floor(c.right) || has_wall(c) ||
           set_of(c.left) != set_of(c.right);
  }

  // Joins regions under a luminaire or within a wardrobe that reaches the height of the walls' cut
  // to the single room around them.
  void absorb_islands(const std::vector<size_t>& roots) {
    const std::vector<double> areas = areas_of_sets(), walls = areas_of(CellUse::wall),
                              bodies = areas_of(CellUse::furniture);
    const std::set<size_t> is_room(roots.begin(), roots.end());
    // Adjacent rooms of each region; no_plane_cell: the outside.
    std::map<size_t, std::set<size_t>> around;
    for (const CellContact& c : cells_.contacts)
      for (const auto& [one, other] : {std::pair{c.left, c.right}, std::pair{c.right, c.left}}) {
        if (!is_floor(one) || is_room.contains(set_of(one))) continue;
        if (!is_floor(other)) {
          around[set_of(one)].insert(no_plane_cell);
          continue;
        }
        const size_t s = set_of(other);
        if (s == set_of(one) || walls[s] > 0.5 * areas[s]) continue;
        around[set_of(one)].insert(is_room.contains(s) ? s : no_plane_cell);
      }
    for (const auto& [island, rooms] : around) {
      if (rooms.size() != 1 || rooms.contains(no_plane_cell) || walls[island] > 0.1 * areas[island])
        continue;
      const size_t room = *rooms.begin();
      if (bodies[island] > 0.5 * areas[island] || sees(island, room)) moved_[island] = room;
    }
  }

  // True if a point in the middle of an island, a metre above the floor, sees the surrounding room.
  bool sees(size_t island, size_t room) {
    const PlaneCell* largest = nullptr;
    for (size_t i = 0; i < cells_.cells.size(); ++i)
      if (is_floor(i) && set_of(i) == island &&
          (largest == nullptr || cells_.cells[i].area > largest->area))
        largest = &cells_.cells[i];
    constexpr int directions = 16;
    constexpr double eye = 1, farthest = 3;
    const Vec3d from = plane_.place(largest->middle) + plane_.up * eye;
    std::vector<Ray> rays;
    std::vector<Vec2d> ways;
    for (int k = 0; k < directions; ++k) {
      const double a = 2 * pi * k / directions;
      ways.emplace_back(std::cos(a), std::sin(a));
      rays.push_back(
          ray_from(scene_, from, plane_.along * ways.back().x + plane_.across * ways.back().y));
    }
    std::vector<Hit> hits(rays.size());
    scene_.tracer.closest(rays, hits);
    for (size_t k = 0; k < rays.size(); ++k) {
      const double t = std::min(farthest, hits[k].is_valid() ? double(hits[k].t) : farthest);
      const Vec2d end = largest->middle + ways[k] * (0.95 * t);
      for (size_t i = 0; i < cells_.cells.size(); ++i)
        if (is_floor(i) && set_of(i) == room && is_within(cells_.cells[i], end)) return true;
    }
    return false;
  }

  size_t room_of(size_t cell) {
    const size_t s = set_of(cell);
    const auto at = moved_.find(s);
    return at == moved_.end() ? s : at->second;
  }

  // Turns furniture into wall where it is a parapet, which continues outside of the room, or a
  // podium, which is a floor of its own.
  void exclude_shell() {
    DisjointSets bodies(cells_.cells.size());
    const auto is_body = [&](size_t k) {
      return k != no_plane_cell && (uses_[k] == CellUse::furniture || uses_[k] == CellUse::wall);
    };
    for (const CellContact& c : cells_.contacts)
      if (is_body(c.left) && is_body(c.right) && (c.kinds & segment_body) == 0)
        bodies.join(uint32_t(c.left), uint32_t(c.right));
    std::map<uint32_t, std::map<size_t, double>> parts;  // area of a body by room
    std::map<uint32_t, double> whole;
    for (size_t i = 0; i < cells_.cells.size(); ++i) {
      if (!is_body(i)) continue;
      parts[bodies.find(uint32_t(i))][room_of(i)] += cells_.cells[i].area;
      whole[bodies.find(uint32_t(i))] += cells_.cells[i].area;
    }
    for (size_t i = 0; i < cells_.cells.size(); ++i) {
      if (uses_[i] != CellUse::furniture) continue;
      const uint32_t body = bodies.find(uint32_t(i));
      const bool is_shell = parts[body][room_of(i)] < 0.95 * whole[body];
      const bool is_podium = tops_[i] < highest_podium && whole[body] >= least_floor &&
                             !is_furniture(tops_[i], whole[body]);
      if (is_shell || is_podium) uses_[i] = CellUse::wall;
    }
  }

  bool make_room(size_t root, Room& room) {
    std::vector<size_t> inside;
    for (size_t i = 0; i < cells_.cells.size(); ++i)
      if (is_inside(i, root)) inside.push_back(i);
    std::vector<std::array<Vec3d, 3>> triangles;
    for (const size_t i : inside) {
      const auto& c = cells_.cells[i].corners;
      for (const auto& [a, b] : {std::pair{1, 2}, std::pair{2, 3}})
        triangles.push_back(
            {plane_.place(c[0]), plane_.place(c[size_t(a)]), plane_.place(c[size_t(b)])});
    }
    if (triangles.empty()) return false;
    room.floor = surface_of_triangles(triangles, plane_.normal, rim_of(root));
    room.floor.kind = SurfaceKind::floor;
    room.floor.name = name_of_room(inside);
    room.around = look_around(scene_, plane_, open_cells(inside));
    return room.floor.area >= least_floor && room.around.clear >= 0.5;
  }

  std::vector<const PlaneCell*> open_cells(const std::vector<size_t>& inside) const {
    std::vector<const PlaneCell*> open;
    for (const size_t i : inside)
      if (uses_[i] == CellUse::open) open.push_back(&cells_.cells[i]);
    return open;
  }

  bool is_inside(size_t cell, size_t root) {
    return is_floor(cell) && uses_[cell] != CellUse::wall && room_of(cell) == root;
  }

  // Returns the borders between the room and everything else. Consecutive stretches of one segment
  // are joined.
  std::vector<std::array<Vec3d, 2>> rim_of(size_t root) {
    struct Stretch {
      size_t segment;
      Vec2d from, to;
    };
    std::vector<Stretch> joined;
    std::map<size_t, size_t> last;  // last stretch of a segment
    for (const CellContact& c : cells_.contacts) {
      const bool l = is_inside(c.left, root), r = is_inside(c.right, root);
      // A wall face within the room that reaches from floor to ceiling encloses no cell.
      const bool is_thin_wall =
          l && r && has_wall(c) && set_of(c.left) == root && set_of(c.right) == root;
      if ((l == r && !is_thin_wall) || c.kinds == 0) continue;
      const auto at = last.find(c.segment);
      if (at != last.end() && length_of({0, 0, 0, 0, joined[at->second].to, c.from}) < 1e-4) {
        joined[at->second].to = c.to;
        continue;
      }
      last[c.segment] = joined.size();
      joined.push_back({c.segment, c.from, c.to});
    }
    std::vector<std::array<Vec3d, 2>> rim;
    for (const Stretch& s : joined) rim.push_back({plane_.place(s.from), plane_.place(s.to)});
    return rim;
  }

  // Returns the name of the face with the largest share of the room's area.
  std::string name_of_room(const std::vector<size_t>& inside) {
    if (faces_.size() == 1) return faces_[0]->name;
    std::map<std::string, double> areas;
    for (const size_t i : inside)
      for (const FlatFace* f : faces_) {
        const bool is_on =
            std::any_of(f->triangles.begin(), f->triangles.end(), [&](const auto& t) {
              PlaneCell c;
              c.corners = {plane_.flat(t[0]), plane_.flat(t[1]), plane_.flat(t[2]),
                           plane_.flat(t[0])};
              return is_within(c, cells_.cells[i].middle);
            });
        if (!is_on) continue;
        areas[f->name] += cells_.cells[i].area;
        break;
      }
    const auto most = std::max_element(areas.begin(), areas.end(),
                                       [](auto& a, auto& b) { return a.second < b.second; });
    return most == areas.end() ? std::string() : most->first;
  }

  const PreparedScene& scene_;
  const std::vector<const FlatFace*>& faces_;
  FloorPlane plane_;
  double cut_ = usual_cut, wall_height_ = tallest_furniture;
  PlaneCells cells_;
  std::vector<CellUse> uses_;
  std::vector<double> tops_;  // height of the top of the body in a cell, m
  DisjointSets sets_{0};
  std::map<size_t, size_t> moved_;  // islands and the rooms they belong to
};

}  // namespace

std::vector<Room> rooms_on(const PreparedScene& scene, const std::vector<const FlatFace*>& faces,
                           const Vec3d& n, const Vec3d& up) {
  return faces.empty() ? std::vector<Room>{} : RoomFinder(scene, faces, n, up).find();
}

bool is_furniture(double height, double area) {
  // A step is lower than furniture, and a stage is larger than a bed.
  constexpr double step = 0.25, desk_low = 0.6, tallest_desk = 1.4, largest_bed = 6;
  if (height < step || height > tallest_desk) return false;
  return height >= desk_low || area < largest_bed;
}

}  // namespace troffer
