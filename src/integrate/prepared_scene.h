// A scene with all that is built from it before the first ray.
#pragma once

#include "bsdf/bsdf.h"
#include "light/light_primitive.h"
#include "scene/scene.h"
#include "select/light_tree.h"
#include "trace/tracer.h"

namespace troffer {

// Immutable; members refer to each other, so it stays where it was made.
struct PreparedScene {
  explicit PreparedScene(Scene s)
      : scene(std::move(s)),
        tracer(scene),
        bsdf_tables(scene),
        primitives(scene),
        light_tree(primitives) {}
  PreparedScene(const PreparedScene&) = delete;
  PreparedScene& operator=(const PreparedScene&) = delete;

  const Scene scene;
  Tracer tracer;
  const BsdfTables bsdf_tables;
  const LightPrimitives primitives;
  const LightTree light_tree;
};

}  // namespace troffer
