// Rasterisation loops of coverage_mask.cpp, written for vectors of `width` numbers.
// coverage_mask.cpp includes this file, coverage_mask_proofs.h and coverage_mask_weights.h once per
// instruction set, with TROFFER_MASK_WIDTH and TROFFER_MASK_NAMESPACE defined and under the pragma
// that selects the set. Functions here must not call functions from elsewhere, which would be
// compiled without the set. Results have the same bits for every width.
#ifndef TROFFER_MASK_WIDTH
#include "shadow/coverage_mask.h"
#define TROFFER_MASK_WIDTH 4
#define TROFFER_MASK_NAMESPACE mask_alone
#endif

namespace troffer::TROFFER_MASK_NAMESPACE {

constexpr int width = TROFFER_MASK_WIDTH;
constexpr int lanes = FacetBatch<3>::lanes;
constexpr float far_away = 1e9f;  // beyond any canvas

using Floats = float __attribute__((vector_size(4 * TROFFER_MASK_WIDTH)));
using Ints = int32_t __attribute__((vector_size(4 * TROFFER_MASK_WIDTH)));
using Bits = uint32_t __attribute__((vector_size(4 * TROFFER_MASK_WIDTH)));
using Bytes = int8_t __attribute__((vector_size(TROFFER_MASK_WIDTH)));

// Crossings m j + q + 1 of a facet's edges with rows. Each edge is stored as a lower and as an
// upper bound of k; the one that does not apply is far away.
template <int edges>
struct Crossings {
  alignas(64) float lower_m[edges][lanes];
  alignas(64) float lower_q[edges][lanes];
  alignas(64) float upper_m[edges][lanes];
  alignas(64) float upper_q[edges][lanes];
  alignas(64) int32_t is_relevant[lanes];  // nonzero if the facet may hide something
  // First row and number of rows in which the facet may hide a sample.
  alignas(64) int32_t first_row[lanes];
  alignas(64) int32_t row_count[lanes];
};

inline __attribute__((always_inline)) Floats load(const float* from) {
  Floats f;
  __builtin_memcpy(&f, from, sizeof f);
  return f;
}

inline __attribute__((always_inline)) void store(const Floats& f, float* to) {
  __builtin_memcpy(to, &f, sizeof f);
}

// Supporting planes of `width` facets.
struct Planes {
  Floats nk, nj, nw, distance, skipped;
  // Returns the receiver's distance from the planes.
  inline __attribute__((always_inline)) Floats height(const MaskPoint& p) const {
    return distance - (nk * p.k + nj * p.j + nw * p.w);
  }
};

template <int edges>
inline __attribute__((always_inline)) Planes planes_of(const FacetBatch<edges>& f, int from) {
  return {load(f.normal_k + from), load(f.normal_j + from), load(f.normal_w + from),
          load(f.distance + from), load(f.skipped_side + from)};
}

// Vertex e of `width` facets.
struct Vertex {
  Floats k, j, w;
};

template <int edges>
inline __attribute__((always_inline)) Vertex vertex_of(const FacetBatch<edges>& f, int e,
                                                       int from) {
  return {load(f.k[e] + from), load(f.j[e] + from), load(f.w[e] + from)};
}

// Computes where the line of edge e crosses rows, for facets `from` to from + width. side: the side
// of the facets that the receiver is on. The result is nonzero where a part of the source lies
// inside the edge.
template <int edges>
inline __attribute__((always_inline)) Ints set_up_edge(const FacetBatch<edges>& f, int from, int e,
                                                       const MaskPoint& p, const Floats& side,
                                                       Crossings<edges>& c) {
  const Floats zero = {}, one = zero + 1.0f, least = zero + 1e-25f;
  // Inside where side * (a × b) · y >= 0. For a short, distant edge a × b is a small difference of
  // large products. (a + b) × (b - a) is twice that, and b - a comes from the facet's own
  // coordinates. Facets that share the edge get the same numbers, negated.
  const Vertex a = vertex_of(f, e, from), b = vertex_of(f, e + 1 == edges ? 0 : e + 1, from);
  const Floats dk = b.k - a.k, dj = b.j - a.j, dw = b.w - a.w;
  const Floats mk = (a.k - p.k) + (b.k - p.k), mj = (a.j - p.j) + (b.j - p.j),
               mw = (a.w - p.w) + (b.w - p.w);
  const Floats ek = side * (mj * dw - mw * dj);
  const Floats ej = side * (mw * dk - mk * dw);
  const Floats ew = side * (mk * dj - mj * dk);
  const Floats base = ew * p.h;
  Floats most = ek * p.corner_k[0] + ej * p.corner_j[0];
  for (int corner = 1; corner < 4; ++corner) {
    const Floats at = ek * p.corner_k[corner] + ej * p.corner_j[corner];
    most = most > at ? most : at;
  }
  const Ints is_flat = (ek < least) & (ek > -least);
  const Floats slope = is_flat ? least : ek;
  const Floats inverse = one / slope;
  const Floats m = -ej * inverse;
  const Floats q = (1.0f - p.first_k) - (ej * p.first_j + base) * inverse;
  const Ints is_lower = slope > zero;
  store(is_lower ? m : zero, c.lower_m[e] + from);
  store(is_lower ? q : zero - far_away, c.lower_q[e] + from);
  store(is_lower ? zero : m, c.upper_m[e] + from);
  store(is_lower ? zero + far_away : q, c.upper_q[e] + from);
  return most + base > zero;
}

// Rounds nonnegative numbers down or up.
inline __attribute__((always_inline)) Ints rounded_down(const Floats& x) {
  return __builtin_convertvector(x, Ints);
}
inline __attribute__((always_inline)) Ints rounded_up(const Floats& x) {
  const Ints down = rounded_down(x);
  return down - (__builtin_convertvector(down, Floats) < x);  // true is -1
}

// Finds the rows between the projected corners, widened by the possible rounding error. Takes all
// rows if a corner is close to the receiver or behind it.
template <int edges>
inline __attribute__((always_inline)) void set_up_rows(const FacetBatch<edges>& f, int from,
                                                       const MaskPoint& p, Crossings<edges>& c) {
  const Floats zero = {}, least_depth = zero + 1e-3f * p.h, last_row = zero + (p.rows - 1);
  Floats least = zero + far_away, most = zero - far_away;
  Ints is_before = Ints{} - 1;
  for (int e = 0; e < edges; ++e) {
    const Floats depth = load(f.w[e] + from) - p.w, inverse = 1.0f / depth;
    const Floats aside = load(f.j[e] + from) - p.j, scale = inverse * p.h;
    const Floats size = (aside > zero ? aside : -aside) + p.receiver_size;
    const Floats off = 0.02f + 2e-6f * scale * size * (1.0f + inverse * p.receiver_size);
    const Floats at = aside * scale - p.first_j;
    is_before &= depth > least_depth;
    least = at - off < least ? at - off : least;
    most = at + off > most ? at + off : most;
  }
  least = is_before & (least > zero) ? least : zero;
  most = is_before & (most < last_row) ? most : last_row;
  Ints is_relevant;
  __builtin_memcpy(&is_relevant, c.is_relevant + from, sizeof is_relevant);
  is_relevant &= (least <= last_row) & (most >= zero);
  const Ints first = rounded_up(is_relevant ? least : zero);
  const Ints count = (rounded_down(is_relevant ? most : zero) - first + 1) & is_relevant;
  __builtin_memcpy(c.first_row + from, &first, sizeof first);
  __builtin_memcpy(c.row_count + from, &count, sizeof count);
}

// Computes the crossings of facets `from` to from + width.
template <int edges>
inline __attribute__((always_inline)) void set_up(const FacetBatch<edges>& f, int from,
                                                  const MaskPoint& p, Crossings<edges>& c) {
  const Planes planes = planes_of(f, from);
  const Floats zero = {}, one = zero + 1.0f;
  const Floats height = planes.height(p);
  const Floats below = height < zero ? -one : zero;
  const Floats side = height > zero ? one : below;
  Ints is_relevant = (side != zero) & (side != planes.skipped);
  for (int e = 0; e < edges; ++e) is_relevant &= set_up_edge(f, from, e, p, side, c);
  __builtin_memcpy(c.is_relevant + from, &is_relevant, sizeof is_relevant);
}

// Clears the bits of facet i in some rows. at: row numbers.
template <int edges>
inline __attribute__((always_inline)) void rasterise(const Crossings<edges>& c, int i,
                                                     const Floats& at, float canvas_rows,
                                                     Bits& open) {
  const Floats zero = {}, limit = zero + canvas_rows;
  Floats lower = zero, upper = limit;
  for (int e = 0; e < edges; ++e) {
    const Floats l = c.lower_m[e][i] * at + c.lower_q[e][i];
    const Floats u = c.upper_m[e][i] * at + c.upper_q[e][i];
    lower = l > lower ? l : lower;
    upper = u < upper ? u : upper;
  }
  lower = lower < limit ? lower : limit;
  upper = upper > zero ? upper : zero;
  const Bits all = Bits{} + ~0u;
  const Bits first = __builtin_convertvector(__builtin_convertvector(lower, Ints), Bits);
  const Bits end = __builtin_convertvector(__builtin_convertvector(upper, Ints), Bits);
  open &= ~(all << first) | (all << end);
}

// A mask of lanes as bytes, up to eight lanes per word.
struct LaneWords {
  static constexpr int lanes = width < 8 ? width : 8;  // per word
  uint64_t word[(width + 7) / 8] = {};
  inline __attribute__((always_inline)) explicit LaneWords(const Ints& mask) {
    const Bytes bytes = __builtin_convertvector(mask, Bytes);
    __builtin_memcpy(word, &bytes, sizeof bytes);
  }
  inline __attribute__((always_inline)) bool is_any() const {
    uint64_t all = 0;
    for (const uint64_t w : word) all |= w;
    return all != 0;
  }
  // Calls f(i) for each lane i that is not 0.
  template <typename F>
  inline __attribute__((always_inline)) void for_each(const F& f) const {
    int from = 0;
    for (uint64_t w : word) {
      while (w != 0) {
        const int lane = __builtin_ctzll(w) >> 3;
        w &= ~(uint64_t{0xff} << (8 * lane));
        f(from + lane);
      }
      from += lanes;
    }
  }
};

// Facets that reach at most this many rows are rasterised side by side, each in its own rows. For
// larger facets, the rows of one facet are done side by side.
constexpr int few_rows = 4;

// Sets the bits that facets `from` to from + width hide, for those that reach few rows.
template <int edges>
inline __attribute__((always_inline)) void rasterise_small(const Crossings<edges>& c, int from,
                                                           float canvas_rows, uint32_t* hidden) {
  const Floats zero = {}, limit = zero + canvas_rows;
  Ints first, count;
  __builtin_memcpy(&first, c.first_row + from, sizeof first);
  __builtin_memcpy(&count, c.row_count + from, sizeof count);
  const Ints is_small = count <= few_rows;
  for (int r = 0; r < few_rows; ++r) {
    const Ints reaches = is_small & (count > r);
    if (!LaneWords(reaches).is_any()) return;
    const Floats at = __builtin_convertvector(first + r, Floats);
    Floats lower = zero, upper = limit;
    for (int e = 0; e < edges; ++e) {
      const Floats l = load(c.lower_m[e] + from) * at + load(c.lower_q[e] + from);
      const Floats u = load(c.upper_m[e] + from) * at + load(c.upper_q[e] + from);
      lower = l > lower ? l : lower;
      upper = u < upper ? u : upper;
    }
    const Ints begin = rounded_down(lower < limit ? lower : limit);
    const Ints end = rounded_down(upper > zero ? upper : zero);
    LaneWords(reaches & (begin < end)).for_each([&](int i) {
      hidden[first[i] + r] |= (~0u << begin[i]) & ~(~0u << end[i]);
    });
  }
}

// Open bits of a mask while batches of facets are rasterised.
template <int edges, int rows>
struct Canvas {
  static constexpr int blocks = rows / width;
  Bits open[blocks];
  Floats at[blocks];
  alignas(64) uint32_t hidden[rows] = {};  // by facets of few rows
  float canvas_rows;

  inline __attribute__((always_inline)) Canvas(const uint32_t* open_rows, float limit)
      : canvas_rows(limit) {
    __builtin_memcpy(open, open_rows, sizeof open);
    for (int block = 0; block < blocks; ++block)
      for (int i = 0; i < width; ++i) at[block][i] = float(block * width + i);
  }
  inline __attribute__((always_inline)) void hide(const Crossings<edges>& c, int i) {
    for (int block = 0; block < blocks; ++block)
      rasterise<edges>(c, i, at[block], canvas_rows, open[block]);
  }
  inline __attribute__((always_inline)) bool is_any_open() const {
    Bits any = open[0];
    for (int block = 1; block < blocks; ++block) any |= open[block];
    return LaneWords(any != 0).is_any();
  }
  inline __attribute__((always_inline)) void hide_small() {
    for (int block = 0; block < blocks; ++block) {
      Bits of_small;
      __builtin_memcpy(&of_small, hidden + block * width, sizeof of_small);
      open[block] &= ~of_small;
    }
  }
};

// Rasterises a batch in which many facets are expected to reach few rows. Returns true if they do.
template <int edges, int rows>
inline __attribute__((always_inline)) bool cover_small(const FacetBatch<edges>& batch,
                                                       const MaskPoint& p, Crossings<edges>& c,
                                                       Canvas<edges, rows>& canvas) {
  int large = 0;
  for (int from = 0; from < lanes; from += width) {
    set_up_rows(batch, from, p, c);
    rasterise_small(c, from, p.rows, canvas.hidden);
    Ints count;
    __builtin_memcpy(&count, c.row_count + from, sizeof count);
    LaneWords(count > few_rows).for_each([&](int i) {
      canvas.hide(c, from + i);
      ++large;
    });
  }
  return large < lanes / 2;
}

template <int edges, int rows>
inline __attribute__((always_inline)) bool cover_batches(const FacetBatch<edges>* batches, size_t n,
                                                         const MaskPoint& p, uint32_t* open_rows) {
  constexpr size_t look_every = 8;  // batches between checks for small facets
  Canvas<edges, rows> canvas(open_rows, p.rows);
  bool is_any_open = true, are_small = false;
  for (size_t b = 0; b < n && is_any_open; ++b) {
    Crossings<edges> c;
    for (int from = 0; from < lanes; from += width) set_up(batches[b], from, p, c);
    if (are_small || (b % look_every == 0 && n >= look_every)) {
      are_small = cover_small(batches[b], p, c, canvas);
    } else {
      for (int i = 0; i < lanes; ++i)
        if (c.is_relevant[i] != 0) canvas.hide(c, i);
    }
    if (b + 1 == n || b % look_every == look_every - 1) canvas.hide_small();
    is_any_open = canvas.is_any_open();
  }
  __builtin_memcpy(open_rows, canvas.open, sizeof canvas.open);
  return is_any_open;
}

// Clears the bits that facets hide in 16 or 32 rows. Returns false if none is left.
bool cover_rows(const MaskPoint& p, int rows, const FacetBatch<4>* quads, size_t quad_batches,
                const FacetBatch<3>* triangles, size_t triangle_batches, uint32_t* open) {
  if (rows <= 16)
    return cover_batches<4, 16>(quads, quad_batches, p, open) &&
           cover_batches<3, 16>(triangles, triangle_batches, p, open);
  return cover_batches<4, 32>(quads, quad_batches, p, open) &&
         cover_batches<3, 32>(triangles, triangle_batches, p, open);
}

}  // namespace troffer::TROFFER_MASK_NAMESPACE
