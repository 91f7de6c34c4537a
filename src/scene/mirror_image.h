// Mirror image of a scene in a flat mirror, as a scene of its own. Light that reaches a surface by
// way of the mirror then comes straight from lights behind it. Used for light sampling through
// mirrors.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace troffer {

// One convex polygon that mirrors on one side: part of a mesh, or a LightRelay.
struct FlatMirror {
  Vec3 normal;                // unit, on the mirroring side
  float height = 0;           // height of the plane along the normal, m
  float tolerance = 0;        // metres; points closer to the plane count as in it
  std::vector<Vec3> outline;  // convex, of either orientation
  uint32_t mesh = 0;
  uint32_t material = 0;
  std::optional<Rgb> relayed;  // reflectance of a relay, which has neither mesh nor material

  float above(const Vec3& p) const { return dot(normal, p) - height; }
  Vec3 reflected(const Vec3& p) const { return p - normal * (2 * above(p)); }
  Vec3 reflected_direction(const Vec3& d) const { return d - normal * (2 * dot(normal, d)); }
  Affine reflection() const;
  // Smallest and largest height of a box above the plane, m.
  std::pair<float, float> heights(const Box& box) const;
};

struct MirrorImage {
  Scene scene;
  std::vector<uint32_t> lights;  // index in the original scene, by light of the image
};

// Returns a scene whose direct light equals the light that arrives by way of this mirror alone. The
// part of the scene in front of the plane stays and occludes, but does not emit. Its mirror image
// lies behind the plane and emits. An opaque wall with a pane for the mirror
// (Material::is_mirror_pane) divides them, and more walls around the front keep other light out.
//
// A light with any part behind the plane is left out, and so are lights at infinity that
// `is_left_out` names (by index; empty: none). Returns nothing if a sphere or disk crosses the
// plane, since these cannot be cut.
std::optional<MirrorImage> mirror_image_of(const Scene& scene, const FlatMirror& mirror,
                                           const std::vector<bool>& is_left_out = {});

}  // namespace troffer
