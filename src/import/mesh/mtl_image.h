// Images of MTL materials, with the options of their statements applied. Used by mtl_convert.h.
//
// References: Wavefront Technologies, "MTL material format", 1995.
#pragma once

#include "import/mesh/mtl.h"
#include "import/texture_loader.h"

namespace troffer {

// Asks the loader to decode the images of a material in advance.
void expect_mtl_images(const MtlMaterial& material, const std::string& folder,
                       TextureLoader& loader);

// Returns the image's index in Scene::textures, or no_texture if `map` names none. `is_color`:
// 8-bit texels are sRGB unless the options say linear. Searches `folder` first, then beside the
// scene.
int32_t load_mtl_image(const MtlMap& map, bool is_color, const std::string& folder,
                       TextureLoader& loader, Scene& scene);

// Returns the channel that a number is read from: the one of the options, else `fallback`. For the
// luminance of a coloured image it adds a grey image and sets `image` to that.
int32_t channel_of(const MtlMap& map, int32_t fallback, int32_t& image, Scene& scene);

// Adds an image of GGX widths and returns it. The given channel holds factors on `exponent`, the
// exponent of a Phong lobe.
int32_t widths_from_exponents(int32_t image, int32_t channel, float exponent, Scene& scene);

// Returns the Beckmann width of equal lobe width to a Phong exponent (Walter et al. 2007).
float alpha_from_exponent(float exponent);

}  // namespace troffer
