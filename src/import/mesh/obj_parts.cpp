#include "import/mesh/obj_parts.h"

#include <algorithm>

namespace troffer {

void ObjParts::set_object(std::string name) {
  object_ = std::move(name);
  group_.clear();
  current_ = nullptr;
}

void ObjParts::set_group(std::string name) {
  group_ = std::move(name);
  current_ = nullptr;
}

void ObjParts::set_material(std::string name) {
  material_ = std::move(name);
  current_ = nullptr;
}

void ObjParts::select() {
  std::string key = object_;
  key.append(1, '\0').append(group_).append(1, '\0').append(material_);
  ObjPart*& part = by_key_[key];
  if (!part) {
    all_.push_back(std::make_unique<ObjPart>());
    part = all_.back().get();
    part->material = material_;
    part->name = group_.empty() ? object_ : group_;
  }
  current_ = part;
  ++stamp_;
}

uint32_t ObjParts::vertex_of(const ObjCorner& corner) {
  ObjPart& part = *current_;
  First& first = firsts_[corner.position];
  if (first.stamp != stamp_) first = {stamp_, obj_nothing};
  for (uint32_t v = first.vertex; v != obj_nothing; v = part.vertices[v].next) {
    const ObjCorner& other = part.vertices[v].corner;
    if (other.uv == corner.uv && other.normal == corner.normal) return v;
  }
  const auto vertex = uint32_t(part.vertices.size());
  part.vertices.push_back({corner, first.vertex});
  first.vertex = vertex;
  part.is_painted = part.is_painted || has_colors_;
  part.has_uvs = part.has_uvs || corner.uv != obj_nothing;
  part.has_normals = part.has_normals || corner.normal != obj_nothing;
  return vertex;
}

void ObjParts::add(const ObjCorner* corners, size_t triangles, size_t positions) {
  if (triangles == 0) return;
  if (current_ == nullptr) select();
  // Doubling avoids a reallocation per group in files that interleave groups and vertices.
  if (firsts_.size() < positions) firsts_.resize(std::max(positions, firsts_.size() * 2));
  for (size_t i = 0; i < triangles; ++i, corners += 3) {
    Triangle t;
    for (size_t k = 0; k < 3; ++k) t[k] = vertex_of(corners[k]);
    current_->triangles.push_back(t);
  }
}

}  // namespace troffer
