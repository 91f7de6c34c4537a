// Fills a FacetList: facets in world space become batches in canvas coordinates.
#include <algorithm>
#include <cmath>

#include "base/simd.h"
#include "shadow/coverage_mask.h"

namespace troffer {

void FacetList::clear() {
  triangles_.clear();
  quads_.clear();
  round_.clear();
  triangle_count_ = quad_count_ = 0;
  edges_along_ = EdgesAlong::neither;
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

// Empties the unused lanes of the last batch. Their height is 0, so set_up() treats them as
// irrelevant.
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
  for (const Vec3& v : quad) {  // an edge of zero length would give an arbitrary bound
    in[n] = frame.to_canvas(Vec3d(v));
    if (n == 0 || (!is_same(in[n], in[n - 1]) && !is_same(in[n], in[0]))) ++n;
  }
  // clip at the source's plane: parts behind it hide nothing
  const float height = frame.height();
  int kept = 0;
  for (int i = 0; i < n; ++i) {
    const Vec3 &p = in[i], &q = in[(i + 1) % n];
    const bool is_p_in = p.z < height, is_q_in = q.z < height;
    if (is_p_in) out[kept++] = p;
    if (is_p_in == is_q_in) continue;
    // interpolate from the inner end to the outer one, so neighbours cut a shared edge at the same
    // point
    const Vec3 &from = is_p_in ? p : q, &to = is_p_in ? q : p;
    Vec3 cut = from + (to - from) * ((height - from.z) / (to.z - from.z));
    cut.z = height;
    out[kept++] = cut;
  }
  if (kept < 3) return;
  const float back = frame.is_mirroring() ? -1 : 1;
  const float side = is_front_only ? back : 0;
  // Rounding may let a sliver cross the plane more than twice, which leaves more than five corners.
  for (int i = 1; i + 1 < kept; i += 2) {
    const Vec3 part[4] = {out[0], out[i], out[i + 1], out[std::min(i + 2, kept - 1)]};
    add_polygon(part, i + 2 < kept ? 4 : 3, side);
  }
}

namespace {

// World coordinates of 16 facets, vertex by vertex.
template <int edges>
struct WorldBatch {
  alignas(64) float x[edges][16];
  alignas(64) float y[edges][16];
  alignas(64) float z[edges][16];
};

// Maps vertices to canvas coordinates. rows: three rows of the map, then its centre.
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

// Computes the supporting planes of 16 facets of 3 or 4 vertices, and the largest w of each. last:
// index of the last vertex.
TROFFER_MULTIVERSION
void support(const float* __restrict k, const float* __restrict j, const float* __restrict w,
             int last, float* __restrict nk, float* __restrict nj, float* __restrict nw,
             float* __restrict distance, float* __restrict highest) {
  for (int i = 0; i < 16; ++i) {
    // cross product of the diagonals, or of two sides of a triangle, by vertices 0, 2, 1 and last
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
  // only whole batches are added: pad the current one
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
  constexpr size_t lanes = FacetBatch<3>::lanes;
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

// Summed lengths of edges: of all, and of those parallel to either side of the source.
struct alignas(64) EdgeLengths {
  static constexpr int lanes = FacetBatch<3>::lanes;
  float all[lanes] = {}, along_u[lanes] = {}, along_v[lanes] = {};
};

// Adds the edges of a batch. (a, -b) and (b, a), of length 1, are the directions of the source's
// sides on the canvas.
TROFFER_MULTIVERSION
void add_edge_lengths(const float* __restrict k, const float* __restrict j,
                      const float* __restrict w, int edges, float a, float b,
                      EdgeLengths& __restrict sum) {
  constexpr int lanes = EdgeLengths::lanes;
  constexpr float tolerance = 1e-3f;  // tangent of the angle, below one sample per side
  for (int e = 0; e < edges; ++e) {
    const int from = e * lanes, to = e + 1 == edges ? 0 : from + lanes;
    for (int i = 0; i < lanes; ++i) {
      const float dk = k[to + i] - k[from + i], dj = j[to + i] - j[from + i],
                  dw = w[to + i] - w[from + i];
      const float size = std::sqrt(dk * dk + dj * dj + dw * dw);
      const float in_u = a * dk - b * dj, in_v = b * dk + a * dj;
      const float most = tolerance * size - std::abs(dw);
      sum.all[i] += size;
      sum.along_u[i] += std::abs(in_v) < most ? size : 0.0f;
      sum.along_v[i] += std::abs(in_u) < most ? size : 0.0f;
    }
  }
}

}  // namespace

void FacetList::find_edges_along(const MaskLattice& lattice) {
  constexpr float most = 0.8f;
  edges_along_ = EdgesAlong::neither;
  if (round_.size() > 0) return;
  const float scale = 1 / std::sqrt(float(lattice.samples()));
  const float a = float(lattice.a) * scale, b = float(lattice.b) * scale;
  EdgeLengths sum;
  for (const FacetBatch<4>& f : quads_) add_edge_lengths(f.k[0], f.j[0], f.w[0], 4, a, b, sum);
  for (const FacetBatch<3>& f : triangles_) add_edge_lengths(f.k[0], f.j[0], f.w[0], 3, a, b, sum);
  float all = 0, along_u = 0, along_v = 0;
  for (int i = 0; i < EdgeLengths::lanes; ++i) {
    all += sum.all[i];
    along_u += sum.along_u[i];
    along_v += sum.along_v[i];
  }
  if (along_u > most * all) edges_along_ = EdgesAlong::u;
  if (along_v > most * all) edges_along_ = EdgesAlong::v;
}

void FacetList::keep_unsettled(const FacetList& from, const FacetFlags& flags) {
  clear();
  copy_unsettled(from.triangles_, from.triangle_count_, flags.triangles, triangles_,
                 triangle_count_);
  copy_unsettled(from.quads_, from.quad_count_, flags.quads, quads_, quad_count_);
  finish();
}

}  // namespace troffer
