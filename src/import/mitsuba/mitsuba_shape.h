// Converts Mitsuba's shape plugins to geometry in object space. Used by MitsubaReader, which
// applies to_world. Mesh files are OBJ, PLY and .serialized.
//
// References: [1] W. Jakob et al., "Mitsuba 3 documentation: Shapes"; [2] W. Jakob, "Mitsuba 0.6
//   Documentation", §8.1 (Shapes). [3] T. Duff et al., "Building an Orthonormal Basis, Revisited",
//   JCGT 6(1), 2017.
#pragma once

#include <memory>
#include <optional>

#include "import/mitsuba/mitsuba_tree.h"
#include "import/recentre.h"
#include "scene/scene.h"

namespace troffer {

enum class MitsubaShapeKind { mesh, sphere, disk };

struct MitsubaShape {
  MitsubaShapeKind kind = MitsubaShapeKind::mesh;
  AnchoredMesh mesh;
  Vec3d centre;
  double radius = 1;
  bool is_turned = false;  // flip_normals
  // For a mesh without normals: a mirroring transform keeps the front, instead of following the
  // winding in the world.
  bool keeps_side = false;
};

// The unit disk as triangles with Mitsuba's (u,v): distance from the centre, and azimuth / 2π.
Mesh mitsuba_disk();

// Part of an OBJ file: the faces of the material `name`, spelled like MitsubaNode::name. With an
// empty name, the faces whose material is not in `others`.
struct MitsubaObjPart {
  std::string name;
  std::vector<std::string> others;
};

class MitsubaShapes {
 public:
  // Both must outlive this object.
  MitsubaShapes(const MitsubaTree& tree, WarningLog& warnings) : tree_(tree), warnings_(warnings) {}

  // Returns the geometry of a <shape> without its to_world; of an OBJ file only `part`, if given.
  // Returns nothing, with a warning, for unsupported shapes. Throws InputError for unusable
  // parameters or files.
  std::optional<MitsubaShape> read(const MitsubaNode& node, const MitsubaObjPart* part = nullptr);
  // Path of the file that a shape names. Throws InputError if the file must not be used.
  std::string file_path(const MitsubaNode& node);

 private:
  const MitsubaTree& tree_;
  WarningLog& warnings_;
  // The last file of serialized meshes: many consecutive shapes come from one file.
  struct LastFile {
    std::string path;
    std::vector<uint8_t> bytes;
  } last_file_;

  // The last OBJ file: its parts may have different bsdfs.
  struct LastObj {
    std::string path;
    Scene scene;
  } last_obj_;

  AnchoredMesh read_mesh_file(const MitsubaNode& node, const MitsubaObjPart* part);
  AnchoredMesh read_obj(const std::string& path, const MitsubaObjPart* part);
};

}  // namespace troffer
