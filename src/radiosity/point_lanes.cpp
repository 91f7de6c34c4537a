#include "radiosity/point_lanes.h"

#include <cstring>

#include "base/simd.h"

namespace troffer {

namespace {

using Lanes = float __attribute__((vector_size(4 * Receivers::lanes)));

TROFFER_ALWAYS_INLINE void load(const float* from, Lanes& to) {
  std::memcpy(&to, from, sizeof(Lanes));
}

TROFFER_ALWAYS_INLINE float sum_of(const Lanes& v) {
  return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]));
}

}  // namespace

PointLanes::PointLanes(const Receivers& receivers, const std::vector<PointSurface>& surfaces) {
  const size_t slots = receivers.slots();
  area.assign(slots, 0);
  per_area.assign(slots, 0);
  has_specular.assign(slots / Receivers::lanes, 0);
  for (size_t c = 0; c < 3; ++c) {
    reflectance[c].assign(slots, 0);
    specular[c].assign(slots, 0);
  }
  for (const ReceiverBlock& b : receivers.blocks)
    for (uint32_t i = 0; i < b.count; ++i) {
      const PointSurface& s = surfaces[b.first_point + i];
      const uint32_t slot = b.first_slot + i;
      area[slot] = s.area;
      per_area[slot] = s.per_area;
      if (s.has_specular) has_specular[slot / Receivers::lanes] = 1;
      for (size_t c = 0; c < 3; ++c) {
        reflectance[c][slot] = s.reflectance[c];
        specular[c][slot] = s.specular[c];
      }
    }
}

TROFFER_MULTIVERSION
float block_powers(const float* received, const float* area, float sent, uint32_t slots,
                   float* power) {
  Lanes sum = {};
  for (uint32_t at = 0; at < slots; at += Receivers::lanes) {
    Lanes r, a;
    load(received + at, r);
    load(area + at, a);
    const Lanes p = r * sent * a;
    std::memcpy(power + at, &p, sizeof(Lanes));
    sum += p;
  }
  return sum_of(sum);
}

TROFFER_MULTIVERSION
BlockArrival arrive(const PointLanes& lanes, uint32_t first, uint32_t slots, const float* power,
                    const BlockLight& light, float* radiosity) {
  const Rgb weight = {light.tint.r * luminance({1, 0, 0}), light.tint.g * luminance({0, 1, 0}),
                      light.tint.b * luminance({0, 0, 1})};
  Lanes counted = {}, reflected[3] = {}, specular[3] = {};
  const Lanes cap = Lanes{} + light.cap;
  for (uint32_t at = 0; at < slots; at += Receivers::lanes) {
    Lanes p, passed = {}, per_area, held;
    load(power + at, p);
    const Lanes c = (p < cap ? p : cap) * light.scale;
    counted += c;
    for (size_t k = 0; k < 3; ++k) {
      Lanes r;
      load(lanes.reflectance[k].data() + first + at, r);
      reflected[k] += c * r;
      passed += c * r * weight[k];
    }
    if (lanes.has_specular[(first + at) / Receivers::lanes] != 0)
      for (size_t k = 0; k < 3; ++k) {
        Lanes s;
        load(lanes.specular[k].data() + first + at, s);
        specular[k] += c * s;
      }
    load(lanes.per_area.data() + first + at, per_area);
    load(radiosity + at, held);
    held += passed * per_area;
    std::memcpy(radiosity + at, &held, sizeof(Lanes));
  }
  return {sum_of(counted),
          {sum_of(reflected[0]), sum_of(reflected[1]), sum_of(reflected[2])},
          {sum_of(specular[0]), sum_of(specular[1]), sum_of(specular[2])}};
}

TROFFER_MULTIVERSION
void add_irradiance(const float* received, uint32_t slots, const Rgb& radiance,
                    float* const sum[3]) {
  for (size_t c = 0; c < 3; ++c)
    for (uint32_t at = 0; at < slots; at += Receivers::lanes) {
      Lanes r, held;
      load(received + at, r);
      load(sum[c] + at, held);
      held += r * radiance[c];
      std::memcpy(sum[c] + at, &held, sizeof(Lanes));
    }
}

}  // namespace troffer
