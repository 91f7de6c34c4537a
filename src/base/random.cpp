#include "base/random.h"

#include "base/simd.h"

namespace troffer {

namespace {

// Primitive polynomials and initial direction numbers of dimensions 1 … 4 [2, new-joe-kuo-6].
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

const std::array<std::array<uint32_t, 32>, sobol_dimensions>& sobol_matrices_reversed() {
  return matrices;
}

}  // namespace troffer
