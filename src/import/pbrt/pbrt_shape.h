// pbrt shapes in object space, as Shape directives describe them. PbrtInterpreter reads them and
// PbrtPlacer puts them into the scene.
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

// An AreaLightSource directive.
struct PbrtAreaLight {
  Rgb radiance;      // times scale, W/(m² sr)
  double power = 0;  // total W; if > 0, it sets the radiance, and `radiance` is a factor on that
  bool is_two_sided = false;
  std::string image;  // image that scales the radiance over (u,v); "" if none
};

enum class PbrtShapeKind { mesh, sphere, disk };

struct PbrtShape {
  std::string type;  // for messages
  PbrtShapeKind kind = PbrtShapeKind::mesh;
  double radius = 1, height = 0;             // whole spheres and disks
  std::shared_ptr<const AnchoredMesh> mesh;  // everything else
  bool is_quadric = false;                   // the mesh's normals follow the rule of quadrics
  std::optional<FloatInput> alpha;           // coverage, if it may be below 1
  Rgb absorption{0};                         // absorption of the medium inside, per metre
  Affine world_from_object;
  bool is_reversed = false;  // ReverseOrientation
  std::shared_ptr<PbrtMaterial> material;
  std::shared_ptr<const PbrtAreaLight> light;
};

// Reads the geometry of a Shape directive into `shape` (the fields before world_from_object).
// `shines` says that it is an area light. Returns false, with a warning that says why, if there is
// nothing to show. Throws InputError for unusable parameters, indices out of range and unreadable
// PLY files.
bool read_pbrt_shape(const std::string& type, const PbrtParams& params, bool shines,
                     PbrtTextures& textures, WarningLog& warnings, PbrtShape& shape);

}  // namespace troffer
