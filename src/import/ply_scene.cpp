#include "import/ply_scene.h"

#include "import/limits.h"
#include "import/mesh_clean.h"
#include "import/ply.h"
#include "import/recentre.h"

namespace troffer {

namespace {}  // namespace

Scene import_ply(const std::string& path) {
  return import_recentred([&](Scene& scene, PlacedBounds& bounds) {
    scene.file = path;
    AnchoredMesh read = read_ply(path, scene.warnings, max_scene_triangles);
    Mesh& mesh = read.mesh;
    const Vec3d shift = read.anchor - scene.origin;
    const auto placed = [&](uint32_t v) { return Vec3d(mesh.positions[v]) + shift; };
    for (const Triangle& t : mesh.triangles)
      bounds.add_triangle(placed(t[0]), placed(t[1]), placed(t[2]));
    for (Vec3& p : mesh.positions) p = Vec3(Vec3d(p) + shift);
    show_alone(std::move(mesh), scene);
  });
}

}  // namespace troffer
