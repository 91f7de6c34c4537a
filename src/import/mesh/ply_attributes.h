// Numbers per vertex or per face in PLY files, besides positions, normals and (u,v). Attributes
// have the names that Mitsuba gives them; its importer uses them as textures.
//
// References: [1] W. Jakob et al., "Mitsuba 3 documentation: Shapes" (ply: names of attributes).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace troffer {

struct PlyAttribute {
  std::string name;  // "vertex_color", "face_weight"; properties that differ only after their last
                     // _ are joined
  bool is_of_faces = false;
  size_t channels = 1;        // 1 to 4
  std::vector<float> values;  // `channels` numbers per vertex, or per triangle of read_ply()
};

// Reads all attributes. Integers are decoded from sRGB, with their type's largest value as 1.
// Throws InputError as read_ply() does.
std::vector<PlyAttribute> read_ply_attributes(const std::string& path);

}  // namespace troffer
