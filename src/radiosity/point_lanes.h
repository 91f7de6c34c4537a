// What a patch's shot does at blocks of receivers, several points to a vector register. Arrays run
// by slot (receivers.h); slots that only pad a block have no area.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/rgb.h"
#include "radiosity/point_surfaces.h"
#include "radiosity/receivers.h"

namespace troffer {

// Surfaces of sample points, by slot.
struct PointLanes {
  std::vector<float> area, per_area;
  std::array<std::vector<float>, 3> reflectance, specular;
  std::vector<uint8_t> has_specular;  // per vector of slots
  PointLanes(const Receivers& receivers, const std::vector<PointSurface>& surfaces);
};

// power[i] = received[i] * sent * area; returns their sum.
float block_powers(const float* received, const float* area, float sent, uint32_t slots,
                   float* power);

// What becomes of light that arrives: sums over a block. A colour is power times reflectance, for
// light that is white; radiosity gets what each point sends on of light of this colour, per area.
struct BlockArrival {
  float counted = 0;  // power, after closure
  Rgb reflected, specular;
};
// `tint`: of the light, luminance 1. Of each power min(power, cap) * scale counts.
struct BlockLight {
  Rgb tint;
  float cap = 0, scale = 1;
};
BlockArrival arrive(const PointLanes& lanes, uint32_t first, uint32_t slots, const float* power,
                    const BlockLight& light, float* radiosity);

// sum[c][i] += radiance[c] * received[i]
void add_irradiance(const float* received, uint32_t slots, const Rgb& radiance,
                    float* const sum[3]);

}  // namespace troffer
