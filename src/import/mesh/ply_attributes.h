// Numbers that PLY files carry per vertex or per face beside places, normals and (u,v), under the
// names that Mitsuba gives them.
//
// References: [1] W. Jakob et al., "Mitsuba 3 documentation: Shapes" (ply: names of attributes).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace troffer {

struct PlyAttribute {
  std::string name;  // "vertex_color", "face_weight": what the last _ of a name parts is joined
  bool is_of_faces = false;
  size_t channels = 1;        // 1, 3 or 4
  std::vector<float> values;  // per vertex, or per triangle of read_ply(): channels numbers each
};

// All of them. Integers are read as sRGB, their type's largest number as 1. InputError: as
// read_ply().
std::vector<PlyAttribute> read_ply_attributes(const std::string& path);

}  // namespace troffer
