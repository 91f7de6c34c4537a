// How images lie on surfaces, so that what a material looks up can be written as one image.
//
// A "look" is a Texture of kind image without texels: size, wrapping, filter, and the way from a
// mesh's (u,v) to the image.
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

// The texture coordinates that the meshes of each material have.
class MaterialUvs {
 public:
  explicit MaterialUvs(const Scene& scene);
  // [0,1]² where no mesh wears the material or has coordinates.
  UvBox of(uint32_t material, bool is_second) const;

 private:
  std::vector<std::array<UvBox, 2>> boxes_;  // per material: first and second set
};

// Whether a texture is an image or a product with one.
bool has_image(const Scene& scene, int32_t texture);

// The look of an image texture.
Texture look_of(const Texture& image);

// Whether both show the same texel at the same place.
bool is_same_place(const Texture& a, const Texture& b);

// Position in an image, v down, of a mesh's (u,v).
Vec2 place_in_image(const Texture& look, const Vec2& uv);
// Its inverse at the middle of a texel.
Vec2 uv_of_texel(const Texture& look, int x, int y);

// Bounds of the positions in the image over a box of (u,v).
UvBox places_over(const Texture& look, const UvBox& uvs);

// The same image repeated as its wrapping asks, so often that its edges are not met within `uvs`,
// with a rim of one texel; none for rotated ones and where the result would be too large.
std::optional<Texture> tiled(const Texture& look, const UvBox& uvs);
// An image over the box, about as fine as `look`.
Texture look_over(const Texture& look, const UvBox& uvs);

// One look for all images in these textures (of one set of coordinates; patterns do not count).
struct CommonLook {
  Texture look;
  bool is_resampled = false;  // the images lie differently: `look` covers the box of (u,v)
};
std::optional<CommonLook> common_look(const Scene& scene, std::span<const int32_t> textures,
                                      const MaterialUvs& uvs, uint32_t material);

}  // namespace troffer
