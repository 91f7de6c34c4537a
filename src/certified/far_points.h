// Points of all lights at infinity: small parts of their cells, chosen by the light that they would
// send (far_parts.h), places in them by what their corners would, and those of suns. No shafts, no
// lists, no exact light: for hits that proofs are not worth (far_rays.h).
//
// Seen from anywhere in the scene a point lies in the same direction (light/far_cells.h), so
// receivers matter by their normals alone.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "certified/drawn_lights.h"
#include "certified/far_parts.h"
#include "certified/source_integrand.h"

namespace troffer {

class FarPoints {
 public:
  FarPoints() = default;
  // sources: those of lights at infinity, which must stay.
  explicit FarPoints(std::span<const CertifiedSource> sources);
  bool is_empty() const { return parts_.empty() && suns_.empty(); }

  // A point: of the part with this number, by the numbers (u,v) left in it.
  struct Choice {
    uint32_t part = 0;
    float chance = 0;  // of the part; 0: none
    float u = 0, v = 0;
  };
  struct Point {
    const CertifiedSource* source = nullptr;  // null: none
    Vec3 way, wi;                             // towards it, metres; and the unit direction
    float inverse_pdf = 0;                    // sr
  };
  // The parts' chances for receivers of one normal, as a tree: nodes of a heap, the root being 1.
  class Chances {
   public:
    // Of skies and images, and of suns: light that nothing hides, about.
    float all() const { return of_node_.empty() ? 0 : of_node_[1]; }
    float suns() const { return suns_; }
    float of_sun(size_t k) const { return of_sun_[k]; }

   private:
    friend class FarPoints;
    void set_tree();
    Vec3 normal_;
    std::vector<float> of_node_, of_sun_;
    // What of a node's chance is its left child's; where a child's share begins in its parent's,
    // and the inverse of that share.
    std::vector<float> left_, first_, inverse_;
    float suns_ = 0;
  };
  // False where all parts are below the receiver's horizon. What is there for the same normal
  // stays.
  bool set_chances(const ShadowReceiver& receiver, Chances& chances) const;
  // For receivers of about this normal, made beforehand: what sends light to any of them has at
  // least half the chance that it would have by its own normal, but for what all are in sum. What a
  // few points cost would else be little beside their chances.
  const Chances& chances_about(const Vec3& normal) const;

  // Of skies and images, by (u, v) in [0,1)²: even points become points that are as even, since
  // every branch of the tree goes on with its share of u or v. chances.all() is over 0. Parts of
  // neighbouring numbers lie close to each other.
  Choice choose(const Chances& chances, float u, float v) const;
  // With which it becomes one of this part, of a sky or image.
  float chance_of(const Chances& chances, uint32_t part) const {
    return chances.of_node_[parts_.size() + part] / chances.all();
  }
  // Of one of the suns, whose numbers follow those of all others.
  size_t suns() const { return suns_.size(); }
  Choice choose_sun(size_t sun, float u, float v) const {
    return {uint32_t(parts_.size() + sun), 1, u, v};
  }
  // Of any sun, by `place` in [0,1). chances.suns() is over 0.
  Choice choose_any_sun(const Chances& chances, float u, float v, float place) const;
  size_t parts() const { return parts_.size() + suns_.size(); }

  // For a receiver of the normal that the choice was made for, or about which it was.
  Point point(const Choice& choice, const Vec3& normal) const;
  // The radiance that the points send.
  void radiance(std::span<const Point> points, std::vector<Rgb>& out) const;

 private:
  void make_chances_about();
  Chances chances_within(const Vec3& normal, float reach) const;
  // reach: of the normals, about this one.
  void set_suns(const Vec3& normal, float reach, Chances& chances) const;
  // Puts parts into leaves from `leaf` on, neighbours together.
  void plant(std::span<FarPart> parts, size_t leaf, size_t leaves);
  const FarPart& part(uint32_t i) const {
    return i < parts_.size() ? parts_[i] : suns_[i - parts_.size()];
  }
  std::vector<FarPart> parts_;  // by leaf of the tree, some of them empty
  std::vector<FarPart> suns_;
  // Per leaf: its corners and their strengths.
  std::array<std::vector<float>, 4> x_, y_, z_, strength_;
  size_t normals_ = 0;          // of those below, along an edge of a face of a cube
  std::vector<Chances> about_;  // face by face, row by row
};

// Whether a source at infinity shows at x in the direction wi what nothing hides there: where it
// has a portal, through that alone.
bool is_through_portal(const LightPrimitives& primitives, const CertifiedSource& source,
                       const Vec3& x, const Vec3& wi);

}  // namespace troffer
