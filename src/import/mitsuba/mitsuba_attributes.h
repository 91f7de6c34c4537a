// Mitsuba's textures of type mesh_attribute: numbers per vertex or face of one shape.
//
// Each triangle gets vertices of its own and 2 x 2 texels of an image, whose bilinear mean is the
// linear one between its three corners.
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
  // Reads attributes of the mesh that read_ply() made of the file; `scene` must outlive this.
  // has_images: other textures of its looks use the mesh's (u,v), so that attributes go by the
  // second ones.
  MitsubaAttributes(std::string ply_file, const Mesh& mesh, bool has_images, Scene& scene)
      : file_(std::move(ply_file)),
        triangles_(mesh.triangles),
        has_images_(has_images),
        scene_(scene) {}

  // Texture that shows the attribute of that name; nothing where the shape has none.
  std::optional<int32_t> texture(const std::string& name);
  // Number of textures asked for.
  size_t uses() const { return uses_; }
  // Gives the mesh the (u,v) that its textures are looked up by, the first time.
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

// Gives every triangle vertices of its own with (u,v) = (0,0), (1,0), (0,1): what Mitsuba has for
// meshes without coordinates.
void add_corner_uvs(Mesh& mesh);

}  // namespace troffer
