#include "render/placement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/random.h"
#include "base/warp.h"
#include "trace/surface.h"

namespace troffer {

namespace {

constexpr size_t places_tried = 64, rays_of_place = 32;
// Thresholds for a closed room: from its middle most rays meet fronts and few leave through
// openings. For comparison, in a room of 5 × 4 × 2.7 m without its ceiling the share of open rays
// is .22.
constexpr double least_fronts = 0.65, most_open = 0.12;
// From just outside of a room half of all directions are open; inside hardly any are.
constexpr double open_outside = 0.4;
// Inside a body most directions meet the back of a surface; the floor below it shows its front.
constexpr double hidden_share = 0.7;

// Rays from one place, counted by what they meet.
struct Outlook {
  double fronts = 0, backs = 0, open = 0, rays = 0;

  void add(const Outlook& o) {
    fronts += o.fronts;
    backs += o.backs;
    open += o.open;
    rays += o.rays;
  }
  double share(double part) const { return rays > 0 ? part / rays : 0; }
};

bool lets_light_through(const Material& m) {
  return m.kind == MaterialKind::dielectric || m.kind == MaterialKind::angular ||
         m.transmission.value > 0;
}

Outlook outlook(const PreparedScene& scene, const std::vector<Ray>& rays) {
  std::vector<Hit> hits(rays.size());
  scene.tracer.closest(rays, hits);
  Outlook o;
  o.rays = double(rays.size());
  for (size_t i = 0; i < rays.size(); ++i) {
    if (!hits[i].is_valid()) {
      ++o.open;
      continue;
    }
    const Surface s = surface_at(scene.scene, rays[i], hits[i]);
    const bool is_back = dot(s.geometric_normal, rays[i].direction) > 0;
    if (!is_back)
      ++o.fronts;
    else if (!lets_light_through(scene.scene.materials[s.material]))
      ++o.backs;
  }
  return o;
}

void add_sphere_rays(const Vec3& origin, size_t count, Random& random, std::vector<Ray>& rays) {
  for (size_t k = 0; k < count; ++k) {
    Ray ray;
    ray.origin = origin;
    ray.direction = sphere_from_square(random.next_vec2());
    rays.push_back(ray);
  }
}

bool is_luminaire(const Light& e) {
  return e.web != no_web;
}

// Returns the bounds without the bodies of luminaires.
Box bounds_of_room(const Scene& scene) {
  std::set<std::string> luminaires;
  for (const Light& e : scene.lights)
    if (is_luminaire(e)) luminaires.insert(e.name);
  Box box;
  for (const Mesh& m : scene.meshes)
    if (luminaires.find(m.name) == luminaires.end())
      for (const Triangle& t : m.triangles)
        for (const uint32_t v : t) box.grow(m.positions[v]);
  for (const Instance& i : scene.instances) box.grow(i.bounds);
  return box;
}

// Returns the bounds of the room; empty if the scene is not a closed room.
Box closed_room(const PreparedScene& scene) {
  const Box box = bounds_of_room(scene.scene);
  if (box.is_empty()) return {};
  Random random(1);
  std::vector<Ray> rays;
  for (size_t i = 0; i < places_tried; ++i) {
    const Vec3 share{random.next_float(), random.next_float(), random.next_float()};
    add_sphere_rays(box.lower + box.extent() * (Vec3{0.15f} + share * 0.7f), rays_of_place, random,
                    rays);
  }
  const Outlook o = outlook(scene, rays);
  return o.share(o.fronts) > least_fronts && o.share(o.open) < most_open ? box : Box{};
}

bool lies_beyond(const Box& box, const Vec3& p) {
  if (box.is_empty()) return false;
  const float margin = 1e-5f * box.diagonal();
  for (size_t a = 0; a < 3; ++a)
    if (p[a] < box.lower[a] - margin || p[a] > box.upper[a] + margin) return true;
  return false;
}

// Position of a light, and rays in its directions of emission.
struct Emission {
  Vec3 place;
  std::vector<Ray> rays;
};

void add_face_rays(const Vec3& place, const Vec3& normal, float off, Random& random,
                   Emission& emission) {
  for (size_t k = 0; k < rays_of_place; ++k) {
    Ray ray;
    ray.direction = sphere_from_square(random.next_vec2());
    if (dot(ray.direction, normal) < 0) ray.direction = -ray.direction;
    ray.origin = place + normal * off;
    emission.rays.push_back(ray);
  }
}

Emission emission_of(const Scene& scene, const Light& e, Random& random) {
  Emission out;
  const auto off_at = [](const Vec3& p) {
    const Vec3 reach = abs(p);
    return std::max(1e-5f, 4 * ray_offset(std::max(reach.x, std::max(reach.y, reach.z))));
  };
  switch (e.kind) {
    case LightKind::point:
    case LightKind::spot:
      out.place = e.position;
      add_sphere_rays(out.place, rays_of_place, random, out.rays);
      break;
    case LightKind::sphere: {
      const Sphere& s = scene.spheres[e.geometry];
      out.place = s.centre;
      add_sphere_rays(out.place, rays_of_place, random, out.rays);
      for (Ray& ray : out.rays)
        ray.origin = s.centre + ray.direction * (s.radius + off_at(s.centre));
      break;
    }
    case LightKind::disk: {
      const Disk& d = scene.disks[e.geometry];
      out.place = d.centre;
      add_face_rays(d.centre, d.normal, off_at(d.centre), random, out);
      break;
    }
    case LightKind::distant:
    case LightKind::environment:
    case LightKind::sky:
    case LightKind::sun:
      break;  // nowhere
    case LightKind::polygon:
    case LightKind::mesh: {
      const Mesh& mesh = scene.meshes[e.geometry];
      if (e.triangles.empty()) break;
      const Triangle& t = mesh.triangles[e.triangles[e.triangles.size() / 2]];
      const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
      const Vec3 normal = cross(b - a, c - a);
      out.place = (a + b + c) * (1.0f / 3);
      if (length(normal) > 0)
        add_face_rays(out.place, normalize(normal), off_at(out.place), random, out);
    }
  }
  return out;
}

std::string listed(const std::vector<std::string>& names) {
  constexpr size_t most = 6;
  std::string text;
  for (size_t i = 0; i < std::min(names.size(), most); ++i) text += (i > 0 ? ", " : "") + names[i];
  if (names.size() > most) text += fmt::format(" and {} more", names.size() - most);
  return text;
}

std::string counted(size_t n, const char* one, const char* all) {
  return n == 1 ? fmt::format("1 {}", one) : fmt::format("{} {}", n, all);
}

}  // namespace

std::vector<std::string> misplaced_luminaires(const PreparedScene& scene) {
  struct Group {
    bool is_beyond = true, is_luminaire = true;
    Outlook outlook;
  };
  std::vector<std::string> order;
  std::map<std::string, Group> groups;
  const auto is_here = [](const Light& e) { return e.kind < LightKind::distant; };
  if (std::none_of(scene.scene.lights.begin(), scene.scene.lights.end(), is_here)) return {};
  const Box room = closed_room(scene);
  Random random(2);
  for (const Light& e : scene.scene.lights) {
    if (!is_here(e)) continue;
    const auto [at, is_new] = groups.emplace(e.name, Group{});
    if (is_new) order.push_back(e.name);
    const Emission emission = emission_of(scene.scene, e, random);
    at->second.is_beyond = at->second.is_beyond && lies_beyond(room, emission.place);
    at->second.is_luminaire = at->second.is_luminaire && is_luminaire(e);
    if (is_luminaire(e)) at->second.outlook.add(outlook(scene, emission.rays));
  }
  std::vector<std::string> outside, hidden, texts;
  for (const std::string& name : order) {
    const Group& g = groups[name];
    const Outlook& o = g.outlook;
    if (g.is_beyond || (g.is_luminaire && !room.is_empty() && o.share(o.open) >= open_outside))
      outside.push_back(name);
    else if (g.is_luminaire && o.share(o.backs) >= hidden_share)
      hidden.push_back(name);
  }
  if (!outside.empty())
    texts.push_back(fmt::format("{} outside of the room: {}",
                                counted(outside.size(), "luminaire lies", "luminaires lie"),
                                listed(outside)));
  if (!hidden.empty())
    texts.push_back(fmt::format("{} within a body, or behind a surface, which hides the light: {}",
                                counted(hidden.size(), "luminaire lies", "luminaires lie"),
                                listed(hidden)));
  return texts;
}

std::vector<std::string> misplaced_points(const PreparedScene& scene,
                                          const std::vector<MeasuringPoint>& points,
                                          const MeasureResult& result) {
  const Box room = closed_room(scene);
  std::vector<std::string> outside, hidden, texts;
  Random random(3);
  for (size_t i = 0; i < points.size(); ++i) {
    const Vec3 place(points[i].position - scene.scene.origin);
    const std::string number = std::to_string(i + 1);
    if (lies_beyond(room, place)) {
      outside.push_back(number);
      continue;
    }
    const Measurement& m = result.values[i];
    if (!result.is_measured[i] || m.illuminance_lx > 0 || m.standard_error > 0) continue;
    const Vec3 reach = abs(place);
    const float off =
        std::max(1e-5f, 4 * ray_offset(std::max(reach.x, std::max(reach.y, reach.z))));
    const Vec3 normal = normalize(points[i].normal);
    Emission lit, front, back;
    add_face_rays(place, normal, off, random, lit);
    add_sphere_rays(place + normal * off, rays_of_place, random, front.rays);
    add_sphere_rays(place - normal * off, rays_of_place, random, back.rays);
    const Outlook o = outlook(scene, lit.rays), before = outlook(scene, front.rays),
                  behind = outlook(scene, back.rays);
    // An outward-facing point on the inner face of a wall is not outside.
    const double open = std::min(before.share(before.open), behind.share(behind.open));
    if (!room.is_empty() && open >= open_outside) outside.push_back(number);
    if (o.share(o.backs) >= hidden_share) hidden.push_back(number);
  }
  if (!outside.empty())
    texts.push_back(fmt::format(
        "{} outside of the room (number {}); check that the list has the scene's upward axis",
        counted(outside.size(), "point lies", "points lie"), listed(outside)));
  if (!hidden.empty())
    texts.push_back(fmt::format("{} within a body, where no light arrives (number {})",
                                counted(hidden.size(), "point lies", "points lie"),
                                listed(hidden)));
  return texts;
}

}  // namespace troffer
