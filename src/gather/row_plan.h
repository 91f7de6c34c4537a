// Which cells' rays are wanted next, by what cells matter to what is asked.
#pragma once

#include <cstdint>
#include <vector>

#include "cells/cell_rows.h"
#include "gather/cell_rays.h"

namespace troffer {

// How many times what suits a fine error is asked for this one: 1 to 4.
double coarseness(double error, double fine);

class RowPlan {
 public:
  static constexpr size_t pilot_rays = 1 << 17;  // about so many ask
  static constexpr uint32_t rays_of_row = 16;    // first ones of a cell that matters
  static constexpr size_t most_cells = 1 << 21;  // with more nothing is asked for
  static constexpr double fine_error = 0.05;

  // error: asked of the picture, or the points. The rows must outlive it.
  RowPlan(const CellRows& rows, double error, uint64_t seed)
      : rows_(rows), error_(error), seed_(seed) {}

  // That so much light of a cell is asked for. All of it before what follows.
  void ask(uint32_t cell, float light);
  void end_asking();
  // There are so many cells now.
  void see(size_t cells) { asked_.resize(cells, 0); }

  // First rays of cells that have none, and of those that have turned out to matter more than they
  // have rays for; none where all that matters has them, or cells are too many.
  std::vector<CellTask> first_tasks();
  // Further rays of the cells that matter, in proportion to what is asked of them, less what they
  // have had already: as many in all as the first ones, about. frozen: how many cells were kept
  // from other views.
  std::vector<CellTask> further_tasks(size_t frozen);
  // Of cells that matter to points, until there are so many rays in all, in proportion to what is
  // asked of them, or as many as they have. Halves of them have numbers of their own, so that what
  // they differ by tells what their mean is off by: that of one well spread sequence is off by
  // less, but nobody can say by how much.
  std::vector<CellTask> refining_tasks(double rays);
  uint32_t first_rays(uint32_t cell) const;

  const std::vector<float>& asked() const { return asked_; }  // per cell
  // Per cell, all bounces counted, as last looked at.
  const std::vector<float>& importance() const { return importance_; }
  // What of the importance was last of cells without a row.
  double unresolved() const { return unresolved_; }

 private:
  // How many first rays those have that matter.
  double rays_that_matter(size_t frozen) const;
  void look(int bounces);
  CellTask task_of(uint32_t cell, uint32_t first, uint32_t count) const;
  std::vector<uint32_t> cells_to_resolve(int bounces);
  void add_first_tasks(uint32_t cell, uint32_t had, uint32_t count,
                       std::vector<CellTask>& tasks) const;

  const CellRows& rows_;
  double error_;
  uint64_t seed_;
  double of_ray_ = 0;  // importance that a cell's ray is worth
  std::vector<float> asked_, importance_;
  double unresolved_ = 0;
};

}  // namespace troffer
