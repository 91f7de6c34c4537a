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
#ifdef TROFFER_MASK_DISPATCH
#pragma GCC push_options
#pragma GCC target("avx2,popcnt")
#define TROFFER_MASK_WIDTH 8
#define TROFFER_MASK_NAMESPACE mask_avx2
#include "shadow/coverage_mask_kernels.h"
#pragma GCC pop_options
#pragma GCC push_options
#pragma GCC target("avx512f,popcnt")
#define TROFFER_MASK_WIDTH 16
#define TROFFER_MASK_NAMESPACE mask_avx512
#include "shadow/coverage_mask_kernels.h"
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

// Intervals of rows inside the source's outline. corners: relative to sample (0,0).
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
    // counterclockwise: inside where cross(corner g - corner e, p - corner e) >= 0
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

// The square's inscribed disk: turned and scaled only, it is a circle on the canvas.
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
    : lattice_(lattice), centre_(centre), is_disk_(is_disk) {
  Vec3d origin = source.origin, u = source.u, v = source.v;
  if (is_mirrored) {  // from the next corner the other way round: the canvas is mirrored
    origin = origin + u;
    u = -u;
  }
  const double a = lattice.a, b = lattice.b, n = a * a + b * b;
  // gradients of u and v within the plane, and of the third coordinate, in canvas steps
  const Vec3d normal = cross(u, v);
  const double area2 = length_squared(normal);
  const Vec3d gradient_u = cross(v, normal) / area2, gradient_v = cross(normal, u) / area2;
  row_k_ = gradient_u * a + gradient_v * b;
  row_j_ = gradient_v * a - gradient_u * b;
  const double scale = std::sqrt(n / std::sqrt(area2));
  row_w_ = source.normal * -scale;
  is_mirroring_ = dot(cross(row_k_, row_j_), row_w_) < 0;
  step_k_ = (u * a + v * b) / n;
  step_j_ = (v * a - u * b) / n;
  first_ = origin - step_j_ * b;  // (u,v) = 0 is canvas (0, b)
  origin_ = to_canvas(first_);
  height_ = float(dot(row_w_, source.origin - centre));
  const auto place = [&](double cu, double cv) {
    if (is_mirrored) cu = 1 - cu;
    corners_[corner_count_++] = {float(a * cu + b * cv), float(b - b * cu + a * cv)};
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
  for (int i = 0; i < corner_count_; ++i) {
    const Corner &p = corners_[i], &q = corners_[(i + 1) % corner_count_];
    twice += double(p.k) * double(q.j) - double(p.j) * double(q.k);
  }
  if (twice < 0) std::reverse(corners_, corners_ + corner_count_);
}

Vec3 MaskFrame::to_canvas(const Vec3d& world) const {
  const Vec3d d = world - centre_;
  return Vec3(Vec3d{dot(row_k_, d), dot(row_j_, d), dot(row_w_, d)});
}

double MaskFrame::stretch() const {
  return length(row_k_) + length(row_j_) + length(row_w_);
}

void FacetList::clear() {
  triangles_.clear();
  quads_.clear();
  triangle_count_ = quad_count_ = 0;
}

namespace {

template <int edges>
void append(std::vector<FacetBatch<edges>>& batches, size_t& count, const Vec3* v,
            const Vec3d& normal, double distance, float skipped_side) {
  constexpr int lanes = FacetBatch<edges>::lanes;
  const size_t lane = count % size_t(lanes);
  if (lane == 0) batches.emplace_back();
  FacetBatch<edges>& f = batches.back();
  for (size_t e = 0; e < size_t(edges); ++e) {
    f.k[e][lane] = v[e].x;
    f.j[e][lane] = v[e].y;
    f.w[e][lane] = v[e].z;
  }
  f.normal_k[lane] = float(normal.x);
  f.normal_j[lane] = float(normal.y);
  f.normal_w[lane] = float(normal.z);
  f.distance[lane] = float(distance);
  f.skipped_side[lane] = skipped_side;
  ++count;
}

// Lanes that hold no facet are never relevant: the side is 0.
template <int edges>
void pad(std::vector<FacetBatch<edges>>& batches, size_t count) {
  constexpr int lanes = FacetBatch<edges>::lanes;
  for (size_t lane = count % size_t(lanes); lane != 0 && lane < size_t(lanes); ++lane) {
    FacetBatch<edges>& f = batches.back();
    for (size_t e = 0; e < size_t(edges); ++e) f.k[e][lane] = f.j[e][lane] = f.w[e][lane] = 0;
    f.normal_k[lane] = f.normal_j[lane] = f.normal_w[lane] = f.distance[lane] = 0;
    f.skipped_side[lane] = 0;
  }
}

}  // namespace

void FacetList::add_polygon(const Vec3* v, int n, float skipped_side) {
  Vec3d normal;
  for (int i = 1; i + 1 < n; ++i)
    normal += cross(Vec3d(v[i]) - Vec3d(v[0]), Vec3d(v[i + 1]) - Vec3d(v[0]));
  const double size = length(normal);
  if (!(size > 0) || !std::isfinite(size)) return;
  normal = normal / size;
  const double distance = dot(normal, Vec3d(v[0]));
  if (n == 3)
    append(triangles_, triangle_count_, v, normal, distance, skipped_side);
  else
    append(quads_, quad_count_, v, normal, distance, skipped_side);
}

void FacetList::add(const MaskFrame& frame, const Quad& quad, bool is_front_only) {
  Vec3 in[4], out[8];
  int n = 0;
  const auto is_same = [](const Vec3& a, const Vec3& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  };
  for (const Vec3& v : quad) {  // an edge without length would bound the facet anywhere
    in[n] = frame.to_canvas(Vec3d(v));
    if (n == 0 || (!is_same(in[n], in[n - 1]) && !is_same(in[n], in[0]))) ++n;
  }
  // clipped at the source's plane: what lies behind it hides nothing
  const float height = frame.height();
  int kept = 0;
  for (int i = 0; i < n; ++i) {
    const Vec3 &p = in[i], &q = in[(i + 1) % n];
    const bool is_p_in = p.z < height, is_q_in = q.z < height;
    if (is_p_in) out[kept++] = p;
    if (is_p_in == is_q_in) continue;
    // from the inner end to the outer one: neighbours cut a shared edge at the same point
    const Vec3 &from = is_p_in ? p : q, &to = is_p_in ? q : p;
    Vec3 cut = from + (to - from) * ((height - from.z) / (to.z - from.z));
    cut.z = height;
    out[kept++] = cut;
  }
  if (kept < 3) return;
  const float back = frame.is_mirroring() ? -1 : 1;
  const float side = is_front_only ? back : 0;
  if (kept == 5) {
    add_polygon(out, 4, side);
    const Vec3 rest[3] = {out[0], out[3], out[4]};
    add_polygon(rest, 3, side);
  } else {
    add_polygon(out, kept, side);
  }
}

namespace {

// World coordinates (relative to the frame's centre below) of 16 facets, vertex by vertex.
template <int edges>
struct WorldBatch {
  alignas(64) float x[edges][16];
  alignas(64) float y[edges][16];
  alignas(64) float z[edges][16];
};

// Into canvas coordinates, by the rows and the centre of the frame; highest: largest w of a facet.
TROFFER_MULTIVERSION
void place_vertices(const float* __restrict x, const float* __restrict y, const float* __restrict z,
                    int n, const double* __restrict rows, float* __restrict k, float* __restrict j,
                    float* __restrict w) {
  for (int i = 0; i < n; ++i) {
    const double dx = double(x[i]) - rows[9], dy = double(y[i]) - rows[10],
                 dz = double(z[i]) - rows[11];
    k[i] = float(rows[0] * dx + rows[1] * dy + rows[2] * dz);
    j[i] = float(rows[3] * dx + rows[4] * dy + rows[5] * dz);
    w[i] = float(rows[6] * dx + rows[7] * dy + rows[8] * dz);
  }
}

// Supporting planes of 16 facets of 3 or 4 vertices (`diagonal`: index of the last vertex).
TROFFER_MULTIVERSION
void support(const float* __restrict k, const float* __restrict j, const float* __restrict w,
             int last, float* __restrict nk, float* __restrict nj, float* __restrict nw,
             float* __restrict distance, float* __restrict highest) {
  for (int i = 0; i < 16; ++i) {
    // vertices 0, 2, 1, last: the cross product of the diagonals, or of two sides of a triangle
    const int a = i, b = i + 16, c = i + 32, d = i + 16 * last;
    const int from = last == 2 ? a : b;
    const double pk = double(k[c]) - double(k[a]), pj = double(j[c]) - double(j[a]),
                 pw = double(w[c]) - double(w[a]);
    const double qk = double(k[d]) - double(k[b]), qj = double(j[d]) - double(j[b]),
                 qw = double(w[d]) - double(w[b]);
    const double rk = pj * qw - pw * qj, rj = pw * qk - pk * qw, rw = pk * qj - pj * qk;
    const double size = std::sqrt(rk * rk + rj * rj + rw * rw);
    const double inverse = size > 0 ? 1 / size : 0.0;
    nk[i] = float(rk * inverse);
    nj[i] = float(rj * inverse);
    nw[i] = float(rw * inverse);
    distance[i] =
        float((rk * double(k[from]) + rj * double(j[from]) + rw * double(w[from])) * inverse);
    float most = w[a] > w[b] ? w[a] : w[b];
    most = most > w[c] ? most : w[c];
    highest[i] = most > w[d] ? most : w[d];
  }
}

}  // namespace

template <int edges>
void FacetList::add_batch(const MaskFrame& frame, const FacetToAdd* const* facets, size_t n,
                          std::vector<FacetBatch<edges>>& batches, size_t& count) {
  constexpr auto lanes = size_t(FacetBatch<edges>::lanes);
  WorldBatch<edges> world;
  for (size_t i = 0; i < lanes; ++i) {
    const Quad& q = facets[std::min(i, n - 1)]->quad;
    for (size_t e = 0; e < size_t(edges); ++e) {
      world.x[e][i] = q[e].x;
      world.y[e][i] = q[e].y;
      world.z[e][i] = q[e].z;
    }
  }
  double rows[12];
  for (int r = 0; r < 3; ++r)
    for (size_t a = 0; a < 3; ++a) rows[size_t(3 * r) + a] = frame.row(r)[a];
  for (size_t a = 0; a < 3; ++a) rows[9 + a] = frame.centre()[a];
  // whole batches only: what is there is filled up with lanes that hold nothing
  finish();
  count = batches.size() * lanes;
  FacetBatch<edges>& f = batches.emplace_back();
  place_vertices(world.x[0], world.y[0], world.z[0], edges * int(lanes), rows, f.k[0], f.j[0],
                 f.w[0]);
  float highest[lanes];
  support(f.k[0], f.j[0], f.w[0], edges - 1, f.normal_k, f.normal_j, f.normal_w, f.distance,
          highest);
  const float back = frame.is_mirroring() ? -1 : 1;
  bool is_crossing[lanes] = {};
  for (size_t i = 0; i < lanes; ++i) {
    is_crossing[i] = i < n && !(highest[i] < frame.height());
    const bool is_kept = i < n && !is_crossing[i] && std::isfinite(f.distance[i]);
    f.skipped_side[i] = i < n && facets[i]->is_front_only ? back : 0;
    if (!is_kept) f.normal_k[i] = f.normal_j[i] = f.normal_w[i] = f.distance[i] = 0;
  }
  count += lanes;
  for (size_t i = 0; i < n; ++i)
    if (is_crossing[i]) add(frame, facets[i]->quad, facets[i]->is_front_only);
}

void FacetList::add_many(const MaskFrame& frame, std::span<const FacetToAdd> facets) {
  constexpr size_t lanes = 16;
  const FacetToAdd *triangles[lanes], *quads[lanes];
  size_t triangle_count = 0, quad_count = 0;
  const auto flush_triangles = [&] {
    if (triangle_count > 0)
      add_batch<3>(frame, triangles, triangle_count, triangles_, triangle_count_);
    triangle_count = 0;
  };
  const auto flush_quads = [&] {
    if (quad_count > 0) add_batch<4>(frame, quads, quad_count, quads_, quad_count_);
    quad_count = 0;
  };
  const auto is_same = [](const Vec3& a, const Vec3& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  };
  for (const FacetToAdd& f : facets) {
    const Quad& q = f.quad;
    if (is_same(q[0], q[1]) || is_same(q[1], q[2]) || is_same(q[3], q[0])) {
      add(frame, q, f.is_front_only);
      continue;
    }
    (is_triangle(f.quad) ? triangles[triangle_count++] : quads[quad_count++]) = &f;
    if (triangle_count == lanes) flush_triangles();
    if (quad_count == lanes) flush_quads();
  }
  flush_triangles();
  flush_quads();
}

void FacetList::finish() {
  pad(triangles_, triangle_count_);
  pad(quads_, quad_count_);
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

namespace {

template <int edges>
void copy_unsettled(const std::vector<FacetBatch<edges>>& from, size_t from_count,
                    const std::vector<int32_t>& flags, std::vector<FacetBatch<edges>>& to,
                    size_t& count) {
  constexpr size_t lanes = FacetBatch<edges>::lanes;
  for (size_t i = 0; i < from_count; ++i) {
    const FacetBatch<edges>& f = from[i / lanes];
    const size_t source = i % lanes, lane = count % lanes;
    const bool is_facet =
        f.normal_k[source] != 0 || f.normal_j[source] != 0 || f.normal_w[source] != 0;
    if (flags[i] != 0 || !is_facet) continue;
    if (lane == 0) to.emplace_back();
    FacetBatch<edges>& t = to.back();
    for (size_t e = 0; e < size_t(edges); ++e) {
      t.k[e][lane] = f.k[e][source];
      t.j[e][lane] = f.j[e][source];
      t.w[e][lane] = f.w[e][source];
    }
    t.normal_k[lane] = f.normal_k[source];
    t.normal_j[lane] = f.normal_j[source];
    t.normal_w[lane] = f.normal_w[source];
    t.distance[lane] = f.distance[source];
    t.skipped_side[lane] = f.skipped_side[source];
    ++count;
  }
}

}  // namespace

void FacetList::keep_unsettled(const FacetList& from, const FacetFlags& flags) {
  clear();
  copy_unsettled(from.triangles_, from.triangle_count_, flags.triangles, triangles_,
                 triangle_count_);
  copy_unsettled(from.quads_, from.quad_count_, flags.quads, quads_, quad_count_);
  finish();
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
  if (facets.size() == 0) return;

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

float weight_of(const MaskWeights& w, int k, int j) {
  const auto row = float(j), at = float(k);
  const float cosine = w.cosine + w.cosine_j * row + w.cosine_k * at;
  const float square = w.square + row * (w.square_j + row * w.square_jj) +
                       at * (w.slope + w.slope_j * row + at * w.square_kk);
  return (cosine > 0 ? cosine : 0) / (square * square);
}

MaskWeight weigh(const MaskFrame& frame, const CoverageMask& mask, const MaskWeights& weights,
                 float* open_by_row, int instruction_set) {
  float sums[2], rows[most_mask_rows];
  const int pairs = kernels(instruction_set)
                        .weigh(weights, frame.lattice().rows, mask.inside.row, mask.open.row, sums,
                               open_by_row != nullptr ? open_by_row : rows);
  return {sums[0], sums[1], pairs};
}

}  // namespace troffer
