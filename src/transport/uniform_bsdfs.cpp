#include "transport/uniform_bsdfs.h"

#include <algorithm>

#include "transport/two_sides.h"

namespace troffer {

namespace {

// Limit on memory: a material takes about 3 kB.
constexpr size_t most_materials = 1024;

bool is_even(const Material& m) {
  return !has_textured_input(m) && !has_own_coat_normal(m) && !(m.anisotropy.value > 0) &&
         m.kind != MaterialKind::angular;
}

}  // namespace

UniformBsdfs::UniformBsdfs(const Scene& scene, const BsdfTables& tables) {
  const size_t n = std::min(scene.materials.size(), most_materials);
  even_.resize(2 * n);
  for (uint32_t m = 0; m < n; ++m) {
    if (!is_even(scene.materials[m])) continue;
    for (const bool is_front : {true, false}) {
      const Bsdf bsdf = make_bsdf(tables, scene, m, {}, is_front);
      if (!has_two_sides(bsdf)) even_[2 * m + (is_front ? 0 : 1)].emplace(bsdf);
    }
  }
}

}  // namespace troffer
