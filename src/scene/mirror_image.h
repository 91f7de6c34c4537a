// What a flat mirror shows, as a scene of its own: light that a mirror throws on a surface comes
// straight on from lights behind it.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace troffer {

// One convex polygon of a mesh, seen from one side.
struct FlatMirror {
  Vec3 normal;                // unit, on the side that mirrors
  float height = 0;           // of its plane, along the normal
  float tolerance = 0;        // metres; what is no farther from the plane lies in it
  std::vector<Vec3> outline;  // convex, any way round
  uint32_t mesh = 0;
  uint32_t material = 0;

  float above(const Vec3& p) const { return dot(normal, p) - height; }
  Vec3 reflected(const Vec3& p) const { return p - normal * (2 * above(p)); }
  Vec3 reflected_direction(const Vec3& d) const { return d - normal * (2 * dot(normal, d)); }
  Affine reflection() const;
  // Of the lowest and the highest corner of a box.
  std::pair<float, float> heights(const Box& box) const;
};

struct MirrorImage {
  Scene scene;
  std::vector<uint32_t> lights;  // of the scene that was mirrored: of each light here
};

// A scene in which a surface in front of the mirror gets, straight from lights, just the light that
// it gets from lights by way of this mirror and no other: all that lies in front of the mirror's
// plane, cut off there, which hides but does not shine; the image of that behind the plane, where
// the lights shine; between them an opaque wall, with a pane for the mirror (Material::is_image);
// and walls around the front, so that no other light comes in.
//
// Lights of which something lies behind the plane are left out. Nothing, where a sphere or disk
// crosses the plane: it cannot be cut.
std::optional<MirrorImage> image_in(const Scene& scene, const FlatMirror& mirror);

}  // namespace troffer
