// pbrt shapes in object space, as the Shape directive describes them.
//
// References: [1] pbrt-v4 Input File Format, section "Shapes", pbrt.org/fileformat-v4.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/transform.h"
#include "import/pbrt/pbrt_material.h"
#include "import/recentre.h"

namespace troffer {

// Most triangles of one scene, all instances counted.

// What an AreaLightSource directive says.
struct PbrtAreaLight {
  Rgb radiance;      // with scale
  double power = 0;  // W in all, where > 0: then radiance is a factor on what gives that power
  bool is_two_sided = false;
  std::string image;  // file of a factor on radiance over (u,v); "" = none
};

enum class PbrtShapeKind { mesh, sphere, disk };

struct PbrtShape {
  std::string type;  // for messages
  PbrtShapeKind kind = PbrtShapeKind::mesh;
  double radius = 1, height = 0;             // whole spheres and disks
  std::shared_ptr<const AnchoredMesh> mesh;  // everything else
  bool is_quadric = false;                   // normals of the mesh follow the rule of quadrics
  std::optional<FloatInput> alpha;           // the share of rays that meet it, where below 1
  Rgb absorption{0};                         // of the medium inside
  Affine world_from_object;
  bool is_reversed = false;  // ReverseOrientation
  std::shared_ptr<PbrtMaterial> material;
  std::shared_ptr<const PbrtAreaLight> light;
};

// Reads the geometry of a Shape directive into `shape` (the fields above world_from_object).
// shines: it is an area light.
// False: there is nothing to show, and a warning says why. InputError: parameters that cannot be
// used, indices out of range, unreadable PLY files.
bool read_pbrt_shape(const std::string& type, const PbrtParams& params, bool shines,
                     PbrtTextures& textures, WarningLog& warnings, PbrtShape& shape);

}  // namespace troffer
