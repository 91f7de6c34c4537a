// Texture coordinates for pbrt, which has one set per mesh, with v up.
//
// pbrt looks up a normal map at (u, 1 - v), repeated, and an emission image at (u, 1 - v), clamped
// [1]. Only "imagemap" textures have scale and offset, and none has a rotation. The coordinates are
// therefore written to fit the image that cannot be moved, and other images are placed relative to
// them.
//
// References: [1] pbrt-v4, materials.h (NormalMap), lights.h (DiffuseAreaLight::L), textures.h
//   (ImageTextureBase), util/image.h (BilerpChannel).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "export/texture_look.h"

namespace troffer {

// Linear map of (u,v) with an offset.
struct UvMap {
  Vec2d along_u{1, 0}, along_v{0, 1}, offset;

  Vec2d operator()(const Vec2& uv) const {
    return along_u * double(uv.x) + along_v * double(uv.y) + offset;
  }
};

class PbrtUvs {
 public:
  // Chooses coordinates for a material and the light on it (null: none). Warns of what one set
  // cannot express.
  PbrtUvs(const Scene& scene, const MaterialUvs& uvs, uint32_t material, const Light* light,
          WarningLog& warnings);

  // Returns the coordinates to write for a mesh; empty if nothing uses them and the mesh has none.
  std::vector<Vec2> of(const Mesh& mesh) const;
  bool is_second() const { return is_second_; }
  bool has_normals() const { return normal_.has_value(); }

  // Looks of the normal and emission images; written with them, these images need no placement.
  const Texture& normal() const { return *normal_; }
  const Texture& emission() const { return *emission_; }
  // Returns the signs of the normal map's x and y in pbrt's tangent frame (x along u, y = normal ×
  // x). is_turned: for triangles whose (u,v) run clockwise.
  Vec2 normal_signs(bool is_turned, bool is_v_up) const;
  // True if a triangle's (u,v) in the written set run clockwise.
  bool is_turned(const Mesh& mesh, const Triangle& t) const;

  // Look of an image texture that pbrt can place, and the parameters of the placement.
  struct Placing {
    Texture look;
    std::string parameters;
  };
  std::optional<Placing> placing(std::span<const int32_t> textures);

 private:
  const Scene& scene_;
  const MaterialUvs& uvs_;
  uint32_t material_;
  WarningLog& warnings_;
  bool is_second_ = false, is_used_ = false;
  UvMap written_;                             // maps a mesh's (u,v) of the used set
  std::optional<Texture> normal_, emission_;  // looks

  void choose_set(const std::vector<int32_t>& textures);
  void place_fixed(const std::vector<int32_t>& others);
  void lead(const Texture& look);
  UvMap relative(const Texture& look) const;
};

}  // namespace troffer
