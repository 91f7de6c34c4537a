// Commands in Radiance files (xform and genbox), interpreted without running anything. Used by
// RadianceReader, and by RadianceFunctions for transform options.
//
// References: [1] Radiance manual pages xform(1), genbox(1).
#pragma once

#include <string>
#include <vector>

#include "base/transform.h"
#include "import/radiance/radiance_text.h"

namespace troffer {

// Result of xform(1)'s options.
struct RadianceXform {
  std::vector<Affine> copies{Affine()};  // one transform, or all of its arrays
  std::string modifier;                  // -m: replaces that of all surfaces; "" keeps their own
  bool is_inverted = false;              // -I: swaps the fronts and backs of surfaces
  std::vector<std::string> files;
};
// Parses the words after "xform". Throws InputError, at `place`, for unknown options and more than
// 100 000 copies.
RadianceXform parse_xform(const std::vector<std::string>& words, const SourcePlace& place);

// A box of genbox(1): its material and polygons. Corners run counterclockwise as seen from the
// front.
struct RadianceBox {
  std::string modifier;
  std::vector<std::vector<Vec3d>> polygons;
  bool is_simplified = false;  // rounded or bevelled edges are left sharp
};
RadianceBox parse_genbox(const std::vector<std::string>& words, const SourcePlace& place);

}  // namespace troffer
