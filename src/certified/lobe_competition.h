// Rough lobes send rays of their own, which compete with points of sources: a density of
// directions, per sr, in which the latter are taken to be chosen. Close to what is done, and the
// same whoever asks, which is all that multiple importance sampling needs.
#pragma once

#include <cstdint>

#include "base/vec.h"

namespace troffer {

class LightGroups;
class PreparedScene;
struct CertifiedSource;

// A surface at x of unit geometric normal n.
struct LobePlace {
  Vec3 x, n;
  float all_light = 0;  // where lights are drawn: what all lights may send there
};

class LobeCompetition {
 public:
  // Each source is looked at, at so many points.
  LobeCompetition(const PreparedScene& scene, uint32_t points) : scene_(&scene), points_(points) {}
  // … but for lights with a surface that are drawn, about in proportion to what they may send:
  // there a direction is chosen by the light of a matte surface that comes from it, nothing hidden.
  // So are those of no source, and, with are_sources_drawn, mostly all. The groups, of all such
  // lights, must stay.
  LobeCompetition(const PreparedScene& scene, uint32_t points, const LightGroups& groups,
                  bool are_sources_drawn);

  LobePlace place(const Vec3& x, const Vec3& n) const;
  // In the unit direction wi: density_of() × n · wi. What a cell at infinity sends is taken to come
  // from its middle.
  float density_of(const CertifiedSource& source, const LobePlace& at) const;
  float density(const CertifiedSource& source, const LobePlace& at, const Vec3& wi) const;
  // Of points of a primitive of no source, which is drawn.
  float density(uint32_t primitive, const LobePlace& at, const Vec3& wi) const;

 private:
  float density_of_drawn(float radiance, const LobePlace& at) const;

  const PreparedScene* scene_;
  uint32_t points_;
  const LightGroups* drawn_ = nullptr;  // null: no light is
  bool are_sources_drawn_ = false;
};

}  // namespace troffer
