#include "shadow/coverage_mask.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/simd.h"
#include "base/units.h"

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define TROFFER_MASK_DISPATCH 1
#endif

#define TROFFER_MASK_WIDTH 4
#define TROFFER_MASK_NAMESPACE mask_plain
#include "shadow/coverage_mask_kernels.h"
#include "shadow/coverage_mask_proofs.h"
#include "shadow/coverage_mask_weights.h"
#undef TROFFER_MASK_WIDTH
#undef TROFFER_MASK_NAMESPACE
#ifdef TROFFER_MASK_DISPATCH
#pragma GCC push_options
#pragma GCC target("avx2,popcnt")
#define TROFFER_MASK_WIDTH 8
#define TROFFER_MASK_NAMESPACE mask_avx2
#include "shadow/coverage_mask_kernels.h"
#include "shadow/coverage_mask_proofs.h"
#include "shadow/coverage_mask_weights.h"
#undef TROFFER_MASK_WIDTH
#undef TROFFER_MASK_NAMESPACE
#pragma GCC pop_options
#pragma GCC push_options
#pragma GCC target("avx512f,popcnt")
#define TROFFER_MASK_WIDTH 16
#define TROFFER_MASK_NAMESPACE mask_avx512
#include "shadow/coverage_mask_kernels.h"
#include "shadow/coverage_mask_proofs.h"
#include "shadow/coverage_mask_weights.h"
#undef TROFFER_MASK_WIDTH
#undef TROFFER_MASK_NAMESPACE
#pragma GCC pop_options
#endif

namespace troffer {

namespace {

struct Kernels {
  decltype(&mask_plain::cover_rows) cover;
  decltype(&mask_plain::weigh_rows) weigh;
  decltype(&mask_plain::classify_quads) classify_quads;
  decltype(&mask_plain::classify_triangles) classify_triangles;
};
constexpr Kernels all_kernels[] = {
    {mask_plain::cover_rows, mask_plain::weigh_rows, mask_plain::classify_quads,
     mask_plain::classify_triangles},
#ifdef TROFFER_MASK_DISPATCH
    {mask_avx2::cover_rows, mask_avx2::weigh_rows, mask_avx2::classify_quads,
     mask_avx2::classify_triangles},
    {mask_avx512::cover_rows, mask_avx512::weigh_rows, mask_avx512::classify_quads,
     mask_avx512::classify_triangles},
#endif
};

int supported_kernels() {
#ifdef TROFFER_MASK_DISPATCH
  if (!__builtin_cpu_supports("popcnt")) return 1;
  if (__builtin_cpu_supports("avx512f")) return 3;
  if (__builtin_cpu_supports("avx2")) return 2;
#endif
  return 1;
}

const Kernels& kernels(int instruction_set) {
  static const int best = supported_kernels();
  return all_kernels[instruction_set < 0 ? best - 1 : std::min(instruction_set, best - 1)];
}

// Sets the bits inside the source's outline. k, j: its corners relative to sample (0,0).
TROFFER_MULTIVERSION
void fill_outline(const float* __restrict k, const float* __restrict j, int n, int canvas_rows,
                  uint32_t* __restrict rows) {
  const float limit = float(canvas_rows);
  float lower[most_mask_rows], upper[most_mask_rows];
  for (size_t r = 0; r < most_mask_rows; ++r) {
    lower[r] = 0;
    upper[r] = limit;
  }
  for (int e = 0; e < n; ++e) {
    const int g = e + 1 == n ? 0 : e + 1;
    // corners run counterclockwise: inside where cross(corner g - corner e, p - corner e) >= 0
    const float ek = j[e] - j[g], ej = k[g] - k[e];
    const float constant = -(ek * k[e] + ej * j[e]);
    const float slope = std::abs(ek) < 1e-25f ? 1e-25f : ek;
    const float m = -ej / slope, q = 1.0f - constant / slope;
    if (slope > 0)
      for (size_t r = 0; r < most_mask_rows; ++r) {
        const float at = m * float(int(r)) + q;
        lower[r] = lower[r] > at ? lower[r] : at;
      }
    else
      for (size_t r = 0; r < most_mask_rows; ++r) {
        const float at = m * float(int(r)) + q;
        upper[r] = upper[r] < at ? upper[r] : at;
      }
  }
  for (size_t r = 0; r < most_mask_rows; ++r) {
    const float l = lower[r] < limit ? lower[r] : limit;
    const float u = upper[r] > 0.0f ? upper[r] : 0.0f;
    rows[r] = (~0u << uint32_t(int(l))) & ~(~0u << uint32_t(int(u)));
  }
}

// The disk inscribed in the source's square. The canvas map only turns and scales, so it is a
// circle there too.
void fill_disk(const MaskLattice& lattice, const Vec2& shift, MaskRows& out) {
  const auto rows = float(lattice.rows);
  const float radius2 = 0.25f * float(lattice.samples());
  const float centre_k = 0.5f * float(lattice.a + lattice.b) - shift.x;
  const float centre_j = 0.5f * float(lattice.a + lattice.b) - shift.y;
  for (size_t r = 0; r < most_mask_rows; ++r) {
    const float half2 = radius2 - sqr(float(int(r)) - centre_j);
    out.row[r] = 0;
    if (!(half2 > 0)) continue;
    const float half = std::sqrt(half2);
    const float lower = std::clamp(centre_k - half + 1, 0.0f, rows);
    const float upper = std::clamp(centre_k + half + 1, 0.0f, rows);
    out.row[r] = (~0u << uint32_t(int(lower))) & ~(~0u << uint32_t(int(upper)));
  }
}

}  // namespace

MaskFrame::MaskFrame(const Parallelogram& source, const MaskLattice& lattice, bool is_mirrored,
                     const Vec3d& centre, std::span<const Vec2> outline, bool is_disk)
    : lattice_(lattice), is_disk_(is_disk) {
  map_.centre = centre;
  Vec3d origin = source.origin, u = source.u, v = source.v;
  if (is_mirrored) {  // start at the next corner and reverse u, which mirrors the canvas
    origin = origin + u;
    u = -u;
  }
  const double a = lattice.a, b = lattice.b, n = a * a + b * b;
  // gradients of u and v within the plane, and of the third coordinate, in canvas units
  const Vec3d normal = cross(u, v);
  const double area2 = length_squared(normal);
  const Vec3d gradient_u = cross(v, normal) / area2, gradient_v = cross(normal, u) / area2;
  map_.k = gradient_u * a + gradient_v * b;
  map_.j = gradient_v * a - gradient_u * b;
  const double scale = std::sqrt(n / std::sqrt(area2));
  map_.w = source.normal * -scale;
  is_mirroring_ = dot(cross(map_.k, map_.j), map_.w) < 0;
  samples_.step_k = (u * a + v * b) / n;
  samples_.step_j = (v * a - u * b) / n;
  samples_.first = origin - samples_.step_j * b;  // (u,v) = 0 is canvas (0, b)
  origin_ = to_canvas(samples_.first);
  height_ = float(dot(map_.w, source.origin - centre));
  const auto place = [&](double cu, double cv) {
    if (is_mirrored) cu = 1 - cu;
    outline_.corners[outline_.count++] = {float(a * cu + b * cv), float(b - b * cu + a * cv)};
  };
  if (outline.empty()) {
    place(0, 0);
    place(1, 0);
    place(1, 1);
    place(0, 1);
  } else {
    for (const Vec2& c : outline.first(std::min(outline.size(), most_source_corners)))
      place(double(c.x), double(c.y));
  }
  double twice = 0;
  for (int i = 0; i < outline_.count; ++i) {
    const Corner &p = outline_.corners[i], &q = outline_.corners[(i + 1) % outline_.count];
    twice += double(p.k) * double(q.j) - double(p.j) * double(q.k);
  }
  if (twice < 0) std::reverse(outline_.corners, outline_.corners + outline_.count);
}

Vec3 MaskFrame::to_canvas(const Vec3d& world) const {
  const Vec3d d = world - map_.centre;
  return Vec3(Vec3d{dot(map_.k, d), dot(map_.j, d), dot(map_.w, d)});
}

double MaskFrame::stretch() const {
  return length(map_.k) + length(map_.j) + length(map_.w);
}

MaskPoint mask_point(const MaskFrame& frame, const Vec3& x, const Vec2& shift) {
  const MaskLattice& lattice = frame.lattice();
  const Vec3 origin = frame.canvas_origin();
  MaskPoint p;
  p.k = x.x;
  p.j = x.y;
  p.w = x.z;
  p.first_k = origin.x + shift.x - x.x;
  p.first_j = origin.y + shift.y - x.y;
  p.h = frame.height() - x.z;
  p.rows = float(lattice.rows);
  p.receiver_size = std::abs(x.x) + std::abs(x.y) + std::abs(x.z);
  p.source_size = 0;
  const auto a = float(lattice.a), b = float(lattice.b);
  const float corner_k[4] = {0, a, a + b, b}, corner_j[4] = {b, 0, a, a + b};
  for (int i = 0; i < 4; ++i) {
    p.corner_k[i] = origin.x - x.x + corner_k[i];
    p.corner_j[i] = origin.y - x.y + corner_j[i];
    p.source_size =
        std::max(p.source_size, std::abs(p.corner_k[i]) + std::abs(p.corner_j[i]) + std::abs(p.h));
  }
  return p;
}

void classify(const FacetList& facets, std::span<const MaskPoint> receivers, float slack,
              FacetFlags& flags, int instruction_set) {
  flags.quads.resize(facets.quads().size() * size_t(FacetBatch<4>::lanes));
  flags.triangles.resize(facets.triangles().size() * size_t(FacetBatch<3>::lanes));
  const Kernels& k = kernels(instruction_set);
  k.classify_quads(facets.quads().data(), facets.quads().size(), receivers.data(),
                   int(receivers.size()), slack, flags.quads.data());
  k.classify_triangles(facets.triangles().data(), facets.triangles().size(), receivers.data(),
                       int(receivers.size()), slack, flags.triangles.data());
}

void cover(const MaskFrame& frame, const FacetList& facets, const Vec3& x, const Vec2& shift,
           CoverageMask& out, int instruction_set) {
  const MaskLattice& lattice = frame.lattice();
  if (frame.is_disk()) {
    fill_disk(lattice, shift, out.inside);
  } else {
    float k[most_source_corners], j[most_source_corners];
    for (int i = 0; i < frame.corner_count(); ++i) {
      k[i] = frame.corners()[i].k - shift.x;
      j[i] = frame.corners()[i].j - shift.y;
    }
    fill_outline(k, j, frame.corner_count(), lattice.rows, out.inside.row);
  }
  out.open = out.inside;
  out.is_any_open = true;
  if (facets.quads().empty() && facets.triangles().empty()) return;

  const MaskPoint p = mask_point(frame, x, shift);
  out.is_any_open = kernels(instruction_set)
                        .cover(p, lattice.rows, facets.quads().data(), facets.quads().size(),
                               facets.triangles().data(), facets.triangles().size(), out.open.row);
}

void clip_to_horizon(const MaskFrame& frame, const Vec3d& x, const Vec3& n, const Vec2& shift,
                     CoverageMask& mask) {
  const Vec3d normal(n), ek = frame.step_k(), ej = frame.step_j();
  const double rows = frame.lattice().rows, slope = dot(normal, ek), step = dot(normal, ej);
  double height =
      dot(normal, frame.first_sample() - x + ek * double(shift.x) + ej * double(shift.y));
  for (uint32_t r = 0; r < uint32_t(frame.lattice().rows); ++r, height += step) {
    uint32_t kept = height >= 0 ? ~0u : 0u;
    if (slope != 0) {
      const auto crossing = uint32_t(std::clamp(std::floor(-height / slope) + 1, 0.0, rows));
      kept = slope > 0 ? ~0u << crossing : ~(~0u << crossing);
    }
    mask.inside.row[r] &= kept;
    mask.open.row[r] &= kept;
  }
}

MaskWeights mask_weights(const MaskFrame& frame, const Vec3d& x, const Vec3& n, const Vec2& shift) {
  const Vec3d ek = frame.step_k(), ej = frame.step_j(), normal(n);
  const Vec3d d = frame.first_sample() - x + ek * double(shift.x) + ej * double(shift.y);
  const double scale = 1 / length_squared(d);  // keeps floats in range
  const double root = std::sqrt(scale);
  MaskWeights w;
  w.cosine = float(dot(normal, d) * root);
  w.cosine_j = float(dot(normal, ej) * root);
  w.cosine_k = float(dot(normal, ek) * root);
  w.square = 1;
  w.square_j = float(2 * dot(d, ej) * scale);
  w.square_jj = float(dot(ej, ej) * scale);
  w.slope = float(2 * dot(d, ek) * scale);
  w.slope_j = float(2 * dot(ej, ek) * scale);
  w.square_kk = float(dot(ek, ek) * scale);
  return w;
}

MaskWeight weigh(const MaskFrame& frame, const CoverageMask& mask, const MaskWeights& weights,
                 float* open_by_row, int instruction_set) {
  float sums[3], rows[most_mask_rows];
  int counts[5];
  kernels(instruction_set)
      .weigh(weights, frame.lattice().rows, mask.inside.row, mask.open.row, sums,
             open_by_row != nullptr ? open_by_row : rows, counts);
  return {sums[0], sums[1], sums[2], counts[0], counts[1], counts[2], counts[3], counts[4]};
}

}  // namespace troffer
