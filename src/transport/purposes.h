// Purposes of random numbers. Each purpose is a Sobol group of its own (base/random.h), so that
// numbers of different purposes are independent. A number is identified by stream, purpose, sample
// and dimension. Used by all code that samples paths or viewing rays.
#pragma once

#include <cstdint>

namespace troffer {

constexpr uint32_t purpose_camera = 0;  // raster position, lens
// Scattering and light sampling at a vertex of a path; vertices count from the first surface.
constexpr uint32_t purpose_scatter(uint32_t vertex) {
  return 1 + 2 * vertex;
}
constexpr uint32_t purpose_light(uint32_t vertex) {
  return 2 + 2 * vertex;
}

// Russian roulette of spawned walks, and the choice to sample a light for the gloss that would
// spawn one.
constexpr uint32_t purpose_roulette(uint32_t vertex) {
  return 0x8000'0000u + vertex;
}

}  // namespace troffer
