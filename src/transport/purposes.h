// What random numbers are for. Each purpose is a Sobol group of its own (base/random.h).
#pragma once

#include <cstdint>

namespace troffer {

constexpr uint32_t purpose_camera = 0;  // raster position, lens
// Per vertex of a path, counted from the first surface:
constexpr uint32_t purpose_scatter(uint32_t vertex) {
  return 1 + 2 * vertex;
}
constexpr uint32_t purpose_light(uint32_t vertex) {
  return 2 + 2 * vertex;
}

// Whether a spawned walk goes on, and a light is drawn for the gloss that would spawn it.
constexpr uint32_t purpose_roulette(uint32_t vertex) {
  return 0x8000'0000u + vertex;
}

}  // namespace troffer
