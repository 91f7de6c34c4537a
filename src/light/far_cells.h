// Lights at infinity as flat sources: the faces of a cube so large that from everywhere in the
// scene it looks the same, cut into cells; a sun is a disk at that distance.
//
// A cell is a quadrilateral for all that certified visibility does with sources. From two places of
// the scene a point of the cube lies in directions that differ by 2^-20 at most, which is less than
// certificates leave in doubt (docs/certified.md, "Lights at infinity"). Cells are cut where the
// radiance is not smooth: at the horizon, about the sun, where an image has its light.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "light/light_primitive.h"
#include "light/source_surface.h"

namespace troffer {

// Radiance in one colour over a cell, (u,v) in [0,1]²: sum of c[i][j] u^i v^j.
using FarPolynomial = std::array<std::array<float, 4>, 4>;

// Over a face of the cube, `size` × `size` values; row-major, v upwards.
struct FarTable {
  int size = 0;
  std::vector<Rgb> values;
};

struct FarCell {
  uint32_t primitive = 0;  // of the light
  Parallelogram plane;     // its normal points to the scene
  bool is_disk = false;    // the disk inscribed in it
  bool is_even = false;    // of one radiance, `mean`
  Rgb mean;                // radiance, by solid angle
  float unevenness = 1;    // root of the mean square of luminance over its mean
  // Radiance in the direction d by (u,v) = (d · along_u - from_u, …), d ending on the cell: by
  // polynomials for r, g, b, or by the part of a table that begins at (table_x, table_y).
  Vec3 along_u, along_v;
  float from_u = 0, from_v = 0;
  double height = 0;  // of the scene over the cell's plane
  std::array<FarPolynomial, 3> fit{};
  bool is_grey = false;             // all three are the same
  const FarTable* table = nullptr;  // null: the polynomials hold
  int table_x = 0, table_y = 0, table_size = 0;

  // Whether the cell lies in this direction from the scene.
  bool holds(const Vec3& direction) const;
};

class FarCells {
 public:
  FarCells() = default;
  // The cells of all lights at infinity but deltas, those without light left out, and of even
  // lights those that their portal shows to nobody. Deterministic.
  FarCells(const Scene& scene, const LightPrimitives& primitives);
  FarCells(const FarCells&) = delete;
  FarCells& operator=(const FarCells&) = delete;
  FarCells(FarCells&&) = default;
  FarCells& operator=(FarCells&&) = default;

  const std::vector<FarCell>& all() const { return cells_; }

 private:
  std::vector<FarCell> cells_;
  std::vector<std::unique_ptr<const FarTable>> tables_;
};

// Whether a light is cut into such cells.
inline bool has_far_cells(LightKind kind) {
  return kind == LightKind::environment || kind == LightKind::sky || kind == LightKind::sun;
}

// Radiance of a cell at n of its points, given from the scene (or from the receiver, which is the
// same).
void far_radiance(const FarCell& cell, size_t n, const float* x, const float* y, const float* z,
                  float* r, float* g, float* b);

}  // namespace troffer
