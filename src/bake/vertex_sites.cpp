#include "bake/vertex_sites.h"

#include <algorithm>

#include "bake/atlas.h"

namespace troffer {

VertexSites::VertexSites(const BakedSurfaces& surfaces) : surfaces_(surfaces) {
  for (const ChartedMesh& charted : surfaces.charted) {
    Corners c;
    const Mesh& mesh = charted.mesh;
    c.first.assign(mesh.positions.size() + 1, 0);
    for (const Triangle& t : mesh.triangles)
      for (const uint32_t v : t) ++c.first[v + 1];
    for (size_t v = 1; v < c.first.size(); ++v) c.first[v] += c.first[v - 1];
    c.triangles.resize(3 * mesh.triangles.size());
    std::vector<size_t> next = c.first;
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
      for (const uint32_t v : mesh.triangles[t]) c.triangles[next[v]++] = t;
    corners_.push_back(std::move(c));
  }
  first_of_stand_.push_back(0);
  for (const Stand& s : surfaces.stands)
    first_of_stand_.push_back(first_of_stand_.back() +
                              surfaces.charted[s.charted].mesh.positions.size());
}

void VertexSites::pieces(size_t site, std::vector<Piece>& out) const {
  const auto after = std::upper_bound(first_of_stand_.begin(), first_of_stand_.end(), site);
  const auto number = size_t(after - first_of_stand_.begin()) - 1;
  const Stand& stand = surfaces_.stands[number];
  const MeshInWorld mesh = surfaces_.mesh(stand);
  const auto vertex = uint32_t(site - first_of_stand_[number]);
  const Corners& corners = corners_[stand.charted];
  for (size_t i = corners.first[vertex]; i < corners.first[vertex + 1]; ++i) {
    Piece piece = piece_of(mesh, corners.triangles[i]);
    const Triangle t = mesh.triangle(corners.triangles[i]);
    const auto k = size_t(std::find(t.begin(), t.end(), vertex) - t.begin()) % 3;
    std::rotate(piece.positions.begin(), piece.positions.begin() + std::ptrdiff_t(k),
                piece.positions.end());
    std::rotate(piece.normals.begin(), piece.normals.begin() + std::ptrdiff_t(k),
                piece.normals.end());
    const auto& p = piece.positions;
    piece.weight = length(cross(Vec3d(p[1]) - Vec3d(p[0]), Vec3d(p[2]) - Vec3d(p[0])));
    piece.is_about_corner = true;
    if (piece.weight > 0) out.push_back(piece);
  }
}

}  // namespace troffer
