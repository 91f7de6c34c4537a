// Inner loops of occluders_gather.cpp for vectors of `width` numbers. That file includes this one
// once per instruction set, with TROFFER_CULL_WIDTH and TROFFER_CULL_NAMESPACE defined and under
// the pragma that selects the set. Functions here must not call functions from elsewhere. All
// widths give the same results.
#ifndef TROFFER_CULL_WIDTH
#include <cstdint>
#define TROFFER_CULL_WIDTH 4
#define TROFFER_CULL_NAMESPACE cull_alone
#endif

namespace troffer::TROFFER_CULL_NAMESPACE {

using Floats = float __attribute__((vector_size(4 * TROFFER_CULL_WIDTH)));
using Ints = int32_t __attribute__((vector_size(4 * TROFFER_CULL_WIDTH)));

// Returns bit i set if box i of 8 lies outside one plane. lower, upper: x, y, z of the boxes.
uint32_t boxes_outside(const float* lower, const float* upper, const float* x, const float* y,
                       const float* z, const float* distance, int planes) {
  constexpr int width = TROFFER_CULL_WIDTH;
  uint32_t outside = 0;
  for (int first = 0; first < 8; first += width) {
    Ints is_outside = {};
    for (int p = 0; p < planes; ++p) {
      // the corner that is farthest inwards
      Floats bx, by, bz;
      __builtin_memcpy(&bx, (x[p] > 0 ? lower : upper) + first, sizeof bx);
      __builtin_memcpy(&by, (y[p] > 0 ? lower : upper) + 8 + first, sizeof by);
      __builtin_memcpy(&bz, (z[p] > 0 ? lower : upper) + 16 + first, sizeof bz);
      is_outside |= bx * x[p] + by * y[p] + bz * z[p] > distance[p];
    }
    for (int i = 0; i < width; ++i) outside |= uint32_t(is_outside[i] & 1) << (first + i);
  }
  return outside;
}

// True if the facet v (four vertices) lies outside one plane. Planes are padded to a multiple of 8.
bool facet_outside(const float* v, const float* x, const float* y, const float* z,
                   const float* distance, int padded_planes) {
  constexpr int width = TROFFER_CULL_WIDTH;
  Ints is_outside = {};
  for (int p = 0; p < padded_planes; p += width) {
    Floats px, py, pz, least;
    __builtin_memcpy(&px, x + p, sizeof px);
    __builtin_memcpy(&py, y + p, sizeof py);
    __builtin_memcpy(&pz, z + p, sizeof pz);
    __builtin_memcpy(&least, distance + p, sizeof least);
    Ints all = Ints{} - 1;
    for (int i = 0; i < 4; ++i)
      all &= v[3 * i] * px + v[3 * i + 1] * py + v[3 * i + 2] * pz > least;
    is_outside |= all;
  }
  int32_t any = 0;
  for (int i = 0; i < width; ++i) any |= is_outside[i];
  return any != 0;
}

}  // namespace troffer::TROFFER_CULL_NAMESPACE

#undef TROFFER_CULL_WIDTH
#undef TROFFER_CULL_NAMESPACE
