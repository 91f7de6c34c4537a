// glTF materials and textures.
// References: [1] Khronos, glTF 2.0 Specification, §3.9 (Materials), §3.8 (Texture Data), and its
//   extensions KHR_materials_specular, _ior, _transmission, _volume, _emissive_strength,
//   _clearcoat, _pbrSpecularGlossiness, KHR_texture_transform.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "import/gltf/gltf_accessor.h"
#include "import/gltf/gltf_json.h"
#include "import/gltf/gltf_uv_sets.h"
#include "import/texture_loader.h"
#include "scene/scene.h"

namespace troffer {

struct GltfMaterial {
  uint32_t material = 0;  // index into Scene::materials
  Rgb emission{0};        // cd/m²
  int32_t emission_texture = no_texture;
  bool is_two_sided = false;
  bool is_textured = false;
  bool is_blended = false;  // its alphaMode is BLEND, which counts where vertices have alpha, too
  GltfUvSets uv_sets;
};

// Converts materials when they are asked for, each once; textures nobody uses are not decoded.
class GltfMaterials {
 public:
  // All arguments must outlive this object.
  GltfMaterials(const JsonNode& root, const GltfBuffers& buffers, Scene& scene)
      : root_(root), buffers_(buffers), scene_(scene), loader_(scene) {}

  // Called with each material that has been read, before it is used.
  std::function<void(const JsonNode&, GltfMaterial&, TextureLoader&)> on_read;

  // The material of that index in /materials, or the default material [1] §3.9.6.
  const GltfMaterial& get(std::optional<uint32_t> index);

  // Has images that materials will want decoded beforehand.
  void expect_images();

  // Warns of images that nothing shows and that could not be shown. To be called last.
  void check_unused_images();

 private:
  class Reader;
  std::map<int64_t, GltfMaterial> done_;  // the default one at -1
  const JsonNode root_;
  const GltfBuffers& buffers_;
  Scene& scene_;
  TextureLoader loader_;
};

}  // namespace troffer
