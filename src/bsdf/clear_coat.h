// A clear coat over everything else in a Bsdf. It reflects by GGX with its own width and normal.
//
// The coat leaves T = 1 - share × its directional albedo for the layers below. Gloss keeps the
// smaller T of both directions: a mirror below reflects T of the light, and a white mirror with its
// coat reflects all of it. Separable lobes keep the product of both, divided by its mean.
//
// With bend > 1, directions below the coat are refracted by this index (Snell), as under varnish.
// Gloss below then keeps t² R / (1 - (1 - t) R), which sums the inter-reflections of coat and base:
// t is the smaller T, R the base's reflectance. Light beyond the critical angle stays below and
// returns with the energy lost between microfacets (GrainTable). Refraction by a rough coat widens
// gloss below, once on the way in and once on the way out: slopes of width alpha turn a ray by (1 -
// 1/bend) alpha.
//
// References: Weidlich & Wilkie, "Arbitrarily Layered Micro-Facet Surfaces", GRAPHITE 2007
//   (refracted directions below a coat). Belcour, "Efficient Rendering of Layered Materials using
//   an Atomic Decomposition with Statistical Operators", TOG 37(4), 2018 (widths add as variances).
#pragma once

#include <algorithm>
#include <cmath>

#include "base/frame.h"
#include "base/rgb.h"
#include "base/vec.h"
#include "bsdf/albedo_table.h"
#include "bsdf/fresnel.h"

namespace troffer {

struct ClearCoat {
  float share = 0;       // share of the surface that has the coat; 0: no coat
  bool is_shown = true;  // its own reflection counts, not only its attenuation
  bool is_smooth = true;
  bool has_normal = false;
  float alpha = 0, eta = 1.5f;
  float bend = 1;
  Vec3 normal{0, 0, 1};  // in the shading frame; with a grain, in the grain's frame
  AlbedoRow row;         // CoatTable row, if rough
  AlbedoRow inner;       // row for light from below, if rough and bend > 1

  bool has_lobe() const { return share > 0 && is_shown; }
  bool has_rough_lobe() const { return has_lobe() && !is_smooth; }
  bool has_mirror() const { return has_lobe() && is_smooth; }

  // Returns the coat's directional albedo where the surface has it.
  float reflected(float cosine) const {
    const float c = std::clamp(cosine, 0.0f, 1.0f);
    return is_smooth ? fresnel_dielectric(c, eta) : std::min(row.at(CosineCoordinate(c)), 1.0f);
  }
  float pass(float cosine) const { return share > 0 ? 1 - share * reflected(cosine) : 1.0f; }

  // Returns the share that gloss keeps in one direction. Near the critical angle a rough coat
  // passes less light outwards than inwards.
  float gloss_pass(float cosine) const {
    const float in = pass(cosine);
    if (!(bend > 1) || is_smooth) return in;
    const CosineCoordinate below_it(cosine_below(std::max(cosine, 0.0f)));
    return std::min(in, std::max(0.0f, 1 - inner.at(below_it)));
  }

  // Convert between the shading frame and the frame whose z is the coat's normal.
  Vec3 to_own(const Vec3& w) const { return has_normal ? Frame(normal).to_local(w) : w; }
  Vec3 from_own(const Vec3& w) const { return has_normal ? Frame(normal).to_world(w) : w; }

  // Return the cosine, or the whole direction, below the coat for a direction above it.
  float cosine_below(float cosine) const {
    const float sine2 = std::max(0.0f, 1 - cosine * cosine);
    return std::sqrt(std::max(0.0f, 1 - sine2 / (bend * bend)));
  }
  Vec3 below(const Vec3& w) const {
    const Vec3 in{w.x / bend, w.y / bend, 0};
    return {in.x, in.y, std::sqrt(std::max(0.0f, 1 - in.x * in.x - in.y * in.y))};
  }
  // Sets w to the direction above the coat; false beyond the critical angle.
  bool above(const Vec3& in, Vec3& w) const {
    w = {in.x * bend, in.y * bend, 0};
    const float z2 = 1 - w.x * w.x - w.y * w.y;
    if (!(z2 > 0)) return false;
    w.z = std::sqrt(z2);
    return true;
  }
  // Returns the factor that turns f cos and densities of directions below the coat into those of
  // directions above: the ratio of solid angles times the ratio of cosines.
  float solid_angle_factor(const Vec3& w, const Vec3& in) const {
    return w.z / (bend * bend * std::max(in.z, 1e-9f));
  }

  // Returns the factor on gloss of reflectance R below the coat; t is the smaller pass of both
  // directions.
  Rgb kept(float t, Rgb reflectance) const {
    if (!(bend > 1)) return Rgb{t};
    return Rgb{t * t} / (Rgb{1} - reflectance * (1 - t));
  }
};

// Returns the GGX width of gloss below a coat with bend > 1.
inline float widened_below(float alpha, float coat_alpha, float bend) {
  return std::min(std::sqrt(alpha * alpha + 0.5f * sqr((1 - 1 / bend) * coat_alpha)), 1.0f);
}

}  // namespace troffer
