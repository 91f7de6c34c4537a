// Integrates a textured light or a glossy reflection over a mask: evaluates the integrand at all
// open samples, or at every second or fourth row and column of them. mask_cell.cpp uses it for
// smooth integrands. With a complete list the sum is the answer. Otherwise the sum assumes that
// nothing else hides the samples, and rays to a few of the points estimate what is hidden.
// References: docs/method/certified-appendix.md, "Gloss and textures".
#pragma once

#include <cstdint>
#include <vector>

#include "shadow/mask_points.h"
#include "shadow/source_cell_task.h"

namespace troffer {

// Working memory of add_lattice_integral.
struct LatticeMemory {
  PointArrays points;
  std::vector<float> weights;
  std::vector<uint16_t> places;  // on the canvas: row × 32 + column
  std::vector<Vec3> drawn;
  std::vector<Rgb> values;
};

// Adds the integrand over the open samples, which send `light` sr. rays: number of points that rays
// are cast to if the list is incomplete.
void add_lattice_integral(const SourceCellTask& cell, uint32_t member, const OpenSamples& samples,
                          float light, float share_variance, uint32_t rays, uint64_t random,
                          LatticeMemory& memory, SourceResults& results);

}  // namespace troffer
