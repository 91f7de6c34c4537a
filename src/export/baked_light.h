// Computed light for the surfaces of a scene, in the form that a glTF file stores. `bake` makes it,
// and write_gltf() writes it.
//
// References: [1] Mozilla Hubs, "MOZ_lightmap" (a lightmap by a second set of texture coordinates).
//   [2] Khronos, "KHR_materials_unlit", "KHR_materials_emissive_strength".
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace troffer {

enum class BakedShading : uint8_t {
  lightmap,       // materials plus a lightmap [1]: texel × white is irradiance, lx
  unlit,          // [2]: pictures of the surfaces' radiance, shown unshaded
  emissive,       // black emitting surfaces: texel × white is luminance, cd/m²
  vertex_colors,  // [2]: colours of vertices, factors on base colours
};

// Baked light of one mesh or instance.
struct BakedSurface {
  int32_t page = -1;        // index in BakedLight::pages; -1: not baked into a page
  std::vector<Vec2> uvs;    // per vertex, in [0,1], v down; coordinates in the page
  std::vector<Rgb> colors;  // vertex_colors: per vertex, linear; empty: none
  bool is_baked() const { return page >= 0 || !colors.empty(); }
};

struct BakedLight {
  BakedShading shading = BakedShading::lightmap;
  std::vector<std::vector<uint8_t>> pages;  // PNG
  double white = 1;
  std::vector<BakedSurface> meshes, instances;  // one per item of Scene::meshes, Scene::instances
  // Entries of asset.extras: names and JSON values.
  std::vector<std::pair<std::string, std::string>> notes;
};

}  // namespace troffer
