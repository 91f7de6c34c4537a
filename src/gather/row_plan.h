// Decides which cells' rays are traced next, by the importance of cells for what is asked. Used by
// cell_builder.cpp.
#pragma once

#include <cstdint>
#include <vector>

#include "cells/cell_rows.h"
#include "gather/cell_rays.h"

namespace troffer {

// Returns `error` over `fine`, from 1 to 4: how much coarser than for a fine error things may be.
double coarseness(double error, double fine);

class RowPlan {
 public:
  static constexpr size_t pilot_rays = 1 << 17;  // about, for all pilot places together
  static constexpr uint32_t rays_of_row = 16;    // first ones of a cell that matters
  static constexpr size_t most_cells = 1 << 21;  // with more, no rays are planned
  static constexpr double fine_error = 0.05;

  // error: asked of the picture, or of the points. The rows must outlive it.
  RowPlan(const CellRows& rows, double error, uint64_t seed)
      : rows_(rows), error_(error), seed_(seed) {}

  // Adds light that is asked of a cell. Call it for all of them, then end_asking(), before what
  // follows.
  void ask(uint32_t cell, float light);
  void end_asking();
  // Sets the number of cells.
  void see(size_t cells) { asked_.resize(cells, 0); }

  // Returns first rays of cells that have none, and of those that deserve at least twice as many as
  // they have. Empty if all that matter have them, or if there are too many cells.
  std::vector<CellTask> first_tasks();
  // Returns further rays of cells in proportion to their importance, less those that they already
  // have: about as many in all as first rays. frozen: number of cells kept from other views.
  std::vector<CellTask> further_tasks(size_t frozen);
  // Returns rays of cells in proportion to their importance, so that all cells have about `rays` in
  // all. The two halves of a cell's rays have sequences of their own, so their difference shows the
  // error of the mean. Halves of one sequence would differ by more than their mean errs by, by an
  // unknown factor.
  std::vector<CellTask> refining_tasks(double rays);
  // Returns the number of first rays of a cell, 1 to rays_of_row.
  uint32_t first_rays(uint32_t cell) const;

  const std::vector<float>& asked() const { return asked_; }  // per cell
  // Per cell, all bounces counted, at the last look.
  const std::vector<float>& importance() const { return importance_; }
  // Share of importance at cells without a row, at the last look.
  double unresolved() const { return unresolved_; }

 private:
  // Returns the number of first rays of cells that matter.
  double rays_that_matter(size_t frozen) const;
  void look(int bounces);
  CellTask task_of(uint32_t cell, uint32_t first, uint32_t count) const;
  std::vector<uint32_t> cells_to_resolve(int bounces);
  void add_first_tasks(uint32_t cell, uint32_t had, uint32_t count,
                       std::vector<CellTask>& tasks) const;

  const CellRows& rows_;
  double error_;
  uint64_t seed_;
  double of_ray_ = 0;  // importance that is worth one ray
  std::vector<float> asked_, importance_;
  double unresolved_ = 0;
};

}  // namespace troffer
