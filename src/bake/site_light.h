// Irradiance of small areas of surfaces: of what a texel covers, of what lies about a vertex.
//
// An area is a list of pieces, and its value is the mean over them, of samples spread evenly by
// area (or, about a vertex, by how much a vertex counts there). So no sample lies off the surface,
// however little of a texel a surface covers. What lies within another body (a floor under a wall)
// gets no light, and would pull the mean down at its foot: samples from where all looks go to the
// backs of surfaces, and to which no light comes, do not count.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/parallel.h"
#include "render/progress.h"
#include "transport/integrator.h"

namespace troffer {

// A triangle in the world, counted from the scene's origin.
struct Piece {
  std::array<Vec3, 3> positions;
  std::array<Vec3, 3> normals;   // shading normals, on the lit side
  Vec3 geometric_normal;         // unit, likewise
  double weight = 0;             // of the piece in its area's mean
  bool is_about_corner = false;  // counts by the weight of corner 0 (a vertex), else evenly
};

// Areas whose light is asked for; those that lie together stand side by side.
class SiteList {
 public:
  virtual ~SiteList() = default;
  virtual size_t size() const = 0;
  // Appends what the site consists of.
  virtual void pieces(size_t site, std::vector<Piece>& out) const = 0;
};

struct SiteLight {
  Rgb irradiance;         // W/m², or lx per channel where the scene is photometric
  float error = 0;        // standard error of its luminance
  bool is_known = false;  // false: without area, or all within another body
  Vec3 place, normal;     // of the brightest sample that counts
};

struct SiteSettings {
  int samples = 64;  // of a site
  int threads = 0;
  uint64_t seed = 0;
  // Sites are small: dark samples that something keeps apart from lit ones (cut_off.h) do not
  // count.
  bool are_texels = false;
  // All light is asked for, so that what is dark lies where no light comes to by any way.
  bool is_all_light = true;
};

// One for each site; empty once `stop` is set. The values do not depend on threads.
std::vector<SiteLight> light_sites(const PreparedScene& scene, const Integrator& integrator,
                                   const SiteList& sites, const SiteSettings& settings,
                                   const ProgressCallback& progress, const StopFlag& stop,
                                   Counters& counters);

// The share of looks from a site that end at fronts of surfaces.
float share_of_fronts(const PreparedScene& scene, const SiteList& sites, size_t site,
                      uint64_t seed);

}  // namespace troffer
