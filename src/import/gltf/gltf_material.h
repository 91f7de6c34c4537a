// Conversion of glTF materials and their textures to materials of the scene. gltf.cpp asks for each
// material by index; docs/reference/formats.md lists what becomes of each extension.
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

// A converted material, with what the makers of its meshes and lights need.
struct GltfMaterial {
  uint32_t material = 0;  // index into Scene::materials
  Rgb emission{0};        // cd/m²
  int32_t emission_texture = no_texture;
  bool is_two_sided = false;
  bool is_textured = false;
  bool is_blended = false;  // alphaMode is BLEND; also applies to vertex alpha
  GltfUvSets uv_sets;
};

// Converts each material on first use, so that textures of unused materials are not decoded.
class GltfMaterials {
 public:
  // All arguments must outlive this object.
  GltfMaterials(const JsonNode& root, const GltfBuffers& buffers, Scene& scene)
      : root_(root), buffers_(buffers), scene_(scene), loader_(scene) {}

  // Hook that is called with each converted material, before it is used; may change it.
  std::function<void(const JsonNode&, GltfMaterial&, TextureLoader&)> on_read;

  // Returns the material at `index` of /materials, or the default material [1] §3.9.6.
  const GltfMaterial& get(std::optional<uint32_t> index);

  // Asks the texture loader to decode the images of all materials in advance.
  void expect_images();

  // Warns of images that no material uses and that could not be read. Call last.
  void check_unused_images();

 private:
  class Reader;
  std::map<int64_t, GltfMaterial> done_;  // by index; -1: the default material
  const JsonNode root_;
  const GltfBuffers& buffers_;
  Scene& scene_;
  TextureLoader loader_;
};

}  // namespace troffer
