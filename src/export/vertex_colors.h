// Colours of vertices, which scenes hold as images (import/vertex_paint.h): found again for formats
// that have them, and replaced by a mean where an image of another set of coordinates lies under
// them and the format has one set.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace troffer {

// The texture that is, or is a factor of, the base colour and varies linearly over each triangle of
// the mesh, with values in [0,1] at its corners; no_texture: none.
int32_t vertex_color_texture(const Scene& scene, const Mesh& mesh);

// Its values at the mesh's vertices.
std::vector<TextureValue> colors_of_vertices(const Scene& scene, const Mesh& mesh, int32_t texture);

// The material without that factor of its base colour and alpha.
Material without_vertex_colors(const Scene& scene, Material material, int32_t texture);

// Whether the material, or the light on it, looks anything up by the first or the second set.
bool uses_uv_set(const Scene& scene, const Material& material, const Light* light, bool is_second);

// Base colours that are products of images by both sets of coordinates lose the second set's image
// for its mean over the mesh. keeps_vertex_colors: but for what vertex_color_texture() finds.
void flatten_second_sets(Scene& scene, bool keeps_vertex_colors, WarningLog& warnings);

// Spheres and disks have no coordinates: images on them are looked up at (0,0). Gives them
// materials that say so in numbers.
void flatten_round_shapes(Scene& scene);

}  // namespace troffer
