// A scene with all that is built from it before the first ray.
#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "base/parallel.h"
#include "bsdf/bsdf.h"
#include "light/far_cells.h"
#include "light/light_primitive.h"
#include "light/web.h"
#include "scene/scene.h"
#include "select/light_tree.h"
#include "trace/tracer.h"
#include "transport/even_scatterings.h"
#include "transport/scene_glass.h"

namespace troffer {

// Levels of all images, which only rays look at.
inline Scene with_levels(Scene scene) {
  parallel_for(scene.textures.size(), 0, [&](size_t i) { build_levels(scene.textures[i]); });
  return scene;
}

// Immutable, as far as can be seen; members refer to each other, so it stays where it was made.
struct PreparedScene {
  explicit PreparedScene(Scene s) : PreparedScene(std::move(s), nullptr) {}
  // `relit` is the scene of `base` with other radiances of its lights (with_scaled_lights). Both
  // share one tracer, so this takes milliseconds where building a tracer takes seconds.
  PreparedScene(Scene relit, std::shared_ptr<const PreparedScene> base)
      : scene(with_room_for_tracer(with_levels(std::move(relit)))),
        bsdf_tables(scene),
        even_scatterings(scene, bsdf_tables),
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
  const EvenScatterings even_scatterings;
  const SceneGlass glass;
  const PanePlaces panes;

 private:
  const std::shared_ptr<const PreparedScene> base_;  // owns the tracer; null: own_tracer_ does
  const std::unique_ptr<Tracer> own_tracer_;

 public:
  const Tracer& tracer;
  const LightPrimitives primitives;
  const std::vector<WebLookup> webs;  // of those of the scene
  const LightTree light_tree;

  // Of its lights at infinity; made when first asked for, by any thread: an image takes a while,
  // and only certified light has a use for them.
  const FarCells& far_cells() const {
    std::call_once(are_far_cells_made_, [&] { far_cells_.emplace(scene, primitives); });
    return *far_cells_;
  }

 private:
  mutable std::once_flag are_far_cells_made_;
  mutable std::optional<const FarCells> far_cells_;
};

}  // namespace troffer
