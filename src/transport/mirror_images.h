// Lights seen in flat mirrors, as lights of scenes of their own (scene/mirror_image.h).
//
// Light that comes from a small source by way of a mirror is what random rays find worst: few of
// them meet the source, and those bring all of it. Asked for in the mirror's image, it is light
// straight from a source like any other: certificates, masks and exact terms hold there.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "scene/mirror_image.h"
#include "transport/prepared_scene.h"
#include "transport/vertex.h"

namespace troffer {

class MirrorImages {
 public:
  struct Image {
    FlatMirror mirror;
    std::unique_ptr<const PreparedScene> scene;
    std::vector<bool> shows;  // per light of the scene that is mirrored
  };

  // Of the mirrors that bring most light, a few at most; null where none brings any. Mirrors: what
  // reflects much of the light, evenly and sharply, by flat parts of meshes, and lets none through.
  // Deterministic.
  static std::shared_ptr<const MirrorImages> make(const PreparedScene& scene);

  const std::vector<Image>& all() const { return images_; }
  // The one that a ray looks into which has come to v and is mirrored there; -1: none.
  int32_t at(const Vertex& v) const;

  // Notes of walks (Walk::last_place) whose integrator asks images at matte surfaces, and so must
  // not count what is met by way of their mirrors: the walk comes straight from a matte surface; or
  // from there by way of the mirror of image i, first_image + i.
  static constexpr uint32_t from_matte = 1, first_image = 2;
  // Of a walk that came to v with this note and has been sent on there: 0, or an image's. (A pane
  // that it goes straight through leaves its note as it is.)
  uint32_t note_beyond(const Vertex& v, uint32_t note, bool is_scattered,
                       const Vec3& direction) const;
  // Whether the image of a walk's note shows this light.
  bool is_shown(uint32_t note, uint32_t light) const {
    return note >= first_image && images_[note - first_image].shows[light];
  }

 private:
  // Per mesh, empty or per triangle: its polygon's image, seen from the front and from behind; -1:
  // none.
  std::vector<std::vector<std::array<int32_t, 2>>> of_triangle_;
  std::vector<Image> images_;
};

}  // namespace troffer
