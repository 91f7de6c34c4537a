// A patch as a dozen cells, for receivers that are far enough from it to take each as a point.
#pragma once

#include <vector>

#include "radiosity/receivers.h"
#include "radiosity/shooter.h"

namespace troffer {

// Flat patches: triangles of about equal size; curved ones: their sample points. Each has the share
// of the part that is nearest to it, and together they send what the patch does.
std::vector<ShooterCell> shooter_cells(const RadiosityMesh& mesh, uint32_t patch,
                                       const Shooter& shooter);

// Where they are, for whole blocks of receivers.
struct ShooterBounds {
  Vec3 centre, normal;
  float radius = 0, cell_radius = 0;
  bool is_flat = true;
  ShooterBounds(const std::vector<ShooterCell>& cells, const Shooter& shooter);
};

// Fewer cells for receivers that are farther away.
class CellLevels {
 public:
  CellLevels(const std::vector<ShooterCell>& cells, const ShooterBounds& bounds);
  const std::vector<ShooterCell>& for_block(const ReceiverBlock& b) const;

 private:
  Vec3 centre_;
  float radius_;
  std::vector<ShooterCell> all_, groups_, one_;  // without corners; empty: as all_
};

// What hardly rises over a plane gets nothing from it: surfaces in contact, and all in one plane.
bool is_out_of_sight(const ShooterBounds& s, const ReceiverBlock& b);

}  // namespace troffer
