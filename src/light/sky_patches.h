// Sky patches: lights at infinity as flat sources of certified visibility
// (certified/certified_lights.h). They lie on the faces of a cube so large that it looks the same
// from everywhere in the scene. A sun is a disk at that distance.
//
// For certified visibility a patch is an ordinary quadrilateral. From two places of the scene, a
// point of the cube differs in direction by at most 2^-25. That is less than the rounding margin of
// certificates (docs/method/certified-appendix.md, "Lights at infinity"). Patches are cut where the
// radiance is not smooth: at the horizon, around the sun, and at bright parts of an image.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "light/light_primitive.h"
#include "light/source_surface.h"

namespace troffer {

// Radiance of one colour component over a patch, for (u,v) in [0,1]²: the sum of c[i][j] u^i v^j.
using FarPolynomial = std::array<std::array<float, 4>, 4>;

// Radiance over a face of the cube: `size` × `size` values, row-major, v upwards.
struct FarTable {
  int size = 0;
  std::vector<Rgb> values;
};

// One sky patch. Lengths in metres.
struct SkyPatch {
  uint32_t primitive = 0;  // index of the light's primitive
  Parallelogram plane;     // its normal points to the scene
  bool is_disk = false;    // the source is the inscribed disk
  bool is_even = false;    // uniform radiance `mean`
  Rgb mean;                // mean radiance by solid angle
  float unevenness = 1;    // root mean square of luminance / its mean
  // Radiance in direction d, which must end on the patch, is a function of (u,v) = (d · along_u -
  // from_u, d · along_v - from_v). It is given by polynomials for r, g, b, or by the part of a
  // table that begins at (table_x, table_y).
  Vec3 along_u, along_v;
  float from_u = 0, from_v = 0;
  double height = 0;  // distance of the scene's centre from the patch's plane
  std::array<FarPolynomial, 3> fit{};
  bool is_grey = false;             // all three polynomials are equal
  const FarTable* table = nullptr;  // null: the polynomials hold
  int table_x = 0, table_y = 0, table_size = 0;

  // True if the patch covers this direction, seen from the scene.
  bool holds(const Vec3& direction) const;
};

class SkyPatches {
 public:
  SkyPatches() = default;
  // Cuts all environment lights except delta lights into patches. Patches without light are left
  // out. So are patches of uniform lights that the light's portal hides from everywhere.
  // Deterministic.
  SkyPatches(const Scene& scene, const LightPrimitives& primitives);
  SkyPatches(const SkyPatches&) = delete;
  SkyPatches& operator=(const SkyPatches&) = delete;
  SkyPatches(SkyPatches&&) = default;
  SkyPatches& operator=(SkyPatches&&) = default;

  const std::vector<SkyPatch>& all() const { return cells_; }

 private:
  std::vector<SkyPatch> cells_;
  std::vector<std::unique_ptr<const FarTable>> tables_;
};

// True if lights of this kind are cut into sky patches.
inline bool has_sky_patches(LightKind kind) {
  return kind == LightKind::environment || kind == LightKind::sky || kind == LightKind::sun;
}

// Computes the radiance of a patch at n of its points, as vectors from the scene's centre or from
// any receiver.
void far_radiance(const SkyPatch& cell, size_t n, const float* x, const float* y, const float* z,
                  float* r, float* g, float* b);

}  // namespace troffer
