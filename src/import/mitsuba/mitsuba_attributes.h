// Textures of Mitsuba's type mesh_attribute: values per vertex or face of one shape. Used by
// MitsubaReader and MitsubaTextures.
//
// Each triangle gets its own vertices and 2 x 2 texels of an image. Bilinear interpolation of these
// texels equals linear interpolation between the triangle's corners.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "import/mesh/ply_attributes.h"
#include "scene/scene.h"

namespace troffer {

class MitsubaAttributes {
 public:
  // Reads attributes of the mesh that read_ply() made from the file. `scene` must outlive this
  // object. has_images: other textures of the shape use the mesh's (u,v), so attributes use its
  // second (u,v).
  MitsubaAttributes(std::string ply_file, const Mesh& mesh, bool has_images, Scene& scene)
      : file_(std::move(ply_file)),
        triangles_(mesh.triangles),
        has_images_(has_images),
        scene_(scene) {}

  // Returns the texture of the attribute of that name, or nothing if the shape has none.
  std::optional<int32_t> texture(const std::string& name);
  // Number of textures that have been requested.
  size_t uses() const { return uses_; }
  // Gives the mesh the (u,v) of its attribute textures. Only the first call has an effect.
  void finish(Mesh& mesh);

 private:
  std::string file_;
  std::vector<Triangle> triangles_;
  bool has_images_;
  Scene& scene_;
  size_t uses_ = 0;
  bool is_read_ = false, is_finished_ = false;
  std::vector<PlyAttribute> attributes_;
  std::map<std::string, int32_t> made_;

  int32_t make(const PlyAttribute& attribute);
};

// Gives every triangle its own vertices with (u,v) = (0,0), (1,0), (0,1), as Mitsuba does for
// meshes without texture coordinates.
void add_corner_uvs(Mesh& mesh);

}  // namespace troffer
