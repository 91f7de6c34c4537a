// Queries on imported scenes, for tests.
#pragma once

#include <string>

#include "import/mesh_clean.h"
#include "scene/scene.h"

namespace troffer {

inline bool has_warning(const Scene& scene, const std::string& part) {
  for (const Warning& w : scene.warnings.entries())
    if (w.text.find(part) != std::string::npos) return true;
  return false;
}

inline bool is_near(const Vec3& a, const Vec3& b, float tolerance = 1e-5f) {
  return length(a - b) <= tolerance;
}

// Returns the unit normal of a flat light's front.
inline Vec3 front_of(const Scene& scene, const Light& e) {
  if (e.kind == LightKind::disk) return scene.disks.at(e.geometry).normal;
  const Mesh& mesh = scene.meshes.at(e.geometry);
  return Vec3(normalize(area_vector(mesh, mesh.triangles.at(e.triangles.at(0)))));
}

}  // namespace troffer
