// PaneGlass of a scene: tells the tracer which materials are panes (clear thin glass), and how much
// light passes a pane or a blended surface. Part of PreparedScene. Transmittances are per RGB
// channel, in [0,1].
#pragma once

#include <algorithm>
#include <cmath>

#include "bsdf/bsdf.h"
#include "scene/scene.h"
#include "trace/panes.h"

namespace troffer {

class SceneGlass final : public PaneGlass {
 public:
  SceneGlass(const Scene& scene, const BsdfTables& tables) : scene_(scene), tables_(tables) {}
  bool is_pane(uint32_t material) const override { return tables_.material(material).is_pane; }
  bool is_even(uint32_t material) const override {
    const Material& m = scene_.materials[material];
    return !has_textured_input(m) && m.kind != MaterialKind::angular;
  }
  Rgb transmittance_at(uint32_t material, float cosine) const override {
    const Vec3 wo{std::sqrt(std::max(0.0f, 1 - cosine * cosine)), 0, cosine};
    return straight_transmittance(make_bsdf(tables_, scene_, material, {}, true), wo);
  }
  Rgb transmittance(const Ray& ray, const Hit& hit) const override;

 private:
  const Scene& scene_;
  const BsdfTables& tables_;
};

}  // namespace troffer
