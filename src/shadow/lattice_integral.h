// What a receiver sends on of a cell by a surface that is not matte: the integrand at all of a
// mask's open samples, or a quarter of them, instead of a few points drawn from them.
//
// Where lists are complete that is the answer. Else the sum stands for what is sent on if nothing
// more is in the way, and rays to a few of the points tell what is hidden of it.
// References: docs/certified.md, "Gloss and textures".
#pragma once

#include <cstdint>
#include <vector>

#include "shadow/mask_points.h"
#include "shadow/source_cell_task.h"

namespace troffer {

struct LatticeMemory {
  PointArrays points;
  std::vector<float> weights;
  std::vector<uint16_t> places;  // on the canvas: row × 32 + column
  std::vector<Vec3> drawn;
  std::vector<Rgb> values;
};

// Adds the integrand over the open samples, which send `light`, in sr. `rays`: points that rays are
// cast to where the list is not complete.
void add_lattice_integral(const SourceCellTask& cell, uint32_t member, const OpenSamples& samples,
                          float light, float share_variance, uint32_t rays, uint64_t random,
                          LatticeMemory& memory, SourceResults& results);

}  // namespace troffer
