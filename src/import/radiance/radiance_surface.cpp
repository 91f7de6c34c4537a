#include "import/radiance/radiance_surface.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "import/limits.h"
#include "import/mesh_clean.h"
#include "import/polygon.h"
#include "import/radiance/radiance_relay.h"
#include "import/radiance/radiance_sky.h"
#include "import/radiance/radiance_spot.h"
#include "import/tessellate.h"

namespace troffer {

namespace {

constexpr int round_steps = 64;

// Frame at `origin` with z along `axis`.
Affine frame(const Vec3d& origin, const Vec3d& axis) {
  Affine t;
  t.columns[2] = normalize(axis);
  const Vec3d other = std::abs(t.columns[2].x) < 0.5 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  t.columns[0] = normalize(cross(other, t.columns[2]));
  t.columns[1] = cross(t.columns[2], t.columns[0]);
  t.translation = origin;
  return t;
}

// Lateral surface of a cone about z from 0 to `height`, front outside.
Mesh mantle(double height, double r0, double r1) {
  Mesh m;
  const double slope = (r0 - r1) / height;
  for (int i = 0; i <= round_steps; ++i) {
    const double phi = 2 * pi * (i % round_steps) / round_steps;
    const Vec3d n(std::cos(phi), std::sin(phi), 0);
    const Vec3d normal = normalize(n + Vec3d{0, 0, slope});
    m.positions.emplace_back(n * r0);
    m.positions.emplace_back(n * r1 + Vec3d{0, 0, height});
    m.normals.insert(m.normals.end(), 2, Vec3(normal));
    if (i == round_steps) break;
    const auto a = uint32_t(2 * i);
    if (r0 > 0) m.triangles.push_back({a, a + 2, a + 3});
    if (r1 > 0) m.triangles.push_back({a, a + 3, a + 1});
  }
  return m;
}

void need(const RadianceModifier& p, size_t count) {
  if (p.arguments.reals.size() != count)
    p.place.fail(p.type + " needs " + std::to_string(count) + " real arguments");
}

Vec3d vector_at(const RadianceModifier& p, size_t i) {
  const auto& v = p.arguments.reals;
  return {v[i], v[i + 1], v[i + 2]};
}

}  // namespace

bool RadianceSurfaces::is_surface(const std::string& type) {
  for (const char* t : {"polygon", "sphere", "bubble", "ring", "cylinder", "tube", "cone", "cup",
                        "source", "instance", "mesh"})
    if (type == t) return true;
  return false;
}

ShapeAttributes RadianceSurfaces::placed_look(const RadianceLook& look, const std::string& name,
                                              const SourcePlace& place) const {
  ShapeAttributes out;
  out.material = look.material;
  out.place = place;
  if (!look.emission.is_black())
    out.emission = EmissionSpec{name, look.emission, no_texture, false};
  return out;
}

void RadianceSurfaces::add_polygon(const RadianceModifier& p, const std::string& name,
                                   std::vector<Vec3d> corners, bool is_inverted) {
  const RadianceLook look = materials_.look_without_patterns(p.modifier, p.place);
  if (!look.is_there && look.relayed.is_black()) return;
  if (look.is_spot) {
    add_radiance_spot(look, name, extent_of_polygon(corners, p.world, is_inverted), scene_);
    return;
  }
  triangles_ += corners.size();
  if (triangles_ > max_scene_triangles)
    p.place.fail("the scene has more than 60 million triangles");
  if (p.world.swaps_handedness() != is_inverted) std::reverse(corners.begin(), corners.end());
  for (Vec3d& c : corners) c = p.world.point(c);
  if (!look.relayed.is_black()) add_radiance_relays(corners, look.relayed, scene_, bounds_);
  if (!look.is_there) return;
  std::vector<Vec3> points;
  for (const Vec3d& c : corners) points.emplace_back(c - corners[0]);
  std::vector<Triangle> triangles;
  triangulate(points, triangles);
  const ShapeAttributes placed = placed_look(look, name, p.place);
  if (placed.emission) {
    AnchoredMesh mesh;
    set_positions(mesh, corners);
    mesh.mesh.name = name;
    mesh.mesh.triangles = std::move(triangles);
    placer_.add_mesh(mesh, Affine(), false, placed);
    return;
  }
  Collected& all = collected_[look.material];
  all.place = p.place;
  const auto first = uint32_t(all.positions.size());
  all.positions.insert(all.positions.end(), corners.begin(), corners.end());
  for (const Triangle& t : triangles)
    all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

void RadianceSurfaces::finish() {
  for (const auto& [material, all] : collected_) {
    AnchoredMesh mesh;
    set_positions(mesh, all.positions);
    mesh.mesh.name = scene_.materials[material].name;
    mesh.mesh.triangles = all.triangles;
    ShapeAttributes look;
    look.material = material;
    look.place = all.place;
    placer_.add_mesh(mesh, Affine(), false, look);
  }
  collected_.clear();
}

void RadianceSurfaces::add_cone(const RadianceModifier& p, const ShapeAttributes& look,
                                bool is_inverted) {
  const bool is_straight = p.type == "cylinder" || p.type == "tube";
  need(p, is_straight ? 7 : 8);
  const Vec3d p0 = vector_at(p, 0), p1 = vector_at(p, 3);
  const double r0 = p.arguments.reals[6], r1 = is_straight ? r0 : p.arguments.reals[7];
  const double height = length(p1 - p0);
  if (!(r0 >= 0 && r1 >= 0 && r0 + r1 > 0) || !(height > 0))
    p.place.fail(p.type + " without extent");
  const bool is_inward = p.type == "tube" || p.type == "cup";
  placer_.add_mesh({mantle(height, r0, r1), {}}, p.world * frame(p0, p1 - p0),
                   is_inward != is_inverted, look);
}

void RadianceSurfaces::add_ring(const RadianceModifier& p, const ShapeAttributes& look,
                                bool is_inverted) {
  need(p, 8);
  const Vec3d normal = vector_at(p, 3);
  const double a = p.arguments.reals[6], b = p.arguments.reals[7];
  const double inner = std::min(a, b), outer = std::max(a, b);
  if (!(length(normal) > 0) || !(inner >= 0) || !(outer > inner))
    p.place.fail("ring needs a normal and two different radii");
  const Affine t = p.world * frame(vector_at(p, 0), normal);
  if (inner == 0) {
    placer_.add_disk(t, outer, is_inverted, look);
    return;
  }
  Mesh mesh = tessellate_disk(0, outer, inner, 2 * pi);
  mesh.normals.clear();
  mesh.uvs.clear();
  placer_.add_mesh({std::move(mesh), {}}, t, t.swaps_handedness() != is_inverted, look);
}

// Adds the relay of a ring without a hole. Others and curved surfaces have none; in Radiance curved
// surfaces have none either.
void RadianceSurfaces::add_round_relay(const RadianceModifier& p, const Rgb& reflectance,
                                       bool is_inverted) {
  if (p.type != "ring") return;
  need(p, 8);
  const double a = p.arguments.reals[6], b = p.arguments.reals[7], radius = std::max(a, b);
  if (std::min(a, b) > 0) {
    scene_.warnings.add(
        "\"mirror\" with an alternate material on a ring with a hole: the light that it would "
        "reflect is left out");
    return;
  }
  const Affine t = p.world * frame(vector_at(p, 0), vector_at(p, 3));
  std::vector<Vec3d> corners;
  for (int i = 0; i < round_steps; ++i) {
    const double phi = 2 * pi * i / round_steps;
    corners.push_back(t.point({radius * std::cos(phi), radius * std::sin(phi), 0}));
  }
  if (t.swaps_handedness() != is_inverted) std::reverse(corners.begin(), corners.end());
  add_radiance_relays(corners, reflectance, scene_, bounds_);
}

void RadianceSurfaces::add_source(const RadianceModifier& p, const std::string& name) {
  need(p, 4);
  const RadianceLook look = materials_.look_of(p.modifier, p.place);
  const Vec3d to = p.world.vector(vector_at(p, 0));
  const double angle = p.arguments.reals[3];
  if (!(length(to) > 0) || !(angle > 0 && angle <= 360))
    p.place.fail("source needs a direction and an angle up to 360");
  if (!look.is_there || look.emission.is_black()) return;
  RadiancePattern pattern = materials_.pattern_of(look);
  RadiancePattern* const used = pattern.functions.empty() ? nullptr : &pattern;
  if (look.is_spot)
    scene_.warnings.add("\"spotlight\" on a source shines everywhere, not only within its beam");
  if (add_radiance_source(look, used, normalize(to), angle, name, scene_)) return;
  scene_.warnings.add("source '" + shortened(name) + "' cannot be used: left out");
}

void RadianceSurfaces::add(const RadianceModifier& p, const std::string& name, bool is_inverted) {
  const std::string& type = p.type;
  if (type == "instance" || type == "mesh") {
    scene_.warnings.add("\"" + type + "\" names a binary file, which is not read: left out");
    return;
  }
  if (type == "source") {
    add_source(p, name);
    return;
  }
  if (type == "polygon") {
    const size_t count = p.arguments.reals.size();
    if (count < 9 || count % 3 != 0) p.place.fail("polygon needs three numbers for each corner");
    std::vector<Vec3d> corners;
    corners.reserve(count / 3);
    for (size_t i = 0; i < count; i += 3) corners.push_back(vector_at(p, i));
    add_polygon(p, name, std::move(corners), is_inverted);
    return;
  }
  const RadianceLook look = materials_.look_without_patterns(p.modifier, p.place);
  if (!look.relayed.is_black()) add_round_relay(p, look.relayed, is_inverted);
  if (!look.is_there) return;
  if (look.is_spot) {
    add_radiance_spot(look, name, extent_of_round(p, is_inverted), scene_);
    return;
  }
  const ShapeAttributes placed = placed_look(look, name, p.place);
  if (type == "sphere" || type == "bubble") {
    need(p, 4);
    const double r = p.arguments.reals[3];
    if (r == 0) p.place.fail(type + " without radius");
    const bool is_inward = ((type == "bubble") != (r < 0)) != is_inverted;
    placer_.add_sphere(p.world, vector_at(p, 0), std::abs(r), is_inward, placed);
  } else if (type == "ring") {
    add_ring(p, placed, is_inverted);
  } else {
    add_cone(p, placed, is_inverted);
  }
}

}  // namespace troffer
