// Lights seen in flat mirrors, as lights of mirrored scenes (scene/mirror_image.h). Used by
// certified light; gather rays and paths leave out what it covers.
//
// Light from a small source by way of a mirror is hard for random rays: few of them meet the
// source, and each brings much light. In the mirror image it is light straight from a source, so
// certificates, masks and exact terms apply.
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
    std::vector<bool> shows;  // per light of the original scene
  };

  // Returns the images of all relays (scene/scene.h) and of the few mirrors that reflect the most
  // light; null if there are none. A mirror is a flat part of a mesh with strong, uniform,
  // perfectly smooth reflection and no transmission. Deterministic.
  static std::shared_ptr<const MirrorImages> make(const PreparedScene& scene);
  // Returns the images of relays alone, for integrators whose rays find light in mirrors.
  static std::shared_ptr<const MirrorImages> of_relays(const PreparedScene& scene);

  const std::vector<Image>& all() const { return images_; }
  // Returns the index of the image that a ray mirrored at v sees, or -1.
  int32_t at(const Vertex& v) const;

  // Notes in Walk::last_place for integrators that sample images at matte surfaces. Such an
  // integrator must not count emission that a walk meets by way of an imaged mirror.
  // note_from_matte: the walk comes straight from a matte surface. first_image + i: it comes from
  // there by way of the mirror of image i.
  static constexpr uint32_t note_from_matte = 1, first_image = 2;
  // Returns the note of a walk that came to v with `note` and leaves in `direction`: 0 or an
  // image's note. Panes that a walk passes straight through do not change its note.
  uint32_t note_beyond(const Vertex& v, uint32_t note, bool is_scattered,
                       const Vec3& direction) const;
  // True if the image of the walk's note shows this light.
  bool is_shown(uint32_t note, uint32_t light) const {
    return note >= first_image && images_[note - first_image].shows[light];
  }

 private:
  void add_relays(const PreparedScene& scene);
  void add(const PreparedScene& scene, const FlatMirror& mirror, MirrorImage made);

  // Per mesh, empty or per triangle: index of the image of its polygon, for front and back; -1 if
  // there is none.
  std::vector<std::vector<std::array<int32_t, 2>>> of_triangle_;
  std::vector<Image> images_;
};

}  // namespace troffer
