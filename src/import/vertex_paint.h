// Colours of vertices -> textures and factors of materials.
#pragma once

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace troffer {

// Scenes have no colours per vertex. One colour for a whole mesh is a factor on its material's base
// colour. Where colours differ, the mesh gets vertices and (u,v) of its own for every triangle, and
// an image in which each triangle has 2 x 2 texels whose bilinear mean is the linear one between
// its three corners. A mesh that needs its (u,v) for images gets a second set for that one, which
// is a factor on its base colour; one that needs two sets gets its mean colour, with a warning.
class VertexPainter {
 public:
  // The scene must outlive the painter.
  explicit VertexPainter(Scene& scene) : scene_(scene) {}

  // Colours are linear, one per vertex, and count as factors within [0,1]; their alpha counts where
  // the material has alpha, or is_blended. `needs_uvs`: an image beyond those of the material uses
  // the mesh's.
  void paint(Mesh& mesh, const std::vector<TextureValue>& colors, bool needs_uvs,
             bool is_blended = false);

 private:
  uint32_t blended(uint32_t material);
  uint32_t tinted(uint32_t material, const TextureValue& factor);
  uint32_t add_image(Mesh& mesh, const std::vector<TextureValue>& colors, bool with_uvs);

  Scene& scene_;
  std::map<std::pair<uint32_t, std::array<float, 4>>, uint32_t> tinted_;
  std::map<uint32_t, uint32_t> blended_;  // by material, its copy with alpha
  uint64_t texels_ = 0;
};

}  // namespace troffer
