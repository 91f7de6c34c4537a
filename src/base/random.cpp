#include "base/random.h"

#include <algorithm>
#include <numeric>

#include "base/simd.h"

namespace troffer {

namespace {

// Primitive polynomials and initial direction numbers of dimensions 1 to 4 [2, new-joe-kuo-6].
struct Polynomial {
  unsigned degree, coefficients;
  std::array<uint32_t, 3> initial;
};
constexpr std::array<Polynomial, 4> polynomials{{
    {1, 0, {1, 0, 0}},
    {2, 1, {1, 3, 0}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
}};

constexpr std::array<std::array<uint32_t, 32>, sobol_dimensions> make_matrices() {
  std::array<std::array<uint32_t, 32>, sobol_dimensions> reversed{};
  for (unsigned k = 0; k < 32; ++k) reversed[0][k] = 1u << k;
  for (size_t d = 0; d < polynomials.size(); ++d) {
    const Polynomial& p = polynomials[d];
    std::array<uint32_t, 32> v{};
    for (unsigned k = 0; k < 32; ++k) {
      if (k < p.degree) {
        v[k] = p.initial[k] << (31 - k);
        continue;
      }
      v[k] = v[k - p.degree] ^ (v[k - p.degree] >> p.degree);
      for (unsigned j = 1; j < p.degree; ++j)
        if ((p.coefficients >> (p.degree - 1 - j)) & 1u) v[k] ^= v[k - j];
    }
    for (unsigned k = 0; k < 32; ++k) reversed[d + 1][k] = reverse_bits(v[k]);
  }
  return reversed;
}

constexpr auto matrices = make_matrices();

constexpr SobolBytes make_bytes() {
  SobolBytes bytes{};
  for (size_t d = 0; d < bytes.size(); ++d)
    for (size_t b = 0; b < 4; ++b)
      for (size_t v = 1; v < 256; ++v) {
        // v without its lowest bit is done already
        const size_t bit = size_t(std::countr_zero(v));
        bytes[d][b][v] = bytes[d][b][v & (v - 1)] ^ matrices[d + 2][8 * b + bit];
      }
  return bytes;
}

}  // namespace

constexpr SobolBytes sobol_bytes = make_bytes();

TROFFER_MULTIVERSION
void sobol_groups(const uint64_t* streams, const uint32_t* samples, size_t n, uint32_t purpose,
                  int dimensions, float* out) {
  for (size_t i = 0; i < n; ++i) {
    const Vec2 v = SobolGroup(streams[i], purpose, samples[i]).get2(0);
    out[i] = v.x;
    out[n + i] = v.y;
  }
  if (dimensions == 3)
    for (size_t i = 0; i < n; ++i)
      out[2 * n + i] = SobolGroup(streams[i], purpose, samples[i]).get(2);
  if (dimensions == 4)
    for (size_t i = 0; i < n; ++i) {
      const Vec2 v = SobolGroup(streams[i], purpose, samples[i]).get2(2);
      out[2 * n + i] = v.x;
      out[3 * n + i] = v.y;
    }
}

namespace {

// Interleaves the upper 16 bits of two words.
uint32_t morton_code(uint32_t x, uint32_t y) {
  uint32_t code = 0;
  for (int b = 31; b >= 16; --b) code = (code << 2) | (((x >> b) & 1u) << 1) | ((y >> b) & 1u);
  return code;
}

TROFFER_MULTIVERSION
void draw_pair(const uint32_t* order, uint32_t n, uint32_t high, uint32_t scramble_x,
               uint32_t scramble_y, float* __restrict x, float* __restrict y) {
  for (uint32_t i = 0; i < n; ++i) {
    const uint32_t index = high | order[i];
    x[i] = unit_float(reverse_bits(owen_hash_reversed(sobol_reversed(index, 0), scramble_x)));
    y[i] = unit_float(reverse_bits(owen_hash_reversed(sobol_reversed(index, 1), scramble_y)));
  }
}

}  // namespace

SobolBlocks::SobolBlocks(uint32_t n) : order_(n) {
  std::iota(order_.begin(), order_.end(), 0u);
  if (!std::has_single_bit(n)) return;
  const auto place = [](uint32_t i) {
    return morton_code(reverse_bits(sobol_reversed(i, 0)), reverse_bits(sobol_reversed(i, 1)));
  };
  std::stable_sort(order_.begin(), order_.end(),
                   [&](uint32_t a, uint32_t b) { return place(a) < place(b); });
}

void SobolBlocks::draw(uint64_t stream, uint32_t purpose, uint32_t block, int dimensions,
                       float* out) const {
  const uint32_t n = size(), first = block * n;
  SobolGroup group(stream, purpose, first);
  if (!std::has_single_bit(n)) {
    for (uint32_t i = 0; i < n; ++i) {
      group.index_ = nested_uniform_scramble(first + i, uint32_t(group.seed_));
      for (int d = 0; d < dimensions; ++d) out[uint32_t(d) * n + i] = group.get(d);
    }
    return;
  }
  // Shuffling moves the block as a whole; within the block it changes only the order.
  const uint32_t high = group.index_ & ~(n - 1);
  const uint64_t scrambles = group.scrambles_of(0);
  draw_pair(order_.data(), n, high, uint32_t(scrambles), uint32_t(scrambles >> 32), out, out + n);
  for (uint32_t i = 0; dimensions > 2 && i < n; ++i) {
    group.index_ = high | order_[i];
    out[2 * n + i] = group.get(2);
  }
}

const std::array<std::array<uint32_t, 32>, sobol_dimensions>& sobol_matrices_reversed() {
  return matrices;
}

}  // namespace troffer
