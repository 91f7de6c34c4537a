// Light baked into a glTF file: MOZ_lightmap, and the images of KHR_materials_unlit. With `--baked`
// materials become black emitters of the baked radiance. Otherwise a warning says that the file
// holds baked light.
// References: [1] Mozilla Hubs, "MOZ_lightmap": texel × intensity is irradiance.
//   [2] Khronos, "KHR_materials_unlit".
#pragma once

#include "import/gltf/gltf_accessor.h"
#include "import/gltf/gltf_json.h"
#include "import/gltf/gltf_material.h"
#include "import/texture_loader.h"
#include "scene/scene.h"

namespace troffer {

// Applies baked light to converted materials.
class GltfBaked {
 public:
  // All arguments must outlive this object. `is_shown`: show the baked light.
  GltfBaked(const JsonNode& root, const GltfBuffers& buffers, Scene& scene, bool is_shown)
      : root_(root), buffers_(buffers), scene_(scene), is_shown_(is_shown) {}

  // Call for each converted material. If baked light is shown, the material becomes black and emits
  // base colour × E / pi, as a Lambertian surface would reflect; unlit materials emit their base
  // colour.
  void apply(const JsonNode& node, GltfMaterial& material, TextureLoader& loader);
  // Warns if baked light was requested and the file has none. Call last.
  void finish() const;

 private:
  const JsonNode& root_;
  const GltfBuffers& buffers_;
  Scene& scene_;
  const bool is_shown_;
  size_t shown_ = 0;

  int32_t product(int32_t a, int32_t b);
  void emit(Rgb radiance, int32_t texture, GltfMaterial& material);
  void choose_set(int set, const JsonNode& node, GltfMaterial& material);
};

}  // namespace troffer
