// Mitsuba's shape plugins -> geometry, in spaces of their own.
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
  // The front of a mesh without normals is the side that the transform takes its winding's to, not
  // that of its winding in the world.
  bool keeps_side = false;
};

// The unit disk as triangles with Mitsuba's (u,v): distance from the middle, and azimuth over a
// turn.
Mesh mitsuba_disk();

// Of an OBJ file what is of one material, told by its name as MitsubaNode::name has it; of no name
// what is of none of `others`.
struct MitsubaObjPart {
  std::string name;
  std::vector<std::string> others;
};

class MitsubaShapes {
 public:
  // Both must outlive this.
  MitsubaShapes(const MitsubaTree& tree, WarningLog& warnings) : tree_(tree), warnings_(warnings) {}

  // The geometry of a <shape>, without its to_world; nothing, with a warning that names it, where
  // it is not supported. InputError: parameters or files that cannot be used.
  // Of an OBJ file all of it, or that part.
  std::optional<MitsubaShape> read(const MitsubaNode& node, const MitsubaObjPart* part = nullptr);
  // The file that a shape names. InputError: it may not be used.
  std::string file_path(const MitsubaNode& node);

 private:
  const MitsubaTree& tree_;
  WarningLog& warnings_;
  // The file of serialized meshes that was read last: many shapes in a row come from one.
  struct LastFile {
    std::string path;
    std::vector<uint8_t> bytes;
  } last_file_;

  // The OBJ file that was read last: its parts may be of many bsdfs.
  struct LastObj {
    std::string path;
    Scene scene;
  } last_obj_;

  AnchoredMesh read_mesh_file(const MitsubaNode& node, const MitsubaObjPart* part);
  AnchoredMesh read_obj(const std::string& path, const MitsubaObjPart* part);
};

}  // namespace troffer
