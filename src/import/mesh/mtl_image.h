// Images of MTL materials, as their options change them.
//
// References: Wavefront Technologies, "MTL material format", 1995.
#pragma once

#include "import/mesh/mtl.h"
#include "import/texture_loader.h"

namespace troffer {

// Tells the loader that it will be asked for the images of a material.
void expect_mtl_images(const MtlMaterial& material, const std::string& folder,
                       TextureLoader& loader);

// Index in Scene::textures, no_texture where `map` names no image. `is_color`: 8-bit texels are
// sRGB unless the options say they are linear. Looked up in `folder`, else beside the scene.
int32_t load_mtl_image(const MtlMap& map, bool is_color, const std::string& folder,
                       TextureLoader& loader, Scene& scene);

// The channel of that image that a number is read from: as the options say, else `fallback`. The
// luminance of a coloured image becomes a grey one, which `image` then stands for.
int32_t channel_of(const MtlMap& map, int32_t fallback, int32_t& image, Scene& scene);

// An image of widths of GGX from one of factors on the exponent of Phong's lobe.
int32_t widths_from_exponents(int32_t image, int32_t channel, float exponent, Scene& scene);

// Width of Beckmann's lobe that a Phong lobe of that exponent is as wide as (Walter et al. 2007).
float alpha_from_exponent(float exponent);

}  // namespace troffer
