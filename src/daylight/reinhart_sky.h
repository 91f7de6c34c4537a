// The sky hemisphere cut into patches: Tregenza's 145, or Reinhart's finer subdivisions of them.
// Annual calculations (annual/) use one luminance per patch and hour. Angles are in radians;
// directions are (east, north, up).
//
// References: [1] Tregenza, "Subdivision of the sky hemisphere for luminance measurements",
//   Lighting Research and Technology 19(1), 1987.
//   [2] Bourgeois, Reinhart & Ward, "Standard daylight coefficient model for dynamic daylighting
//   simulations", Building Research & Information 36(1), 2008.
//   [3] Radiance, gendaymtx(1): order of the patches.
#pragma once

#include <span>
#include <vector>

#include "base/vec.h"
#include "scene/light.h"

namespace troffer {

// A patch between two altitudes and two azimuths, clockwise from north.
struct ReinhartPatch {
  double low = 0, high = 0;            // altitudes
  double left = 0, right = 0;          // azimuths, left < right
  double low_sine = 0, high_sine = 0;  // of the altitudes
  double solid_angle = 0;              // sr
  double cosine = 0;                   // integral of the sine of the altitude over the patch

  // Returns the direction at shares (u, v) of azimuth and of the sine of altitude. Uniform shares
  // give directions uniform in solid angle.
  Vec3d direction(double u, double v) const;
  // Returns the direction of the middle altitude and azimuth, or of the zenith.
  Vec3d centre() const;
};

class ReinhartSky {
 public:
  // subdivision: 1 for Tregenza's patches, m for m² times as many.
  explicit ReinhartSky(int subdivision);

  // Rows from the horizon upward, each from north clockwise, the zenith last: Radiance's order
  // without its ground patch [3].
  const std::vector<ReinhartPatch>& patches() const { return patches_; }
  size_t size() const { return patches_.size(); }
  // Strata per side of a patch that are about 3 degrees wide, as patches of subdivision 4 are.
  size_t strata_per_side() const { return strata_per_side_; }
  // Returns the patch that holds a direction above the horizon, or the one below which it lies.
  size_t at(const Vec3d& direction) const;

 private:
  struct PatchRow {
    size_t first = 0, count = 0;
  };
  size_t strata_per_side_;
  double step_ = 0;  // altitude of a row
  std::vector<PatchRow> rows_;
  std::vector<ReinhartPatch> patches_;
};

// Sets out[i] to the mean luminance of patch i, cd/m², from samples² points; one sample is taken at
// the centre, as gendaymtx does [3]. The patches together
// give a horizontal plane the illuminance diffuse_lx; a black sky stays black.
void patch_luminances(const ReinhartSky& sky, const SkyShape& shape, const Vec3d& to_sun,
                      double diffuse_lx, int samples, std::span<float> out);

}  // namespace troffer
