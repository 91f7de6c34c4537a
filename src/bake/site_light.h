// Computes the irradiance of small areas: the part of a surface in a texel, or around a vertex.
//
// An area is a list of pieces. Its value is the mean of samples uniform by area, or weighted by a
// vertex's influence, so every sample lies on the surface. Samples inside a body (a floor below a
// wall) would darken the mean at its foot. They do not count if all rays from them hit backs of
// surfaces and no light reaches them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/parallel.h"
#include "render/progress.h"
#include "transport/integrator.h"

namespace troffer {

// A triangle in world space, relative to the scene's origin.
struct Piece {
  std::array<Vec3, 3> positions;
  std::array<Vec3, 3> normals;   // shading normals, on the lit side
  Vec3 geometric_normal;         // unit, on the lit side
  double weight = 0;             // weight of the piece in the area's mean
  bool is_about_corner = false;  // true: sampled by the weight of corner 0 (a vertex); false:
                                 // uniformly
};

// Areas to light. Neighbouring areas should be close in the list.
class SiteList {
 public:
  virtual ~SiteList() = default;
  virtual size_t size() const = 0;
  // Appends the pieces of a site.
  virtual void pieces(size_t site, std::vector<Piece>& out) const = 0;
};

// Light of one site.
struct SiteLight {
  Rgb irradiance;         // W/m², or lx per channel in photometric scenes
  float error = 0;        // standard error of its luminance
  bool is_known = false;  // false: no area, or entirely inside a body
  Vec3 place, normal;     // brightest sample that counts
};

// Settings of light_sites().
struct SiteSettings {
  int samples = 64;  // per site
  int threads = 0;
  uint64_t seed = 0;
  // True if sites are texels: dark samples that are cut off from lit ones (cut_off.h) do not count.
  bool are_texels = false;
  // True if light of all bounces is computed: a dark place then gets no light at all.
  bool is_all_light = true;
};

// Returns the light of each site; empty if `stop` was set. Values do not depend on the number of
// threads.
std::vector<SiteLight> light_sites(const PreparedScene& scene, const Integrator& integrator,
                                   const SiteList& sites, const SiteSettings& settings,
                                   const ProgressCallback& progress, const StopFlag& stop,
                                   Counters& counters);

// Returns the share of rays from a site that hit fronts of surfaces.
float share_of_fronts(const PreparedScene& scene, const SiteList& sites, size_t site,
                      uint64_t seed);

}  // namespace troffer
