// A scene together with all that is built from it before the first ray: BSDF tables, tracer, light
// primitives, light tree. Every integrator and most of render/ refer to one. It must outlive them.
// Lengths are in metres.
#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "base/parallel.h"
#include "bsdf/bsdf.h"
#include "light/light_primitive.h"
#include "light/sky_patches.h"
#include "light/web.h"
#include "scene/scene.h"
#include "select/light_tree.h"
#include "trace/tracer.h"
#include "transport/scene_glass.h"
#include "transport/uniform_bsdfs.h"

namespace troffer {

// Builds the mip levels of all images. Only rays need them.
inline Scene with_levels(Scene scene) {
  parallel_for(scene.textures.size(), 0, [&](size_t i) { build_levels(scene.textures[i]); });
  return scene;
}

// Logically immutable and thread-safe. The members refer to each other, so it can be neither copied
// nor moved.
struct PreparedScene {
  explicit PreparedScene(Scene s) : PreparedScene(std::move(s), nullptr) {}
  // `relit` is the scene of `base` with other radiances of its lights (with_scaled_lights). Both
  // share one tracer, so construction takes milliseconds; building a tracer takes seconds.
  PreparedScene(Scene relit, std::shared_ptr<const PreparedScene> base)
      : scene(with_room_for_tracer(with_levels(std::move(relit)))),
        bsdf_tables(scene),
        uniform_bsdfs(scene, bsdf_tables),
        glass(scene, bsdf_tables),
        panes(scene, glass),
        base_(std::move(base)),
        own_tracer_(base_ ? nullptr
                          : std::make_unique<Tracer>(scene, panes.is_empty() ? nullptr : &glass)),
        tracer(base_ ? base_->tracer : *own_tracer_),
        primitives(scene),
        webs(scene.webs.begin(), scene.webs.end()),
        light_tree(primitives) {}
  PreparedScene(const PreparedScene&) = delete;
  PreparedScene& operator=(const PreparedScene&) = delete;

  const Scene scene;
  const BsdfTables bsdf_tables;
  const UniformBsdfs uniform_bsdfs;
  const SceneGlass glass;
  const PanePlaces panes;

 private:
  // owner of the tracer; null if own_tracer_ is used
  const std::shared_ptr<const PreparedScene> base_;
  const std::unique_ptr<Tracer> own_tracer_;

 public:
  const Tracer& tracer;
  const LightPrimitives primitives;
  const std::vector<WebLookup> webs;  // one per item of scene.webs
  const LightTree light_tree;

  // Returns the sky patches of lights at infinity. They are built on first use, by any thread: an
  // image takes a while, and only certified light needs them.
  const SkyPatches& far_cells() const {
    std::call_once(are_far_cells_made_, [&] { far_cells_.emplace(scene, primitives); });
    return *far_cells_;
  }

 private:
  mutable std::once_flag are_far_cells_made_;
  mutable std::optional<const SkyPatches> far_cells_;
};

}  // namespace troffer
