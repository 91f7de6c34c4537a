// Coverage masks: the samples of a flat source that a receiver sees past a list of convex facets,
// one bit each, without rays. mask_cell.h and plan_cells.h use them.
// docs/method/certified-appendix.md, "Masks", has the proofs.
//
// Lattice: for coprime a and b, the samples are the points (u,v) of [0,1)² whose canvas coordinates
// (k,j) = (a u + b v, b - b u + a v) are integers plus a common shift. The square holds exactly a²
// + b² of them. A uniform shift makes each sample uniform, so estimates are unbiased. Edges
// parallel to a side of the source err by only 1 / (a² + b²).
//
// Facets: the map from world space to the canvas, with a third coordinate w along the source's
// normal, is affine. A facet therefore covers one interval of each row of bits [1]. Intervals are
// half open, and facets share the crossings of common edges: no cracks, no overlaps.
// References: [1] Olano & Greer, "Triangle Scan Conversion using 2D Homogeneous Coordinates",
//   Graphics Hardware 1997.
//   [2] Schwarz & Stamminger, "Bitmask Soft Shadows", EG 2007 (bit masks over a source).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/quad.h"
#include "base/vec.h"
#include "light/source_surface.h"
#include "shadow/round_list.h"

namespace troffer {

// Lattice of a² + b² samples. The canvas has `rows` rows of `rows` bits, with a + b <= rows <= 31.
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

// Facets in canvas coordinates, 16 per batch.
template <int edges>
struct alignas(64) FacetBatch {
  static constexpr int lanes = 16;
  float k[edges][lanes], j[edges][lanes], w[edges][lanes];
  // Supporting plane: normal · p = distance, in canvas coordinates.
  float normal_k[lanes], normal_j[lanes], normal_w[lanes], distance[lanes];
  // Receivers with sign(distance - normal · x) equal to this skip the facet; 0: none do.
  float skipped_side[lanes];
};

// Map from world space to a source's canvas, relative to `centre`, a point near the receivers.
class MaskFrame {
 public:
  // outline: corners in (u,v), in either order, of the part that emits, at most 16; empty: all of
  // the parallelogram. is_disk: the part is the inscribed ellipse. is_mirrored turns the lattice
  // the other way.
  MaskFrame(const Parallelogram& source, const MaskLattice& lattice, bool is_mirrored,
            const Vec3d& centre, std::span<const Vec2> outline = {}, bool is_disk = false);

  Vec3 to_canvas(const Vec3d& world) const;
  const MaskLattice& lattice() const { return lattice_; }
  // Returns w of the source's plane. Receivers that the source lights lie below it.
  float height() const { return height_; }
  // Returns an upper bound of canvas units per metre.
  double stretch() const;
  // True if vertices that a receiver sees counterclockwise in space appear clockwise on the canvas.
  bool is_mirroring() const { return is_mirroring_; }
  bool is_disk() const { return is_disk_; }

  // The following functions serve the kernels.
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
  // Returns row i of the linear part of to_canvas.
  const Vec3d& row(int i) const { return i == 0 ? map_.k : i == 1 ? map_.j : map_.w; }

 private:
  MaskLattice lattice_;
  struct CanvasFromWorld {
    Vec3d centre, k, j, w;  // rows of the linear part; the map's origin
  } map_;
  struct Samples {
    Vec3d first, step_k, step_j;  // world position of sample (0,0), and the steps to its neighbours
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

// The side of the source's parallelogram that most edges are parallel to.
enum class EdgesAlong : uint8_t { neither, u, v };

// A facet in world space. is_front_only: it counts only for receivers that see its vertices
// counterclockwise.
struct FacetToAdd {
  Quad quad;
  uint32_t id;  // the caller's name for it
  bool is_front_only;
};

// Facets of one cluster and one source, and the round occluders. Fill with clear(), add(),
// finish().
class FacetList {
 public:
  void clear();
  // Adds the part of a facet in front of the source's plane. is_front_only: it counts only for
  // receivers that see its vertices counterclockwise. Ignores facets without area.
  void add(const MaskFrame& frame, const Quad& quad, bool is_front_only = false);
  // Adds many facets, 16 at a time.
  void add_many(const MaskFrame& frame, std::span<const FacetToAdd> facets);
  // Fills the last batches with empty lanes. Call after the last add().
  void finish();
  // Becomes the facets of `from` whose flag is 0. Round occluders are not copied.
  void keep_unsettled(const FacetList& from, const FacetFlags& flags);
  // Finds out whether most edges are parallel to one side of the source. Until then edges_along()
  // is `neither`.
  void find_edges_along(const MaskLattice& lattice);
  EdgesAlong edges_along() const { return edges_along_; }
  // Returns the number of lanes in use plus round occluders. After add_many some lanes may be
  // empty.
  size_t size() const { return triangle_count_ + quad_count_ + round_.size(); }
  // Round occluders. round_cover.h covers them; cover() below ignores them.
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

// A receiver relative to the canvas, for the kernels: its position, and the vectors from it to
// sample (0,0) and to the corners of the source's parallelogram.
struct MaskPoint {
  float k, j, w;
  float first_k, first_j, h;
  float corner_k[4], corner_j[4];
  float rows;
  float receiver_size, source_size;  // sums of absolute coordinates
};

MaskPoint mask_point(const MaskFrame& frame, const Vec3& x, const Vec2& shift);

// Weights of samples, for the kernels: n·d and |d|², both scaled, as polynomials in k and j.
struct MaskWeights {
  float cosine, cosine_j, cosine_k;
  float square, square_j, square_jj;
  float slope, slope_j, square_kk;  // coefficients of k and k² in |d|²
};

// Samples inside the source's outline, and those of them that the receiver sees.
struct CoverageMask {
  MaskRows inside, open;
  bool is_any_open = true;
};

// Sums of weights over a mask. The unit is common to all masks of one receiver and cell.
struct MaskWeight {
  float all = 0, open = 0;
  float pair_squares = 0;  // sum of squared weights, once per pair of neighbours that differ
  // Pairs of neighbours of which exactly one is open, in a row and in a column; all pairs.
  int row_pairs = 0, column_pairs = 0, neighbours = 0;
  int inside_count = 0, open_count = 0;
  float share() const { return all > 0 ? open / all : 0; }
};

// Computes the mask of a receiver. x: receiver in canvas coordinates; shift in [0,1)².
// instruction_set: -1 for the best available, 0 plain, 1 AVX2, 2 AVX-512. All give the same bits.
void cover(const MaskFrame& frame, const FacetList& facets, const Vec3& x, const Vec2& shift,
           CoverageMask& out, int instruction_set = -1);

// Removes the samples with n·d < 0, where d is the direction from world position x: those below a
// horizon.
void clip_to_horizon(const MaskFrame& frame, const Vec3d& x, const Vec3& n, const Vec2& shift,
                     CoverageMask& mask);

// Returns the unoccluded weights max(n·d, 0) / |d|⁴ of samples, with d from world position x to the
// sample and n the unit normal. This is the differential form factor up to a common factor.
MaskWeights mask_weights(const MaskFrame& frame, const Vec3d& x, const Vec3& n, const Vec2& shift);
// Returns the weight of sample (at, row).
inline float weight_of(const MaskWeights& w, float at, float row) {
  const float cosine = w.cosine + w.cosine_j * row + w.cosine_k * at;
  const float square = w.square + row * (w.square_j + row * w.square_jj) +
                       at * (w.slope + w.slope_j * row + at * w.square_kk);
  return (cosine > 0 ? cosine : 0) / (square * square);
}
inline float weight_of(const MaskWeights& w, int k, int j) {
  return weight_of(w, float(k), float(j));
}

// Sums the weights of a mask. open_by_row, if not null, receives the open weight of each of 32
// rows.
MaskWeight weigh(const MaskFrame& frame, const CoverageMask& mask, const MaskWeights& weights,
                 float* open_by_row = nullptr, int instruction_set = -1);

// Flags of facets for a whole cluster: 1 if the facet hides nothing of the source's parallelogram
// from any receiver, 2 if it hides all of it from all receivers, 0 if neither is proved. Both are
// signs of det(a - x, b - x, y - x), with a and b ends of an edge, or of a height over the facet's
// plane. These are affine in the receiver x and in the source point y, so corners suffice. A sign
// within its rounding bound gives 0.
struct FacetFlags {
  std::vector<int32_t> quads, triangles;  // per lane of FacetList's batches
};
// Sets the flags of `facets`. receivers: corners of a convex body that holds all receivers up to
// `slack` canvas units. instruction_set as in cover().
void classify(const FacetList& facets, std::span<const MaskPoint> receivers, float slack,
              FacetFlags& flags, int instruction_set = -1);

}  // namespace troffer
