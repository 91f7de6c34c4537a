// Solves the balance of light on cells, E = D + W E, for one state and one block of sources, and
// gathers the result at sensors.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "annual/block_light.h"
#include "annual/state_cells.h"

namespace troffer {

class BlockSolver {
 public:
  // shared: direct light from the block in the scene of `cells`. own: of the state; null for the
  // state whose scene that is. tracer: of the state. region: of the state; unused if own is null.
  BlockSolver(const TransportCells& cells, const SharedBlockLight& shared, const StateCells* own,
              const Tracer& tracer, const SourceBlock& block, size_t region);

  void solve();
  // Sets the coefficients of the block's sources in those of a sensor.
  void gather(size_t sensor, std::span<float> coefficients) const;

 private:
  using LightOfCell = std::array<float, 3 * SourceBlock::most>;  // channel by channel

  void light_up(const SharedBlockLight& shared, const Tracer& tracer, size_t region);
  void light_up_own(const Tracer& tracer);
  void add(std::span<const CellLink> links, float* sum) const;
  void add(const Rgb& light, size_t source, float* sum) const;
  void add_outside(std::span<const OutsideLink> ways, float* sum) const;
  void relax(size_t cell, float* change);
  float* direct_of(size_t cell) { return &direct_[cell * cell_floats_]; }

  const TransportCells& cells_;
  const StateCells* own_;
  const SourceBlock& block_;
  size_t channels_, cell_floats_;
  std::vector<float> direct_, total_;  // of shared cells, then of own ones; channel by channel
  bool is_dark_ = false;               // no source lights any cell
};

}  // namespace troffer
