// Certificate loops of coverage_mask.cpp. coverage_mask_kernels.h must come first.
#ifndef TROFFER_MASK_WIDTH
#include "shadow/coverage_mask_kernels.h"
#endif

namespace troffer::TROFFER_MASK_NAMESPACE {

// Positions relative to the facets' planes: true if all receivers, or all of the source, lie
// strictly on one side.
struct Sides {
  Ints is_before, is_behind, is_source_before, is_source_behind;
};

inline __attribute__((always_inline)) Sides sides_of(const Planes& planes,
                                                     const MaskPoint* receivers, int count,
                                                     float slack) {
  const Floats zero = {};
  const Ints all = Ints{} - 1;
  Sides s{all, all, all, all};
  const Floats size = planes.distance > zero ? planes.distance : -planes.distance;
  for (int r = 0; r < count; ++r) {
    const MaskPoint& p = receivers[r];
    const Floats height = planes.height(p);
    const Floats error = 2e-6f * (size + p.receiver_size) + slack;
    s.is_before &= height > error;
    s.is_behind &= height < -error;
    const Floats error_source = error + 2e-6f * p.source_size;
    for (int corner = 0; corner < 4; ++corner) {
      const Floats at = height - (planes.nk * p.corner_k[corner] + planes.nj * p.corner_j[corner] +
                                  planes.nw * p.h);
      s.is_source_before &= at > error_source;
      s.is_source_behind &= at < -error_source;
    }
  }
  return s;
}

// Returns the sum of absolute coordinates.
inline __attribute__((always_inline)) Floats size_of(const Floats& k, const Floats& j,
                                                     const Floats& w) {
  const Floats zero = {};
  return (k > zero ? k : -k) + (j > zero ? j : -j) + (w > zero ? w : -w);
}

// Clears is_outside if a part of the source may lie inside the edge from a to b for some receiver.
// Clears is_inside if a part may lie outside.
inline __attribute__((always_inline)) void classify_edge(const Vertex& a, const Vertex& b,
                                                         const Floats& side,
                                                         const MaskPoint* receivers, int count,
                                                         float slack, Ints& is_outside,
                                                         Ints& is_inside) {
  for (int r = 0; r < count; ++r) {
    const MaskPoint& p = receivers[r];
    const Floats ak = a.k - p.k, aj = a.j - p.j, aw = a.w - p.w;
    const Floats bk = b.k - p.k, bj = b.j - p.j, bw = b.w - p.w;
    const Floats ek = side * (aj * bw - aw * bj);
    const Floats ej = side * (aw * bk - ak * bw);
    const Floats ew = side * (ak * bj - aj * bk);
    const Floats size_a = size_of(ak, aj, aw) + p.receiver_size;
    const Floats size_b = size_of(bk, bj, bw) + p.receiver_size;
    const Floats error = (2e-6f * size_a * size_b + 2 * slack * (size_a + size_b)) * p.source_size;
    const Floats base = ew * p.h;
    for (int corner = 0; corner < 4; ++corner) {
      const Floats at = ek * p.corner_k[corner] + ej * p.corner_j[corner] + base;
      is_outside &= at < -error;
      is_inside &= at > error;
    }
  }
}

// Flags facets `from` to from + width, as classify() defines.
template <int edges>
inline __attribute__((always_inline)) void classify_lanes(const FacetBatch<edges>& f, int from,
                                                          const MaskPoint* receivers, int count,
                                                          float slack, int32_t* flags) {
  const Planes planes = planes_of(f, from);
  const Sides s = sides_of(planes, receivers, count, slack);
  const Floats zero = {}, one = zero + 1.0f;
  const Floats side = s.is_before ? one : (s.is_behind ? -one : zero);
  Ints misses = (s.is_before & s.is_source_before) | (s.is_behind & s.is_source_behind);
  misses |= (side == planes.skipped) & (side != zero);
  Ints covers = s.is_before | s.is_behind;
  for (int e = 0; e < edges; ++e) {
    Ints is_outside = s.is_before | s.is_behind, is_inside = Ints{} - 1;
    classify_edge(vertex_of(f, e, from), vertex_of(f, e + 1 == edges ? 0 : e + 1, from), side,
                  receivers, count, slack, is_outside, is_inside);
    misses |= is_outside;
    covers &= is_inside;
  }
  const Ints result = (misses & 1) | (covers & ~misses & 2);
  __builtin_memcpy(flags + from, &result, sizeof result);
}

void classify_quads(const FacetBatch<4>* batches, size_t n, const MaskPoint* receivers, int count,
                    float slack, int32_t* flags) {
  for (size_t b = 0; b < n; ++b)
    for (int from = 0; from < lanes; from += width)
      classify_lanes(batches[b], from, receivers, count, slack, flags + b * size_t(lanes));
}
void classify_triangles(const FacetBatch<3>* batches, size_t n, const MaskPoint* receivers,
                        int count, float slack, int32_t* flags) {
  for (size_t b = 0; b < n; ++b)
    for (int from = 0; from < lanes; from += width)
      classify_lanes(batches[b], from, receivers, count, slack, flags + b * size_t(lanes));
}

}  // namespace troffer::TROFFER_MASK_NAMESPACE
