// Conversion of vertex colours to materials and textures, because scenes have no colours per
// vertex. Used by the importers of glTF and OBJ.
#pragma once

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace troffer {

// Applies vertex colours to meshes. A single colour becomes a factor on the material's base colour.
// Where colours differ, each triangle gets its own vertices and (u,v), and 2 x 2 texels of an
// image. Their bilinear interpolation equals the linear one between the three corners.
// If the mesh needs its (u,v) for other images, the colour image uses the second set and multiplies
// the base colour. If both sets are needed, the mesh gets its mean colour, with a warning.
class VertexPainter {
 public:
  // The scene must outlive the painter.
  explicit VertexPainter(Scene& scene) : scene_(scene) {}

  // Paints a mesh. Colours are linear factors, one per vertex, clamped to [0,1]. Their alpha is
  // used if the material has alpha, or if `is_blended`. `needs_uvs` is true if an image outside the
  // material uses the mesh's (u,v).
  void paint(Mesh& mesh, const std::vector<TextureValue>& colors, bool needs_uvs,
             bool is_blended = false);

 private:
  uint32_t blended(uint32_t material);
  uint32_t tinted(uint32_t material, const TextureValue& factor);
  uint32_t add_image(Mesh& mesh, const std::vector<TextureValue>& colors, bool with_uvs);

  Scene& scene_;
  std::map<std::pair<uint32_t, std::array<float, 4>>, uint32_t> tinted_;
  std::map<uint32_t, uint32_t> blended_;  // by material: its copy with alpha
  uint64_t texels_ = 0;
};

}  // namespace troffer
