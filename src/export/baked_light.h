// Light that was computed for the surfaces of a scene, as a glTF file is to hold it.
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
  lightmap,  // materials as they are, each with a lightmap [1]: texel × white is irradiance, lx
  unlit,     // [2]: pictures of what surfaces send, shown as they are
  emissive,  // black surfaces that emit: texel × white is luminance, cd/m²
  vertex_colors,  // [2]: colours of vertices, by which base colours are multiplied
};

// What one mesh (or instance) gets.
struct BakedSurface {
  int32_t page = -1;        // of BakedLight::pages; none: it is written as it is
  std::vector<Vec2> uvs;    // per vertex, in [0,1], v down; of a page
  std::vector<Rgb> colors;  // vertex_colors: per vertex, linear; empty: it is written as it is
  bool is_baked() const { return page >= 0 || !colors.empty(); }
};

struct BakedLight {
  BakedShading shading = BakedShading::lightmap;
  std::vector<std::vector<uint8_t>> pages;  // PNG
  double white = 1;
  std::vector<BakedSurface> meshes, instances;  // of Scene::meshes, Scene::instances
  // Numbers and words for asset.extras: names and JSON values.
  std::vector<std::pair<std::string, std::string>> notes;
};

}  // namespace troffer
