#include "import/surface_emission.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/units.h"

namespace troffer {

namespace {

// Returns the area of a light, m²; 0 for spheres and disks, which glTF does not have.
double emitting_area(const Scene& scene, const Light& e) {
  if (e.kind != LightKind::polygon && e.kind != LightKind::mesh) return 0;
  const Mesh& mesh = scene.meshes[e.geometry];
  double area = 0;
  for (const uint32_t t : e.triangles) {
    const Triangle& v = mesh.triangles[t];
    const Vec3d a(mesh.positions[v[0]]), b(mesh.positions[v[1]]), c(mesh.positions[v[2]]);
    area += 0.5 * length(cross(b - a, c - a));
  }
  return area;
}

}  // namespace

void scale_surface_emission(Scene& scene, double factor) {
  if (!std::isfinite(factor) || factor < 0)
    throw UsageError("--emission-scale: a number of at least 0 expected");
  if (factor == 1) return;
  for (Light& e : scene.lights)
    if (has_surface(e.kind) && e.web == no_web) e.radiance *= float(factor);
}

void warn_of_weak_surfaces(Scene& scene) {
  constexpr double least_luminance = 100, least_area = 0.05;  // cd/m², m²
  constexpr double least_share = 0.01;
  if (!scene.is_photometric) return;
  double surfaces_lm = 0, lamps_lm = 0, area = 0, brightest = 0;
  for (const Light& e : scene.lights) {
    const double strength = double(luminance(e.radiance));
    if (e.kind == LightKind::point) lamps_lm += 4 * pi * strength;
    if (e.kind == LightKind::spot) lamps_lm += 2 * pi * (1 - double(e.cos_outer)) * strength;
    if (!has_surface(e.kind) || e.web != no_web || !(strength > 0)) continue;
    const double own = emitting_area(scene, e);
    area += own;
    surfaces_lm += own * pi * strength * (e.is_two_sided ? 2 : 1);
    brightest = std::max(brightest, strength);
  }
  if (area < least_area || brightest >= least_luminance || surfaces_lm >= least_share * lamps_lm)
    return;
  scene.warnings.add(fmt::format(
      "surfaces emit {:.3g} lm in all, {:.3g} cd/m2 at most, beside {:.4g} lm of lamps: Blender "
      "exports emission without the factor 683 that lamps get (--emission-scale 683; "
      "docs/guide/from-blender.md)",
      surfaces_lm, brightest, lamps_lm));
}

}  // namespace troffer
