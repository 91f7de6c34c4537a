#include "render/kept_cells.h"

#include "radiosity/solution.h"

namespace troffer {

std::vector<uint8_t> save_kept_cells(const PreparedScene& scene, const CellStore& store) {
  return save_cells(store, radiosity_scene_key(scene.scene));
}

CellStore load_kept_cells(const PreparedScene& scene, std::span<const uint8_t> bytes,
                          const std::string& file) {
  return load_cells(bytes, file, radiosity_scene_key(scene.scene), scene.tracer);
}

}  // namespace troffer
