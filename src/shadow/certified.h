// How much of a flat source the points of a cluster see: shadow flags proved by geometry, masks
// where a shadow's boundary passes, rays only for what no list of facets settles.
//
// For a cluster of receivers (neighbouring hits) and a source:
//   1. candidates that meet the shaft between them; too many: the cluster or the source is halved,
//   a
//      few times at most; none: all receivers are lit, exactly;
//   2. the source is cut into cells over which the unoccluded term does not vary much;
//   3. facets proved to hide nothing of a cell are dropped; one proved to hide all of it: dark;
//   4. the cluster is halved while that shortens lists;
//   5. per receiver and cell a coverage mask of the facets left (coverage_mask.h);
//   6. where the list is not complete, rays through open samples, drawn in proportion to weight.
// Cells and lists depend on geometry and on rays of earlier clusters, never on what is estimated
// with them, so that the estimate is unbiased: see docs/certified.md.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/box.h"
#include "base/quad.h"
#include "base/vec.h"
#include "shadow/certified_cells.h"
#include "shadow/certified_irradiance.h"
#include "shadow/coverage_mask.h"
#include "shadow/shaft.h"

namespace troffer {

constexpr uint32_t ray_is_free = 0xffffffffu;
constexpr uint32_t ray_is_stopped = 0xfffffffeu;  // by what is no facet

// A segment that is hidden or not; ends clear of both surfaces.
struct ShadowSegment {
  Vec3 from, to;
};

// is_front_only where a facet is part of a closed surface outside of which both ends lie.
struct ShadowCandidates {
  std::vector<FacetToAdd> facets;
  bool is_complete = true;   // nothing else can hide anything inside the shaft
  bool is_too_long = false;  // there are more facets: fewer receivers, or less source, would help
};

// The scene as the estimator sees it: one virtual call per cluster, none per ray. It may keep memory
// between calls: one for each thread.
class ShadowScene {
 public:
  virtual ~ShadowScene() = default;
  // Sets `out` to all facets that may have a point inside all planes, at most about `most`.
  virtual void candidates(std::span<const Plane> planes, const Box& receivers, const Box& source,
                          size_t most, ShadowCandidates& out) = 0;
  // hits[i]: ray_is_free, ray_is_stopped, or the id of a facet that hides segments[i].
  virtual void trace(std::span<const ShadowSegment> segments, std::span<uint32_t> hits) = 0;
  virtual Quad facet(uint32_t id) const = 0;
  // Largest absolute coordinate of all facets, metres.
  virtual double magnitude() const = 0;
};

struct ShadowReceiver {
  Vec3 position;
  Vec3 horizon;     // unit geometric normal: what lies behind it sends no light
  Vec3 normal;      // unit; of the cosine
  Vec3 origin;      // where rays start: position, moved off its surface along the horizon's normal
  uint64_t stream;  // hash of pixel and sample
};

// How a pair of receiver and source was answered. below: no light can arrive, the source is behind
// the horizon or the receiver behind the source.
enum class ShadowAnswer : uint8_t { below, lit, dark, masked, mixed };

struct SourceVisibility {
  float unoccluded = 0;  // projected solid angle, sr
  float visible = 0;     // share of it that is not hidden
  float variance = 0;    // of `visible`, an upper bound in mixed answers, else an estimate
  uint32_t rays = 0;
  ShadowAnswer answer = ShadowAnswer::below;
};

struct CertifiedOptions {
  MaskLattice lattice = coarse_lattice;
  size_t longest_list = 1024;  // facets gathered for a cluster
  int most_halvings = 3;       // of cluster or source, one within the other, where lists are longer
  size_t split_above = 24;     // facets in a list that make halving a cluster worth while
  size_t smallest_cluster = 16;  // receivers
  CellLimits cells;
  float residual_error = 0.02f;  // standard error allowed to rays, as a share of the source
  uint32_t most_rays = 64;       // per receiver and cell
  size_t most_found = 64;        // facets in the lists that are not complete
};

// What one tile has learnt of one source; kept from cluster to cluster by the caller.
class FoundFacets {
 public:
  struct Entry {
    uint32_t id;
    uint32_t hits;
  };
  // A ray met this facet.
  void add(uint32_t id);
  // Keeps the `most` most hit, and halves the counts.
  void trim(size_t most);
  const std::vector<Entry>& entries() const { return entries_; }
  bool is_hopeless = false;  // the last cluster's lists stayed too long

 private:
  std::vector<Entry> entries_;
};

struct CertifiedCounters {
  uint64_t clusters = 0, gathers = 0, candidates = 0, incomplete = 0, cells = 0;
  uint64_t masks = 0, mask_facets = 0;
};

class CertifiedEstimator {
 public:
  explicit CertifiedEstimator(const CertifiedOptions& options = {}) : options_(options) {}

  // The receivers of the calls of evaluate that follow; they must stay where they are.
  void begin_cluster(std::span<const ShadowReceiver> receivers);

  // out[i] answers receivers[i]. Deterministic in its arguments and the cluster; `found` is read
  // and updated. source_stream: hash that tells the source's random numbers from others'.
  void evaluate(const FlatSource& source, uint64_t source_stream, ShadowScene& scene,
                FoundFacets& found, std::span<SourceVisibility> out);

  const CertifiedCounters& counters() const { return counters_; }

 private:
  // certified.cpp: from the cluster and the source to lists and cells
  bool begin(std::span<SourceVisibility> out);
  void irradiance(std::span<const Vec3d> corners, std::vector<float>& values);
  void gather(const ReceiverHull& hull, const CertifiedCell& part, size_t most);
  void divide(std::span<uint32_t> members, const ReceiverHull& hull, const CertifiedCell& part,
              int halvings);
  void shorten_candidates(const Vec3d& centre);
  void settle_cells(std::span<uint32_t> members, const ReceiverHull& hull,
                    const CertifiedCell& part);
  void finish_sums();
  ReceiverHull hull_of(std::span<const uint32_t> members);

  // certified_settle.cpp: from a cell's list to answers
  size_t halve_members(std::span<uint32_t> members) const;  // at the median of the longest axis
  void settle(std::span<uint32_t> members, const ReceiverHull& hull, const FacetList& facets,
              int depth);
  bool settle_by_certificate(std::span<const uint32_t> members, const ReceiverHull& hull,
                             const FacetList& facets, FacetList& left);
  void mask(std::span<const uint32_t> members, const FacetList& facets);
  void add_rays(uint32_t member, const CoverageMask& mask, const MaskWeights& weights,
                const float* open_by_row, const MaskWeight& sums, const Vec2& shift);
  void add_answer(uint32_t member, float share, float variance, ShadowAnswer answer);
  void finish_rays();

  // Rays of one receiver to one cell: their mean times `weight` is part of the visible irradiance.
  struct RayGroup {
    uint32_t member, count;
    float weight;
  };

  CertifiedOptions options_;
  CertifiedCounters counters_;
  // the cluster at hand
  std::span<const ShadowReceiver> receivers_;
  ReceiverArrays arrays_;
  ReceiverHull cluster_hull_;
  bool has_own_horizons_ = false;
  // the call at hand
  const FlatSource* source_ = nullptr;
  ShadowScene* scene_ = nullptr;
  FoundFacets* found_ = nullptr;
  const CertifiedCell* whole_ = nullptr;
  std::span<SourceVisibility> out_;
  uint64_t source_stream_ = 0;
  double target_gap_ = 0;
  // the cell at hand
  const MaskFrame* frame_ = nullptr;
  uint64_t cell_stream_ = 0;
  bool is_complete_ = true;
  // memory
  std::vector<Vec3> hull_origins_, hull_normals_;
  std::vector<float> unoccluded_, cell_unoccluded_, cell_sums_;
  std::vector<uint32_t> members_, cell_members_;
  std::vector<uint8_t> kinds_;  // per receiver: a bit for each answer of its cells
  ShadowCandidates candidates_;
  static constexpr int most_depth = 8;
  std::array<FacetList, most_depth + 2> lists_;
  FacetFlags flags_;
  std::vector<ShadowSegment> segments_;
  std::vector<uint32_t> hits_;
  std::vector<RayGroup> groups_;
};

}  // namespace troffer
