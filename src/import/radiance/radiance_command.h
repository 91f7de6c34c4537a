// Commands in Radiance's files that are done here, and never by running anything.
//
// References: [1] Radiance manual pages xform(1), genbox(1).
#pragma once

#include <string>
#include <vector>

#include "base/transform.h"
#include "import/radiance/radiance_text.h"

namespace troffer {

// What xform(1)'s options say.
struct RadianceXform {
  std::vector<Affine> copies{Affine()};  // one, or all of its arrays
  std::string modifier;                  // -m: of all surfaces; "" = their own
  bool is_inverted = false;              // -I: fronts and backs of surfaces change places
  std::vector<std::string> files;
};
// `words` after "xform". InputError at `place`: unknown options, more than 100 000 copies.
RadianceXform parse_xform(const std::vector<std::string>& words, const SourcePlace& place);

// The boxes of genbox(1): a material and polygons, each of corners that run counterclockwise about
// its front.
struct RadianceBox {
  std::string modifier;
  std::vector<std::vector<Vec3d>> polygons;
  bool is_simplified = false;  // rounded or bevelled edges are left sharp
};
RadianceBox parse_genbox(const std::vector<std::string>& words, const SourcePlace& place);

}  // namespace troffer
