// Tensor trees: Radiance's adaptive tables of scattering over pairs of directions, on squares that
// map to disks of projected directions. window_xml.h reads files with them.
//
// References: [1] Ward, Kurt, Bonneel, "Reducing Anisotropic BSDF Measurement to Common Practice",
//   MAM 2014; Radiance, src/common/bsdf_t.c (layout). [2] Shirley & Chiu, "A Low Distortion Map
//   Between Disk and Square", JGT 2(3), 1997.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "scene/angular_bsdf.h"

namespace troffer {

class TensorTree {
 public:
  // Parses nested braces. dimensions: 3 for isotropic surfaces, 4 for others. Returns the reason in
  // `problem` if the text is malformed.
  TensorTree(const std::string& text, int dimensions, std::string& problem);

  // Means over the patches of a basis.
  AngleMatrix reduced_to(const AngleBasis& basis) const;

 private:
  struct Node {
    int log2_side = -1;         // of the grid of values; -1: branches
    std::vector<float> values;  // last dimension fastest
    std::vector<Node> branches;
  };
  int dimensions_;
  int depth_ = 0;  // log2 of the finest cells along an axis
  Node root_;

  bool parse(const char*& at, const char* end, int level, Node& node, std::string& problem);
  bool parse_values(const char*& at, const char* end, int level, Node& node, std::string& problem);
  float value(std::array<double, 4> position) const;  // the first dimensions_ count
  float value(const Vec3& in, const Vec3& out) const;
};

}  // namespace troffer
