// A clear coat over all else that a Bsdf does, reflecting by GGX of its own width and normal.
//
// What it does not reflect, T = 1 - share × its directional albedo, is left for what lies below:
// gloss keeps the smaller T of both directions, so that a mirror under it reflects T of the light
// and a white one with its coat all of it; separable lobes keep the product, over its mean.
//
// bend > 1: directions below are refracted by this index (Snell), as under a layer of varnish, and
// gloss below keeps t² R / (1 - (1 - t) R) of the light, t the smaller T, R its own reflectance:
// what goes to and fro between coat and base. Light beyond the critical angle stays below and comes
// out with what is lost between microfacets (GrainTable). Refraction by a rough coat, there and
// back, widens gloss below: slopes of width alpha turn a ray by (1 - 1/bend) alpha each time.
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
  float share = 0;       // of the surface that wears it; 0: there is none
  bool is_shown = true;  // its own reflection counts, beside what it takes
  bool is_smooth = true;
  bool has_normal = false;
  float alpha = 0, eta = 1.5f;
  float bend = 1;
  Vec3 normal{0, 0, 1};  // in the shading frame; of a Bsdf with a grain, in the grain's
  AlbedoRow row;         // of a CoatTable, where it is rough
  AlbedoRow inner;       // the same from below, where it is rough and bends

  bool has_lobe() const { return share > 0 && is_shown; }
  bool has_rough_lobe() const { return has_lobe() && !is_smooth; }
  bool has_mirror() const { return has_lobe() && is_smooth; }

  // Directional albedo of the coat where all of the surface wears it.
  float reflected(float cosine) const {
    const float c = std::clamp(cosine, 0.0f, 1.0f);
    return is_smooth ? fresnel_dielectric(c, eta) : std::min(row.at(CosineCoordinate(c)), 1.0f);
  }
  float pass(float cosine) const { return share > 0 ? 1 - share * reflected(cosine) : 1.0f; }

  // What gloss keeps of a direction: of light near the critical angle a rough coat lets out less
  // than it lets in over there.
  float gloss_pass(float cosine) const {
    const float in = pass(cosine);
    if (!(bend > 1) || is_smooth) return in;
    const CosineCoordinate below_it(cosine_below(std::max(cosine, 0.0f)));
    return std::min(in, std::max(0.0f, 1 - inner.at(below_it)));
  }

  // Between the shading frame and that whose z is the coat's normal.
  Vec3 to_own(const Vec3& w) const { return has_normal ? Frame(normal).to_local(w) : w; }
  Vec3 from_own(const Vec3& w) const { return has_normal ? Frame(normal).to_world(w) : w; }

  // Below the coat, of a direction above it: its cosine, all of it.
  float cosine_below(float cosine) const {
    const float sine2 = std::max(0.0f, 1 - cosine * cosine);
    return std::sqrt(std::max(0.0f, 1 - sine2 / (bend * bend)));
  }
  Vec3 below(const Vec3& w) const {
    const Vec3 in{w.x / bend, w.y / bend, 0};
    return {in.x, in.y, std::sqrt(std::max(0.0f, 1 - in.x * in.x - in.y * in.y))};
  }
  // False: beyond the critical angle.
  bool above(const Vec3& in, Vec3& w) const {
    w = {in.x * bend, in.y * bend, 0};
    const float z2 = 1 - w.x * w.x - w.y * w.y;
    if (!(z2 > 0)) return false;
    w.z = std::sqrt(z2);
    return true;
  }
  // Solid angle below per solid angle above, times the cosine above over that below: what turns f
  // cos and densities of directions below into those of directions above (each with its cosine).
  float squeeze(const Vec3& w, const Vec3& in) const {
    return w.z / (bend * bend * std::max(in.z, 1e-9f));
  }

  // What gloss of reflectance R under it keeps, t the smaller pass of both directions.
  Rgb kept(float t, Rgb reflectance) const {
    if (!(bend > 1)) return Rgb{t};
    return Rgb{t * t} / (Rgb{1} - reflectance * (1 - t));
  }
};

// GGX width of gloss below a coat that bends.
inline float widened_below(float alpha, float coat_alpha, float bend) {
  return std::min(std::sqrt(alpha * alpha + 0.5f * sqr((1 - 1 / bend) * coat_alpha)), 1.0f);
}

}  // namespace troffer
