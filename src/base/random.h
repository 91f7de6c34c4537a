// Hashes and Owen-scrambled Sobol points. Random streams derive from (pixel, sample, purpose),
// never from threads. Used by all sampling.
//
// References: [1] Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020.
//   [2] Joe & Kuo, "Constructing Sobol Sequences with Better Two-Dimensional Projections", 2008.
//   [3] O'Neill, "PCG", 2014 (output permutation used as a hash).
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/units.h"
#include "base/vec.h"

namespace troffer {

// Bijective 64-bit finaliser (splitmix64).
constexpr uint64_t mix64(uint64_t x) {
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9ull;
  x ^= x >> 27;
  x *= 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}
constexpr uint64_t hash_combine(uint64_t seed, uint64_t v) {
  return mix64(seed + 0x9e3779b97f4a7c15ull + mix64(v + 0x632be59bd9b4e019ull));
}
template <class... Rest>
constexpr uint64_t hash_of(uint64_t first, Rest... rest) {
  uint64_t h = mix64(first + 0x9e3779b97f4a7c15ull);
  ((h = hash_combine(h, uint64_t(rest))), ...);
  return h;
}

// Uniform in [0,1) from the top 24 bits of a 32-bit word.
constexpr float unit_float(uint32_t bits) {
  return float(bits >> 8) * 0x1p-24f;
}

// A plain stream of independent numbers, for tests and for uses without stratification.
class Random {
 public:
  explicit Random(uint64_t seed) : state_(mix64(seed + 0x853c49e6748fea9bull)) {}
  uint32_t next_u32() { return uint32_t(next_u64() >> 32); }
  uint64_t next_u64() {
    state_ += 0x9e3779b97f4a7c15ull;
    return mix64(state_);
  }
  float next_float() { return unit_float(next_u32()); }
  double next_double() { return double(next_u64() >> 11) * 0x1p-53; }
  Vec2 next_vec2() {
    const float x = next_float();
    return {x, next_float()};
  }

 private:
  uint64_t state_;
};

constexpr uint32_t reverse_bits(uint32_t x) {
  x = (x << 16) | (x >> 16);
  x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
  x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
  return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

// Owen scrambling runs from the most to the least significant bit. On the reversed word it is a
// hash whose bits depend only on lower bits [1, section 3; constants by N. Vegdahl].
constexpr uint32_t owen_hash_reversed(uint32_t x, uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}
constexpr uint32_t nested_uniform_scramble(uint32_t x, uint32_t seed) {
  return reverse_bits(owen_hash_reversed(reverse_bits(x), seed));
}

constexpr int sobol_dimensions = 5;

// Bit-reversed Sobol direction numbers, so that a point is ready for owen_hash_reversed.
const std::array<std::array<uint32_t, 32>, sobol_dimensions>& sobol_matrices_reversed();

// XOR of the direction numbers of dimensions 2 to 4 for every value of each index byte: 12 KiB. It
// replaces a loop over the bits of a scrambled index.
using SobolBytes = std::array<std::array<std::array<uint32_t, 256>, 4>, sobol_dimensions - 2>;
extern const SobolBytes sobol_bytes;

// Bit-reversed coordinate `dimension` (0 to 4) of Sobol point `index`.
inline uint32_t sobol_reversed(uint32_t index, int dimension) {
  if (dimension == 0) return index;  // van der Corput: the reversals cancel
  if (dimension == 1) {
    // Direction number k is row k of Pascal's triangle mod 2. Bit j of the result is the parity of
    // the index bits whose position contains j as a subset: one step per bit of a position.
    uint32_t x = index;
    x ^= (x & 0xaaaaaaaau) >> 1;
    x ^= (x & 0xccccccccu) >> 2;
    x ^= (x & 0xf0f0f0f0u) >> 4;
    x ^= (x & 0xff00ff00u) >> 8;
    return x ^ (x >> 16);
  }
  const auto& bytes = sobol_bytes[size_t(dimension - 2)];
  return bytes[0][index & 255] ^ bytes[1][(index >> 8) & 255] ^ bytes[2][(index >> 16) & 255] ^
         bytes[3][index >> 24];
}

// Padded Owen-scrambled Sobol set. Dimensions come in groups; a group serves one purpose, such as
// "bounce 2, light", and has its own scramble and index shuffle [1, section 4]. Each group alone is
// a (0,m,2)-net in its first two dimensions and well stratified in all five.
class SobolGroup {
 public:
  // `stream` is a hash of pixel and seed, `purpose` the number of the group, `index` the sample.
  SobolGroup(uint64_t stream, uint32_t purpose, uint32_t index)
      : seed_(mix64(stream + (uint64_t(purpose) + 1) * golden)),
        index_(nested_uniform_scramble(index, uint32_t(seed_))) {}
  float get(int dimension) const {
    const uint64_t scrambles = scrambles_of(dimension / 2);
    return value(dimension, uint32_t(dimension % 2 == 0 ? scrambles : scrambles >> 32));
  }
  // Dimensions `first` (even) and first + 1.
  Vec2 get2(int first = 0) const {
    const uint64_t scrambles = scrambles_of(first / 2);
    return {value(first, uint32_t(scrambles)), value(first + 1, uint32_t(scrambles >> 32))};
  }

 private:
  friend class SobolBlocks;
  static constexpr uint64_t golden = 0x9e3779b97f4a7c15ull;
  // Two 32-bit scrambles for a pair of dimensions.
  uint64_t scrambles_of(int pair) const { return mix64(seed_ + uint64_t(pair + 1) * golden); }
  float value(int dimension, uint32_t scramble) const {
    return unit_float(
        reverse_bits(owen_hash_reversed(sobol_reversed(index_, dimension), scramble)));
  }

  uint64_t seed_;
  uint32_t index_;
};

// Blocks of n consecutive samples of a group. If n is a power of two, they come in spatial order:
// every 2^k of them, counted from the first, fill one elementary interval of the first two
// dimensions. The order is that of the unscrambled points along a Morton curve; scrambling moves
// elementary intervals as wholes.
class SobolBlocks {
 public:
  explicit SobolBlocks(uint32_t n = 1);
  uint32_t size() const { return uint32_t(order_.size()); }
  // Computes the first `dimensions` (2 or 3) values of samples [block * n, block * n + n) of
  // SobolGroup(stream, purpose, ·). out[d * n + i] is dimension d of the i-th one.
  void draw(uint64_t stream, uint32_t purpose, uint32_t block, int dimensions, float* out) const;

 private:
  std::vector<uint32_t> order_;
};

// Computes the first `dimensions` (2 to 4) values of SobolGroup(streams[i], purpose, samples[i])
// for all i < n in one vectorised pass. out[d * n + i] is dimension d of group i.
void sobol_groups(const uint64_t* streams, const uint32_t* samples, size_t n, uint32_t purpose,
                  int dimensions, float* out);

}  // namespace troffer
