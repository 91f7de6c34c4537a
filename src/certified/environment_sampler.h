// Sampling of all environment lights together, for hits where proofs do not pay
// (environment_rays.h). A part of a sky patch (sky_patch_parts.h) or a sun is chosen in proportion
// to its unoccluded light. The point within a part is chosen in proportion to a bilinear function
// of its corners' light.
//
// A point of a sky patch lies in the same direction from everywhere in the scene
// (light/sky_patches.h). So only the normals of receivers matter.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "certified/drawn_lights.h"
#include "certified/sky_patch_parts.h"
#include "certified/source_integrand.h"

namespace troffer {

class EnvironmentSampler {
 public:
  EnvironmentSampler() = default;
  // sources: the sky patches and suns of environment lights, which must outlive this object.
  explicit EnvironmentSampler(std::span<const CertifiedSource> sources);
  bool is_empty() const { return parts_.empty() && suns_.empty(); }

  // A chosen part, and the uniform numbers (u,v) that remain for the point within it.
  struct Choice {
    uint32_t part = 0;
    float chance = 0;  // probability of the part; 0: no point
    float u = 0, v = 0;
  };
  struct Point {
    const CertifiedSource* source = nullptr;  // null: none
    Vec3 way, wi;           // vector towards the point in metres, and its unit direction
    float inverse_pdf = 0;  // 1 / density, sr
  };
  // Probabilities of all parts for receivers of one normal, as a binary tree: nodes in heap order,
  // with root 1.
  class Chances {
   public:
    // Approximate unoccluded light of skies and images, and of suns, luminance × sr.
    float all() const { return of_node_.empty() ? 0 : of_node_[1]; }
    float suns() const { return suns_; }
    float of_sun(size_t k) const { return of_sun_[k]; }

   private:
    friend class EnvironmentSampler;
    void set_tree();
    Vec3 normal_;
    std::vector<float> of_node_, of_sun_;
    // Per node: the left child's share of its probability. Per child: where its share begins in its
    // parent's, and the inverse of its share.
    std::vector<float> left_, first_, inverse_;
    float suns_ = 0;
  };
  // Computes the probabilities for a receiver's normal. Returns false if all parts lie below its
  // horizon. Does nothing but return if `chances` already belongs to that normal.
  bool set_chances(const ShadowReceiver& receiver, Chances& chances) const;
  // Returns precomputed probabilities for a neighbourhood of `normal`. Every part that lights any
  // normal near it keeps at least half its own weight, before normalization. Use these for few
  // samples, where set_chances() would cost more than the samples.
  const Chances& chances_about(const Vec3& normal) const;

  // Chooses a part of a sky or image by (u, v) in [0,1)². Stratified numbers give stratified
  // points, because each branch of the tree rescales u or v. Parts with neighbouring indices lie
  // close together. Precondition: chances.all() > 0.
  Choice choose(const Chances& chances, float u, float v) const;
  // Probability with which choose() returns this part; not for suns.
  float chance_of(const Chances& chances, uint32_t part) const {
    return chances.of_node_[parts_.size() + part] / chances.all();
  }
  // Chooses a point of one given sun. Suns' part indices follow all others.
  size_t suns() const { return suns_.size(); }
  Choice choose_sun(size_t sun, float u, float v) const {
    return {uint32_t(parts_.size() + sun), 1, u, v};
  }
  // Chooses a sun by `place` in [0,1) in proportion to its light. Precondition: chances.suns() > 0.
  Choice choose_any_sun(const Chances& chances, float u, float v, float place) const;
  size_t parts() const { return parts_.size() + suns_.size(); }

  // Returns the chosen point for a receiver normal, which must be covered by the chances that the
  // choice was made with. Its source is null if there is none.
  Point point(const Choice& choice, const Vec3& normal) const;
  // Computes the radiance of each point; black for points without a source.
  void radiance(std::span<const Point> points, std::vector<Rgb>& out) const;

 private:
  void make_chances_about();
  Chances chances_within(const Vec3& normal, float reach) const;
  // Sets the suns' weights for all normals within `reach` of this one.
  void set_suns(const Vec3& normal, float reach, Chances& chances) const;
  // Puts parts into the leaves from `leaf` on, so that neighbours stay together.
  void plant(std::span<SkyPatchPart> parts, size_t leaf, size_t leaves);
  const SkyPatchPart& part(uint32_t i) const {
    return i < parts_.size() ? parts_[i] : suns_[i - parts_.size()];
  }
  std::vector<SkyPatchPart> parts_;  // by leaf of the tree; some are empty
  std::vector<SkyPatchPart> suns_;
  // Per leaf: corners and their strengths.
  std::array<std::vector<float>, 4> x_, y_, z_, strength_;
  size_t normals_ = 0;          // cells of about_ along an edge of a cube face
  std::vector<Chances> about_;  // by face, row and column
};

// True if light of an environment source can reach x from direction wi past its portal. Always true
// without a portal.
bool is_through_portal(const LightPrimitives& primitives, const CertifiedSource& source,
                       const Vec3& x, const Vec3& wi);

}  // namespace troffer
