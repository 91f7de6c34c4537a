// Vertex colours, which scenes store as images (import/vertex_paint.h). These functions recover
// them for formats that have vertex colours. For formats with one set of coordinates, they replace
// the second set's image by its mean.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace troffer {

// Returns the texture with vertex colours: the base colour or one of its factors, linear over each
// triangle of the mesh, with values in [0,1] at the corners. no_texture: none.
int32_t vertex_color_texture(const Scene& scene, const Mesh& mesh);

// Returns its values at the mesh's vertices.
std::vector<TextureValue> colors_of_vertices(const Scene& scene, const Mesh& mesh, int32_t texture);

// Returns the material without this factor of its base colour and alpha.
Material without_vertex_colors(const Scene& scene, Material material, int32_t texture);

// True if the material, or the light on it, uses the first (or second) set of coordinates.
bool uses_uv_set(const Scene& scene, const Material& material, const Light* light, bool is_second);

// Replaces the second set's image by its mean over the mesh in base colours that multiply images of
// both sets. keeps_vertex_colors: except images that vertex_color_texture() finds.
void flatten_second_sets(Scene& scene, bool keeps_vertex_colors, WarningLog& warnings);

// Gives spheres and disks materials without images. They have no coordinates, so their images are
// looked up at (0,0).
void flatten_round_shapes(Scene& scene);

}  // namespace troffer
