// Triangles of an OBJ file, grouped by object, group and material. Each part has vertices of its
// own, one for each combination of position, (u,v) and normal. obj.cpp fills ObjParts in the order
// of the file and turns each part into a mesh.
#pragma once

#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "import/mesh/obj_piece.h"

namespace troffer {

// Triangles of one object, group and material.
struct ObjPart {
  std::string name, material;
  std::vector<Triangle> triangles;
  // A vertex: the indices it is made of, and the next vertex with the same position.
  struct Vertex {
    ObjCorner corner;
    uint32_t next = obj_nothing;
  };
  std::vector<Vertex> vertices;
  bool has_uvs = false, has_normals = false;
  bool is_painted = false;  // has vertices from after the first coloured one in the file
};

// Sorts triangles into parts.
class ObjParts {
 public:
  // Set the names for the triangles that follow.
  void set_object(std::string name);
  void set_group(std::string name);
  void set_material(std::string name);
  void begin_colors() { has_colors_ = true; }

  // Adds triangles, three corners each. All position indices must be below `positions`.
  void add(const ObjCorner* corners, size_t triangles, size_t positions);

  std::vector<std::unique_ptr<ObjPart>>& all() { return all_; }

 private:
  // First vertex of the current part at a position; valid if the stamp is the part's.
  struct First {
    uint32_t stamp = 0, vertex = obj_nothing;
  };
  std::string object_, group_, material_;
  bool has_colors_ = false;
  std::vector<std::unique_ptr<ObjPart>> all_;
  std::unordered_map<std::string, ObjPart*> by_key_;
  ObjPart* current_ = nullptr;  // part of the current names; null after a change of names
  std::vector<First> firsts_;
  uint32_t stamp_ = 0;

  void select();
  uint32_t vertex_of(const ObjCorner& corner);
};

}  // namespace troffer
