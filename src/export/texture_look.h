// Placement of images on surfaces, so that all textures of a material input can be written as one
// image.
//
// A "look" is a Texture of kind image without texels: size, wrapping, filter, and the mapping from
// a mesh's (u,v) to the image.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace troffer {

// Bounds of texture coordinates.
struct UvBox {
  static constexpr float inf = std::numeric_limits<float>::infinity();
  Vec2 lower{inf, inf}, upper{-inf, -inf};

  bool is_empty() const { return !(lower.x <= upper.x); }
  void add(const Vec2& uv);
};

// Bounds of the texture coordinates on the meshes of each material.
class MaterialUvs {
 public:
  explicit MaterialUvs(const Scene& scene);
  // Returns [0,1]² if no mesh has the material or coordinates.
  UvBox of(uint32_t material, bool is_second) const;

 private:
  std::vector<std::array<UvBox, 2>> boxes_;  // per material: first and second set
};

// True for an image or a product with one.
bool has_image(const Scene& scene, int32_t texture);

// Returns the look of an image texture.
Texture look_of(const Texture& image);

// True if both show the same texel at the same position.
bool is_same_place(const Texture& a, const Texture& b);

// Returns the position in an image, v down, of a mesh's (u,v).
Vec2 place_in_image(const Texture& look, const Vec2& uv);
// Returns the (u,v) of the centre of a texel.
Vec2 uv_of_texel(const Texture& look, int x, int y);

// Returns the bounds of positions in the image over a box of (u,v).
UvBox places_over(const Texture& look, const UvBox& uvs);

// Returns the look of the image repeated by its wrapping until it covers `uvs`, with a border of
// one texel. Nothing for rotated images and if the result is too large.
std::optional<Texture> tiled(const Texture& look, const UvBox& uvs);
// Returns the look of an image over the box, about as fine as `look`.
Texture look_over(const Texture& look, const UvBox& uvs);

// Common look of all images in some textures (of one set of coordinates; patterns do not count).
struct CommonLook {
  Texture look;
  bool is_resampled = false;  // placements differ: `look` covers the box of (u,v)
};
std::optional<CommonLook> common_look(const Scene& scene, std::span<const int32_t> textures,
                                      const MaterialUvs& uvs, uint32_t material);

}  // namespace troffer
