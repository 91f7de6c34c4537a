// Continuation of walks straight through panes, for walks that only look for emission. Shadow rays
// pass panes, so the competing walks must see through them as well. Used by WaveIntegrator and path
// tracing.
#pragma once

#include "transport/bsdf_at.h"
#include "transport/walk.h"

namespace troffer {

// Follows a walk from vertex v straight on, as long as it meets panes. Calls see(walk, vertex) for
// each further surface, with a null vertex if the walk leaves the scene.
template <class See>
void look_through_panes(const PreparedScene& scene, Walk walk, Vertex v, const See& see) {
  constexpr int most_panes = 64;
  for (int i = 0; i < most_panes && scene.glass.is_pane(v.surface.material); ++i) {
    if (!pass_pane(walk, v, bsdf_at(scene, v))) return;
    Hit hit;
    scene.tracer.closest({&walk.ray, 1}, {&hit, 1});
    if (!hit.is_valid()) {
      see(walk, nullptr);
      return;
    }
    arrive_at(scene.scene, hit, walk, v);
    see(walk, &v);
  }
}

}  // namespace troffer
