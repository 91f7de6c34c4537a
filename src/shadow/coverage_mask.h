// Coverage masks: which of some hundred points of a flat source a receiver sees past a list of flat
// convex facets, without a ray.
//
// Sample points form a turned square lattice over the source's parallelogram (u,v) in [0,1)²: with
// coprime a and b, the points whose canvas coordinates (k,j) = (a u + b v, b - b u + a v) are
// integers plus a common shift. As the lattice contains Z², exactly a² + b² points lie in the
// square whatever the shift, and with a uniform shift every one of them is uniform over the square:
// an estimate from them is unbiased. Along either side of the source all points project to
// different, equally spaced places, so that edges parallel to the sides err by 1 / (a² + b²) only.
//
// The map from world space to the canvas, with a third coordinate w along the source's normal, is
// affine. From a receiver, the plane through an edge of a facet cuts the canvas in a line that is
// linear in (k,j) [1], so that a facet covers one interval of every row of bits: two crossings per
// row instead of a test per point. Intervals are half open and an edge's crossings are the same
// numbers for both facets that share it: no cracks, no overlaps.
// References: [1] Olano & Greer, "Triangle Scan Conversion using 2D Homogeneous Coordinates",
//   Graphics Hardware 1997. [2] Schwarz & Stamminger, "Bitmask Soft Shadows", EG 2007 (the idea of
//   bit masks over a source).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/quad.h"
#include "base/vec.h"
#include "light/source_surface.h"
#include "shadow/round_list.h"

namespace troffer {

// a + b <= rows: the canvas has `rows` rows of `rows` bits; rows <= 31.
struct MaskLattice {
  int a, b, rows;
  int samples() const { return a * a + b * b; }
};
constexpr MaskLattice coarse_lattice{13, 3, 16};  // 178 points
constexpr MaskLattice fine_lattice{25, 6, 31};    // 661 points

constexpr size_t most_mask_rows = 32;
constexpr size_t most_source_corners = 16;

// Rows of bits; bit k of row j is the sample (k,j).
struct alignas(64) MaskRows {
  uint32_t row[most_mask_rows] = {};
};

// Facets in canvas coordinates, 16 side by side.
template <int edges>
struct alignas(64) FacetBatch {
  static constexpr int lanes = 16;
  float k[edges][lanes], j[edges][lanes], w[edges][lanes];
  // Supporting plane: normal · p = distance, in canvas coordinates.
  float normal_k[lanes], normal_j[lanes], normal_w[lanes], distance[lanes];
  // Skip the facet from receivers for which sign(distance - normal · x) is this; 0: never.
  float skipped_side[lanes];
};

// Canvas coordinates of a source relative to `centre`, a point near the receivers.
class MaskFrame {
 public:
  // `outline`: the part of the parallelogram that shines, corners in (u,v), either way round, at
  // most 16; empty: all of it. is_disk: the ellipse that touches its sides. is_mirrored turns the
  // lattice the other way.
  MaskFrame(const Parallelogram& source, const MaskLattice& lattice, bool is_mirrored,
            const Vec3d& centre, std::span<const Vec2> outline = {}, bool is_disk = false);

  Vec3 to_canvas(const Vec3d& world) const;
  const MaskLattice& lattice() const { return lattice_; }
  // w of the source's plane; receivers that it lights have w below it.
  float height() const { return height_; }
  // Canvas units per metre, at most.
  double stretch() const;
  // Receivers that see vertices counterclockwise in space see them clockwise on the canvas.
  bool is_mirroring() const { return is_mirroring_; }
  bool is_disk() const { return is_disk_; }

  // What follows is for the kernels.
  struct Corner {
    float k, j;
  };
  const Corner* corners() const { return outline_.corners; }
  int corner_count() const { return outline_.count; }
  Vec3d centre() const { return map_.centre; }
  Vec3d first_sample() const { return samples_.first; }  // world position of canvas (0,0)
  Vec3d step_k() const { return samples_.step_k; }
  Vec3d step_j() const { return samples_.step_j; }
  Vec3 canvas_origin() const { return origin_; }
  // Rows of the linear part of to_canvas.
  const Vec3d& row(int i) const { return i == 0 ? map_.k : i == 1 ? map_.j : map_.w; }

 private:
  MaskLattice lattice_;
  struct CanvasFromWorld {
    Vec3d centre, k, j, w;  // rows of the linear part, from the centre
  } map_;
  struct Samples {
    Vec3d first, step_k, step_j;  // in world space
  } samples_;
  Vec3 origin_;  // canvas (0,0) of the source, relative to the centre
  float height_ = 0;
  bool is_mirroring_ = false, is_disk_ = false;
  struct Outline {
    Corner corners[most_source_corners];
    int count = 0;
  } outline_;
};

struct FacetFlags;

// Which side of the source's parallelogram edges are parallel to.
enum class EdgesAlong : uint8_t { neither, u, v };

// A facet in space; is_front_only: only receivers count that see its vertices counterclockwise.
struct FacetToAdd {
  Quad quad;
  uint32_t id;  // what it is called outside
  bool is_front_only;
};

// Facets of one cluster of receivers and one source, and what is round among what may hide it.
class FacetList {
 public:
  void clear();
  // Adds the part of a facet in front of the source's plane. is_front_only: only receivers count
  // that see its vertices counterclockwise. Facets without area are left out.
  void add(const MaskFrame& frame, const Quad& quad, bool is_front_only = false);
  // The same for many, several to a vector register.
  void add_many(const MaskFrame& frame, std::span<const FacetToAdd> facets);
  void finish();
  // Becomes the facets of `from` whose flag is 0; what is round is not copied.
  void keep_unsettled(const FacetList& from, const FacetFlags& flags);
  // Finds out whether most edges run along one side of the source. Before that: neither.
  void find_edges_along(const MaskLattice& lattice);
  EdgesAlong edges_along() const { return edges_along_; }
  // Lanes in use, of which after add_many some may hold no facet, and what is round.
  size_t size() const { return triangle_count_ + quad_count_ + round_.size(); }
  // What is round: covered by round_cover.h, all else by cover() below.
  RoundList& round() { return round_; }
  const RoundList& round() const { return round_; }

  const std::vector<FacetBatch<3>>& triangles() const { return triangles_; }
  const std::vector<FacetBatch<4>>& quads() const { return quads_; }

 private:
  template <int edges>
  void add_batch(const MaskFrame& frame, const FacetToAdd* const* facets, size_t n,
                 std::vector<FacetBatch<edges>>& batches, size_t& count);
  void add_polygon(const Vec3* v, int n, float skipped_side);
  std::vector<FacetBatch<3>> triangles_;
  std::vector<FacetBatch<4>> quads_;
  size_t triangle_count_ = 0, quad_count_ = 0;
  EdgesAlong edges_along_ = EdgesAlong::neither;
  RoundList round_;
};

// A receiver against the canvas, for the kernels: itself, and from it to sample (0,0) and to the
// corners of the source's parallelogram.
struct MaskPoint {
  float k, j, w;
  float first_k, first_j, h;
  float corner_k[4], corner_j[4];
  float rows;
  float receiver_size, source_size;  // sums of absolute coordinates, from the centre, from here
};

MaskPoint mask_point(const MaskFrame& frame, const Vec3& x, const Vec2& shift);

// Weights over the canvas, for the kernels: n·d and |d|², both scaled, as polynomials in k and j.
struct MaskWeights {
  float cosine, cosine_j, cosine_k;
  float square, square_j, square_jj;
  float slope, slope_j, square_kk;  // of |d|² in k: at column 0, and its change with j; quadratic
};

// What a receiver sees: of `inside` samples those of `open`.
struct CoverageMask {
  MaskRows inside, open;
  bool is_any_open = true;
};

// Weights of the samples inside and of the open ones, in a unit that is the same for one receiver.
struct MaskWeight {
  float all = 0, open = 0;
  float pair_squares = 0;  // of weights, one for each pair whose samples differ
  // Neighbouring samples of which one is open and one is not: in a row, in a column; all of them.
  int row_pairs = 0, column_pairs = 0, neighbours = 0;
  int inside_count = 0, open_count = 0;
  float share() const { return all > 0 ? open / all : 0; }
};

// x: the receiver, in canvas coordinates; shift in [0,1)². instruction_set: the machine's best, or
// 0 plain, 1 AVX2, 2 AVX-512 where there is one; results are the same bits.
void cover(const MaskFrame& frame, const FacetList& facets, const Vec3& x, const Vec2& shift,
           CoverageMask& out, int instruction_set = -1);

// Takes samples away of which n·d < 0, d from world position x: what lies behind a horizon.
void clip_to_horizon(const MaskFrame& frame, const Vec3d& x, const Vec3& n, const Vec2& shift,
                     CoverageMask& mask);

// The unoccluded weights of samples at world position x with unit normal n: max(n·d, 0) / |d|⁴,
// d from x to the sample, which is the differential form factor but for what all samples share.
MaskWeights mask_weights(const MaskFrame& frame, const Vec3d& x, const Vec3& n, const Vec2& shift);
inline float weight_of(const MaskWeights& w, float at, float row) {
  const float cosine = w.cosine + w.cosine_j * row + w.cosine_k * at;
  const float square = w.square + row * (w.square_j + row * w.square_jj) +
                       at * (w.slope + w.slope_j * row + at * w.square_kk);
  return (cosine > 0 ? cosine : 0) / (square * square);
}
inline float weight_of(const MaskWeights& w, int k, int j) {
  return weight_of(w, float(k), float(j));
}

// Visible share of the source's unoccluded irradiance; open_by_row, if not null, receives the open
// weight of each of 32 rows.
MaskWeight weigh(const MaskFrame& frame, const CoverageMask& mask, const MaskWeights& weights,
                 float* open_by_row = nullptr, int instruction_set = -1);

// Certificates for a whole cluster. receivers: corners of a convex body that holds all receivers up
// to `slack` canvas units. Per facet: 1 if it hides nothing of the source's parallelogram from any
// of them, 2 if it hides all of it from all of them, 0 if neither is certain. Each statement is a
// sign of det(a - x, b - x, y - x), a b an edge of the facet, or of a height over the facet's
// plane: affine in the receiver x and in the source point y, so that corners speak for all; bounds
// on the rounding errors stand against them, so that what is in doubt is 0.
struct FacetFlags {
  std::vector<int32_t> quads, triangles;  // per lane of FacetList's batches
};
void classify(const FacetList& facets, std::span<const MaskPoint> receivers, float slack,
              FacetFlags& flags, int instruction_set = -1);

}  // namespace troffer
