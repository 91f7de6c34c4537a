#include "lighting/portal_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/suggestion.h"
#include "lighting/option_text.h"
#include "scene/names.h"
#include "scene/portal_corners.h"

namespace troffer {

namespace {

using Corners = std::vector<Vec3>;

// Relative tolerance within which rectangles count as coplanar or adjacent.
constexpr double portal_tolerance = 1e-3;

bool is_glass(const Scene& scene, const Mesh& mesh) {
  const Material& m = scene.materials[mesh.material];
  return m.kind == MaterialKind::dielectric || m.kind == MaterialKind::angular ||
         m.transmission.value > 0;
}

// Removes opaque parts that only mark a portal, so that they occlude nothing. Panes and emitting
// meshes stay.
void take_out_opaque(Scene& scene, const std::string& name) {
  for (Mesh& mesh : scene.meshes)
    if (mesh.name == name && !is_glass(scene, mesh) && mesh.lights.empty()) mesh.triangles.clear();
}

Corners parse_portal(const Scene& scene, const std::string& text, bool& is_name) {
  is_name = false;
  std::vector<double> v;
  for (const std::string& part : split_text(text, ',')) {
    const std::optional<double> number = parse_number(part);
    if (!number) is_name = true;
    v.push_back(number.value_or(0));
  }
  if (is_name) {
    const auto corners = rectangle_of_meshes(scene, text);
    if (!corners)
      throw UsageError("--portal: '" + text +
                       "' is neither twelve numbers nor the name of a flat rectangle" +
                       did_you_mean(text, node_names(scene)));
    return *corners;
  }
  std::vector<Vec3d> p;
  for (size_t i = 0; i + 2 < v.size(); i += 3)
    p.push_back(Vec3d{v[i], v[i + 1], v[i + 2]} - scene.origin);
  if (v.size() != 12 || !is_rectangle(p))
    throw UsageError("--portal: '" + text + "' is not a rectangle of four corners x,y,z, …");
  return {Vec3(p[0]), Vec3(p[1]), Vec3(p[2]), Vec3(p[3])};
}

Vec3d outward(const Corners& c) {
  return normalize(cross(Vec3d(c[3] - c[0]), Vec3d(c[1] - c[0])));
}

double size_of(const Corners& c) {
  return double(length(c[1] - c[0])) + double(length(c[3] - c[0]));
}

// Returns the minimum and maximum of the corners along an axis.
std::array<double, 2> extent(const Corners& c, const Vec3d& from, const Vec3d& axis) {
  std::array<double, 2> e{INFINITY, -INFINITY};
  for (const Vec3& p : c) {
    const double at = dot(Vec3d(p) - from, axis);
    e = {std::min(e[0], at), std::max(e[1], at)};
  }
  return e;
}

// True if two coplanar rectangles share more than edges.
bool overlap(const Corners& a, const Corners& b, double margin) {
  const Vec3d from(a[0]);
  for (const Corners& c : {a, b})
    for (const size_t k : {size_t(1), size_t(3)}) {
      const Vec3d axis = normalize(Vec3d(c[k] - c[0]));
      const auto x = extent(a, from, axis), y = extent(b, from, axis);
      if (x[1] <= y[0] + margin || y[1] <= x[0] + margin) return false;
    }
  return true;
}

// True if a ray can leave through `first` and then through `second`, so that both count its light.
bool may_leave_through_both(const Corners& first, const Corners& second, double margin) {
  const Vec3d z1 = outward(first), z2 = outward(second);
  if (dot(z1, z2) < -1 + 1e-9) return false;
  return extent(second, Vec3d(first[0]), z1)[1] > margin &&
         extent(first, Vec3d(second[0]), z2)[0] < -margin;
}

void check_pair(Scene& scene, const Corners& a, const Corners& b) {
  const double margin = portal_tolerance * std::min(size_of(a), size_of(b));
  const Vec3d z = outward(a);
  const auto off = extent(b, Vec3d(a[0]), z);
  if (dot(z, outward(b)) > 0 && std::max(-off[0], off[1]) < margin) {
    if (overlap(a, b, margin)) throw UsageError("--portal: two rectangles overlap");
  } else if (may_leave_through_both(a, b, margin) || may_leave_through_both(b, a, margin)) {
    scene.warnings.add(
        "--portal: one rectangle lies beyond another; light that comes through both "
        "counts twice");
  }
}

// Warns of blinds, reveals and ground beyond all portals: they stay dark and reflect nothing into
// the room, which can be half of the light where there are blinds.
void warn_of_what_is_beyond(Scene& scene, const std::vector<Corners>& portals) {
  const auto is_beyond = [&](const Vec3& p) {
    return std::all_of(portals.begin(), portals.end(), [&](const Corners& c) {
      return dot(Vec3d(p) - Vec3d(c[0]), outward(c)) > portal_tolerance * size_of(c);
    });
  };
  size_t n = 0;
  for (const Mesh& mesh : scene.meshes) {
    if (is_glass(scene, mesh)) continue;
    n += size_t(std::count_if(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
      return std::all_of(t.begin(), t.end(),
                         [&](uint32_t v) { return is_beyond(mesh.positions[v]); });
    }));
  }
  if (n > 0)
    scene.warnings.add(fmt::format(
        "--portal: {} triangles lie outside it, where its light does not reach them, so they "
        "reflect none into the room: place it outside of blinds, reveals and ground",
        n));
}

}  // namespace

void add_portals(Scene& scene, const std::vector<std::string>& texts) {
  if (texts.empty()) return;
  std::vector<Corners> portals;
  std::vector<std::string> names;
  for (const std::string& text : texts) {
    bool is_name = false;
    portals.push_back(parse_portal(scene, text, is_name));
    if (is_name) names.push_back(text);
  }
  for (size_t i = 0; i < portals.size(); ++i)
    for (size_t j = 0; j < i; ++j) check_pair(scene, portals[j], portals[i]);
  for (const std::string& name : names) take_out_opaque(scene, name);
  bool is_used = false;
  // Copies are appended, because meshes refer to lights by index.
  const size_t before = scene.lights.size();
  for (size_t i = 0; i < before; ++i) {
    Light e = scene.lights[i];
    if (has_surface(e.kind) || is_delta(e.kind) || !e.portal.empty()) continue;
    scene.lights[i].portal = portals[0];
    for (size_t k = 1; k < portals.size(); ++k) {
      e.portal = portals[k];
      scene.lights.push_back(e);
    }
    is_used = true;
  }
  if (is_used) warn_of_what_is_beyond(scene, portals);
  if (!is_used) scene.warnings.add("--portal does nothing without an environment light");
}

}  // namespace troffer
