// How much of a flat source the points of a cluster see: shadow flags proved by geometry, masks
// where a shadow's boundary passes, rays only for what no list of facets settles.
//
// For a cluster of receivers (neighbouring hits) and a source:
//   1. candidates that meet the shaft between them; none: all receivers are lit, exactly;
//   2. facets proved to hide nothing are dropped; one proved to hide all: all receivers are dark;
//   3. the cluster is halved while that shortens lists;
//   4. per receiver a coverage mask of the facets left (coverage_mask.h);
//   5. where the list is not complete, rays through open samples, drawn in proportion to weight.
// Lists depend on geometry and on rays of earlier clusters, never on what is estimated with them,
// so that the estimate is unbiased: see docs/certified.md.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/box.h"
#include "base/quad.h"
#include "base/vec.h"
#include "shadow/coverage_mask.h"
#include "shadow/shaft.h"

namespace troffer {

constexpr uint32_t ray_is_free = 0xffffffffu;
constexpr uint32_t ray_is_stopped = 0xfffffffeu;  // by what is no facet

// A segment that is hidden or not; ends clear of both surfaces.
struct ShadowSegment {
  Vec3 from, to;
};

struct ShadowCandidate {
  Quad quad;
  uint32_t id;
  bool is_front_only;  // part of a closed surface, outside of which both ends lie
};

struct ShadowCandidates {
  std::vector<ShadowCandidate> facets;
  bool is_complete = true;  // nothing else can hide anything inside the shaft
};

// The scene as the estimator sees it: one virtual call per cluster, none per ray.
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

// A flat source: the part `outline` (corners in (u,v), convex, at most 8; empty: all) of a
// parallelogram whose normal points to the receivers that count.
struct FlatSource {
  Parallelogram plane;
  std::vector<Vec2> outline;

  std::vector<Vec3d> corners() const;  // in space
};

struct ShadowReceiver {
  Vec3 position;
  Vec3 normal;      // unit; of the horizon and of the cosine
  Vec3 origin;      // where rays start: position, moved off its surface along the normal
  uint64_t stream;  // hash of pixel, sample and source
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
  size_t longest_list = 256;     // candidates gathered for a cluster
  size_t split_above = 12;       // facets in a list that make halving a cluster worth while
  size_t smallest_cluster = 8;   // receivers
  float residual_error = 0.02f;  // standard error allowed to rays, as a share of the source
  uint32_t most_rays = 16;       // per receiver
  size_t most_found = 32;        // facets remembered from rays
};

// Facets that rays met, most often met first; kept from cluster to cluster by the caller, one per
// source and tile.
class FoundFacets {
 public:
  struct Entry {
    uint32_t id;
    uint32_t hits;
  };
  void add(uint32_t id);
  // Halves the counts and keeps the `most` most hit.
  void trim(size_t most);
  const std::vector<Entry>& entries() const { return entries_; }
  void clear() { entries_.clear(); }

 private:
  std::vector<Entry> entries_;
};

struct CertifiedCounters {
  uint64_t clusters = 0, gathers = 0, candidates = 0, incomplete = 0, masks = 0, mask_facets = 0;
};

class CertifiedEstimator {
 public:
  explicit CertifiedEstimator(const CertifiedOptions& options = {}) : options_(options) {}

  // out[i] answers receivers[i]. Deterministic in its arguments. `found` is read and updated.
  void evaluate(const FlatSource& source, std::span<const ShadowReceiver> receivers,
                ShadowScene& scene, FoundFacets& found, std::span<SourceVisibility> out);

  const CertifiedCounters& counters() const { return counters_; }

 private:
  struct Ray {
    uint32_t receiver;
  };
  // A part of the cluster and what may hide the source from it.
  void settle(std::span<uint32_t> members, const FacetList& facets, int depth);
  bool settle_by_certificate(std::span<const uint32_t> members, const ReceiverHull& hull,
                             const FacetList& facets, FacetList& left);
  void mask(std::span<const uint32_t> members, const FacetList& facets);
  void add_rays(uint32_t member, const CoverageMask& mask, const MaskWeights& weights,
                const float* open_by_row, float open, float all, const Vec2& shift);
  void finish_rays(FoundFacets& found);
  ReceiverHull hull_of(std::span<const uint32_t> members);

  CertifiedOptions options_;
  CertifiedCounters counters_;
  // of the cluster at hand
  const MaskFrame* frame_ = nullptr;
  ShadowScene* scene_ = nullptr;
  const FlatSource* source_ = nullptr;
  std::span<const ShadowReceiver> receivers_;
  std::span<SourceVisibility> out_;
  bool is_complete_ = true;
  double target_gap_ = 0;
  // memory
  std::vector<Vec3> positions_, normals_, origins_, hull_origins_, hull_normals_;
  std::vector<float> unoccluded_;
  std::vector<uint32_t> members_;
  ShadowCandidates candidates_;
  static constexpr int most_depth = 8;
  std::array<FacetList, most_depth + 2> lists_;
  FacetFlags flags_;
  std::vector<ShadowSegment> segments_;
  std::vector<uint32_t> hits_, ray_receivers_;
};

}  // namespace troffer
