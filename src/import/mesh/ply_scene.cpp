#include "import/mesh/ply_scene.h"

#include "base/parallel.h"
#include "import/limits.h"
#include "import/mesh/ply.h"
#include "import/mesh_clean.h"
#include "import/recentre.h"

namespace troffer {

Scene import_ply(const std::string& path, const TellProgress& progress) {
  return import_recentred([&](Scene& scene, PlacedBounds& bounds) {
    scene.file = path;
    AnchoredMesh read =
        read_ply(path, scene.warnings,
                 {.max_triangles = max_scene_triangles, .pieces = {.progress = progress}});
    Mesh& mesh = read.mesh;
    const Vec3d shift = read.anchor - scene.origin;
    const auto placed = [&](uint32_t v) { return Vec3d(mesh.positions[v]) + shift; };
    bounds.add_triangles(mesh.triangles, placed);
    parallel_pieces(mesh.positions.size(), size_t(1) << 16, [&](size_t first, size_t end) {
      for (size_t i = first; i < end; ++i) mesh.positions[i] = Vec3(placed(uint32_t(i)));
    });
    add_only_mesh(std::move(mesh), scene);
  });
}

}  // namespace troffer
