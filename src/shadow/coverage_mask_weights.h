// Loops of coverage_mask.cpp that sum the weights of a mask. coverage_mask_kernels.h must come
// first.
#ifndef TROFFER_MASK_WIDTH
#include "shadow/coverage_mask_kernels.h"
#endif

namespace troffer::TROFFER_MASK_NAMESPACE {

// Pairs of neighbours of which exactly one is open, each marked at one of its two samples. The
// marked sample alternates: left and right along a row, lower and upper along a column. This avoids
// a preference for the larger or smaller weight where weights have a gradient.
template <int rows>
struct Boundary {
  uint32_t in_row[rows], in_column[rows];
};

// counts: pairs inside of which exactly one is open, in rows and in columns; all pairs; samples
// inside; open samples.
template <int rows>
inline __attribute__((always_inline)) void count_pairs(const uint32_t* inside, const uint32_t* open,
                                                       int* counts, Boundary<rows>& boundary) {
  constexpr uint32_t lower_one = 0x55555555u;
  for (int i = 0; i < 5; ++i) counts[i] = 0;
  uint32_t below = 0;                  // pairs of the previous row with this one
  for (int j = 0; j < rows; j += 2) {  // two rows in 64 bits
    const uint64_t i0 = inside[j], i1 = inside[j + 1], o0 = open[j], o1 = open[j + 1];
    const uint64_t in = i0 | (i1 << 32), on = o0 | (o1 << 32);
    const uint64_t i2 = j + 2 < rows ? inside[j + 2] : 0, o2 = j + 2 < rows ? open[j + 2] : 0;
    const uint64_t in_above = i1 | (i2 << 32), on_above = o1 | (o2 << 32);
    const uint64_t row = in & (in >> 1) & 0x7fffffff7fffffffull, column = in & in_above;
    const uint64_t row_pairs = (on ^ (on >> 1)) & row, column_pairs = (on ^ on_above) & column;
    boundary.in_row[j] = uint32_t(row_pairs);
    boundary.in_row[j + 1] = uint32_t(row_pairs >> 32) << 1;
    const uint32_t first = uint32_t(column_pairs), second = uint32_t(column_pairs >> 32);
    boundary.in_column[j] = (first & lower_one) | (below & ~lower_one);
    boundary.in_column[j + 1] = (second & lower_one) | (first & ~lower_one);
    below = second;
    counts[0] += __builtin_popcountll(row_pairs);
    counts[1] += __builtin_popcountll(column_pairs);
    counts[2] += __builtin_popcountll(row) + __builtin_popcountll(column);
    counts[3] += __builtin_popcountll(in);
    counts[4] += __builtin_popcountll(on);
  }
}

template <int rows, int columns>
inline __attribute__((always_inline)) void weigh(const MaskWeights& w, const uint32_t* inside_rows,
                                                 const uint32_t* open_rows,
                                                 const Boundary<rows>& boundary, float* sums,
                                                 float* row_sums) {
  constexpr int blocks = rows / width;
  const Floats zero = {};
  // sums over rows, so that the order does not depend on the width
  float all_sum = 0, seen_sum = 0, square_sum = 0;
  for (int block = 0; block < blocks; ++block) {
    Bits inside, open, in_row, in_column;
    __builtin_memcpy(&inside, inside_rows + block * width, sizeof inside);
    __builtin_memcpy(&open, open_rows + block * width, sizeof open);
    __builtin_memcpy(&in_row, boundary.in_row + block * width, sizeof in_row);
    __builtin_memcpy(&in_column, boundary.in_column + block * width, sizeof in_column);
    Floats row;
    for (int i = 0; i < width; ++i) row[i] = float(block * width + i);
    const Floats cosine_0 = w.cosine + w.cosine_j * row;
    const Floats square_0 = w.square + row * (w.square_j + row * w.square_jj);
    const Floats slope = w.slope + w.slope_j * row;
    Floats all = zero, seen = zero, squares = zero;
#pragma GCC unroll 32
    for (int k = 0; k < columns; ++k) {
      const auto at = float(k);
      const Floats cosine = cosine_0 + w.cosine_k * at;
      const Floats square = square_0 + at * (slope + at * w.square_kk);
      const Floats weight = (cosine > zero ? cosine : zero) / (square * square);
      const Bits bit = Bits{} + (1u << k);
      all += (inside & bit) != 0 ? weight : zero;
      seen += (open & bit) != 0 ? weight : zero;
      const Floats own = weight * weight;
      squares += (in_row & bit) != 0 ? own : zero;
      squares += (in_column & bit) != 0 ? own : zero;
    }
    __builtin_memcpy(row_sums + block * width, &seen, sizeof seen);
    for (int i = 0; i < width; ++i) {
      all_sum += all[i];
      seen_sum += seen[i];
      square_sum += squares[i];
    }
  }
  sums[0] = all_sum;
  sums[1] = seen_sum;
  sums[2] = square_sum;
}

template <int rows, int columns>
inline __attribute__((always_inline)) void weigh_and_count(const MaskWeights& w,
                                                           const uint32_t* inside,
                                                           const uint32_t* open, float* sums,
                                                           float* row_sums, int* counts) {
  Boundary<rows> boundary;
  count_pairs<rows>(inside, open, counts, boundary);
  weigh<rows, columns>(w, inside, open, boundary, sums, row_sums);
}

// sums: weight of all samples inside, weight of open samples, and squared weights, one per pair at
// the boundary. row_sums: open weight by row. counts: as in count_pairs.
void weigh_rows(const MaskWeights& w, int rows, const uint32_t* inside, const uint32_t* open,
                float* sums, float* row_sums, int* counts) {
  if (rows <= 16)
    weigh_and_count<16, 16>(w, inside, open, sums, row_sums, counts);
  else
    weigh_and_count<32, 31>(w, inside, open, sums, row_sums, counts);
}

}  // namespace troffer::TROFFER_MASK_NAMESPACE
