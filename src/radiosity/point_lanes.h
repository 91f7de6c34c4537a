// Vectorised operations of a patch's shot on blocks of receivers: received power, reflection and
// irradiance. The solver uses them. Arrays are indexed by slot (receivers.h); padding slots have no
// area.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/rgb.h"
#include "radiosity/point_surfaces.h"
#include "radiosity/receivers.h"

namespace troffer {

// Surface properties of the sample points, by slot.
struct PointLanes {
  std::vector<float> area, per_area;
  std::array<std::vector<float>, 3> reflectance, specular;
  std::vector<uint8_t> has_specular;  // per vector of slots
  PointLanes(const Receivers& receivers, const std::vector<PointSurface>& surfaces);
};

// Sets power[i] = received[i] * sent * area[i]; returns the sum.
float block_powers(const float* received, const float* area, float sent, uint32_t slots,
                   float* power);

// Sums over a block of the light that arrives. Colours are power times reflectance, for white
// light.
struct BlockArrival {
  float counted = 0;  // power after closure
  Rgb reflected, specular;
};
// Properties of the arriving light: `tint` has luminance 1; of each power, min(power, cap) * scale
// counts.
struct BlockLight {
  Rgb tint;
  float cap = 0, scale = 1;
};
// Sums the arriving powers of a block. Adds to `radiosity` the luminance of power that each point
// reflects, per area.
BlockArrival arrive(const PointLanes& lanes, uint32_t first, uint32_t slots, const float* power,
                    const BlockLight& light, float* radiosity);

// Adds radiance[c] * received[i] to sum[c][i].
void add_irradiance(const float* received, uint32_t slots, const Rgb& radiance,
                    float* const sum[3]);

}  // namespace troffer
