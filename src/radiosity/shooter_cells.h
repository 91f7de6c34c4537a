// Represents a patch by about a dozen cells, for receivers so distant that each cell counts as a
// point. Cells of flat patches are triangles of similar size; those of curved patches are their
// sample points. Each cell has the share of the nearest part. Together the cells send what the
// patch sends.
#pragma once

#include <vector>

#include "radiosity/receivers.h"
#include "radiosity/shooter.h"

namespace troffer {

std::vector<ShooterCell> shooter_cells(const RadiosityMesh& mesh, uint32_t patch,
                                       const Shooter& shooter);

// Bounds of the cells, for tests on whole blocks of receivers.
struct ShooterBounds {
  Vec3 centre, normal;
  float radius = 0, cell_radius = 0;
  bool is_flat = true;
  ShooterBounds(const std::vector<ShooterCell>& cells, const Shooter& shooter);
};

// Levels of detail of the cells: distant receivers use fewer.
class CellLevels {
 public:
  CellLevels(const std::vector<ShooterCell>& cells, const ShooterBounds& bounds);
  const std::vector<ShooterCell>& for_block(const ReceiverBlock& b) const;

 private:
  Vec3 centre_;
  float radius_;
  std::vector<ShooterCell> all_, groups_, one_;  // without corners; empty: use all_
};

// True if no point of the block rises noticeably above the shooter's plane, or the reverse:
// surfaces in contact or in one plane exchange nothing.
bool is_out_of_sight(const ShooterBounds& s, const ReceiverBlock& b);

}  // namespace troffer
