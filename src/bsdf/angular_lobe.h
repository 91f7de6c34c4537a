// Scattering by matrices over patches of directions (scene/angular_bsdf.h), prepared for sampling:
// for each patch of the viewer, the share that each patch of incident light contributes. A Bsdf of
// an angular material points to one; BsdfTables owns them.
//
// Directions are those of scene/angular_bsdf.h, in the layer's frame. f is constant in a pair of
// patches. Light that passes straight on can be kept sharp: the part of a diagonal value above the
// mean of the patches around it becomes a delta, and the mean stays.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "scene/angular_bsdf.h"

namespace troffer {

class AngularLobe {
 public:
  AngularLobe(const AngularBsdf& bsdf, bool keeps_peak);

  // Returns f without the straight part, 1/sr.
  float value(const Vec3& wo, const Vec3& wi) const;
  // Returns the shares of light towards wo: all of it, and the part that passes straight on.
  float albedo(const Vec3& wo) const;
  float straight(const Vec3& wo) const;
  // Mean of albedo() over the azimuths, by the viewer's side and the cosine.
  float mean_albedo(bool is_front, float cosine) const;
  bool has_straight() const { return has_straight_; }

  // Draws wi with a density of f |cos wi| / albedo(wo), or the straight direction with probability
  // straight(wo) / albedo(wo). Returns false if nothing is scattered towards wo.
  bool sample(const Vec3& wo, float u_lobe, const Vec2& u, Vec3& wi, bool& is_straight) const;

 private:
  // One way of scattering towards the viewer.
  struct Way {
    AngleMatrix matrix;       // without the straight part
    std::vector<float> sums;  // [out × (in + 1)]: running sums of value × projected solid angle
    std::vector<float> straight;  // by out; empty: none
    float total(size_t o) const;
  };
  // Ways towards a viewer at the front or the back.
  struct Side {
    Way reflection, transmission;
  };
  Side front_, back_;
  bool has_straight_ = false;

  const Side& side_of(const Vec3& wo) const { return wo.z > 0 ? front_ : back_; }
  static Way make_way(const AngleMatrix& matrix);
  static void take_peaks(Way& way);
};

}  // namespace troffer
