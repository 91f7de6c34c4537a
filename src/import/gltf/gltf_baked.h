// Light that was baked into a glTF file: MOZ_lightmap, and the pictures of KHR_materials_unlit.
//
// References: [1] Mozilla Hubs, "MOZ_lightmap": texel × intensity is irradiance.
//   [2] Khronos, "KHR_materials_unlit".
#pragma once

#include "import/gltf/gltf_accessor.h"
#include "import/gltf/gltf_json.h"
#include "import/gltf/gltf_material.h"
#include "import/texture_loader.h"
#include "scene/scene.h"

namespace troffer {

class GltfBaked {
 public:
  // All must outlive this. is_shown: materials become what was baked; else a warning says that the
  // file holds it.
  GltfBaked(const JsonNode& root, const GltfBuffers& buffers, Scene& scene, bool is_shown)
      : root_(root), buffers_(buffers), scene_(scene), is_shown_(is_shown) {}

  // For a material that has been read. Where baked light is shown, it becomes black and emits what
  // it was seen to send: base colour × E / pi, as from a matt surface.
  void apply(const JsonNode& node, GltfMaterial& material, TextureLoader& loader);
  // Warns where light was to be shown and there is none. To be called last.
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
