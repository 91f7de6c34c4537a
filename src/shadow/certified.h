// How much of a source the points of a cluster see: shadow flags proved by geometry, masks where a
// shadow's boundary passes, rays only for what no list of facets settles.
//
// For a cluster of receivers (neighbouring hits) and a source:
//   1. candidates that meet the shaft between them; too many: the cluster or the source is halved,
//      a few times at most; none: all receivers are lit, exactly;
//   2. the source is cut into cells over which the unoccluded term does not vary much;
//   3. facets proved to hide nothing of a cell are dropped; one proved to hide all of it: dark;
//   4. the cluster is halved while that shortens lists;
//   5. per receiver and cell a coverage mask of the facets left (coverage_mask.h);
//   6. where the list is not complete, rays through open samples, drawn in proportion to weight:
//      residual_rays.h, for all sources of the cluster together.
// A sphere is the disk that its outline spans, one for each receiver, without steps 2 to 4. What is
// not Lambert's term times a constant radiance is integrated over points drawn from the mask.
// Cells and lists depend on geometry and on rays of earlier clusters, never on what is estimated
// with them, so that the estimate is unbiased: see docs/certified.md.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/rgb.h"
#include "base/vec.h"
#include "shadow/certified_cells.h"
#include "shadow/certified_irradiance.h"
#include "shadow/coverage_mask.h"
#include "shadow/mask_points.h"
#include "shadow/residual_rays.h"
#include "shadow/shadow_scene.h"
#include "shadow/shaft.h"

namespace troffer {

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

// What is settled without rays; RayAnswers add to it.
struct SourceVisibility {
  float unoccluded = 0;      // projected solid angle, sr
  float visible = 0;         // share of it that is not hidden
  float variance = 0;        // of `visible`, estimated
  Rgb value;                 // of the integrand, where the receiver has one
  float value_variance = 0;  // of its luminance
  ShadowAnswer answer = ShadowAnswer::below;
};

// What is sent on to a receiver through points of a source, per unit of projected solid angle:
// radiance × BRDF, where either varies.
class ShadowIntegrand {
 public:
  virtual ~ShadowIntegrand() = default;
  // At how many points of the whole source; 0: not at all, the receiver wants its visibility.
  virtual uint32_t points(uint32_t member) = 0;
  virtual void evaluate(uint32_t member, std::span<const Vec3> points, std::span<Rgb> values) = 0;
};

// A source but for its shape. `stream`: hash that tells its random numbers from others'.
struct SourceTerms {
  uint64_t stream = 0;
  float brightness = 1;  // luminance of its radiance
  uint32_t tag = 0;      // comes back in RayAnswer
  ShadowIntegrand* integrand = nullptr;
};

struct CertifiedOptions {
  MaskLattice lattice = coarse_lattice;
  size_t longest_list = 1024;  // facets gathered for a cluster
  int most_halvings = 3;       // of cluster or source, one within the other, where lists are longer
  size_t split_above = 24;     // facets in a list that make halving a cluster worth while
  size_t smallest_cluster = 16;  // receivers
  CellLimits cells;
  // Standard error allowed to rays of a receiver, relative to what all sources of the cluster would
  // send unoccluded: kept unless that takes more rays than the limits allow.
  float residual_error = 0.01f;
  RayLimits rays;
  uint32_t masks_with_rays = 4;  // per receiver and cell, where lists stay too long
  size_t most_found = 64;        // facets in the lists that are not complete
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

  // Projected solid angles of a source from the receivers, nothing hidden, sr. Valid until the next
  // call.
  std::span<const float> unoccluded(const FlatSource& source);
  std::span<const float> unoccluded(const SphereSource& source);

  // out[i] answers receivers[i], but for rays. Deterministic in its arguments and the cluster;
  // `found` is read now and updated by end_cluster.
  void evaluate(const FlatSource& source, const SourceTerms& terms, ShadowScene& scene,
                FoundFacets& found, std::span<SourceVisibility> out);
  void evaluate(const SphereSource& source, const SourceTerms& terms, ShadowScene& scene,
                FoundFacets& found, std::span<SourceVisibility> out);

  // Casts the rays that the cluster still needs: what they add. Valid until the next cluster.
  std::span<const RayAnswer> end_cluster(ShadowScene& scene);

  const CertifiedCounters& counters() const { return counters_; }

 private:
  // certified.cpp: from the cluster and the source to lists and cells
  bool begin(const SourceTerms& terms, ShadowScene& scene, FoundFacets& found,
             std::span<SourceVisibility> out);
  void irradiance(const FlatSource& source, std::span<const Vec3d> corners,
                  std::vector<float>& values);
  void gather(const ReceiverHull& hull, std::span<const Vec3d> outline, const Vec3d& normal,
              size_t most);
  void divide(std::span<uint32_t> members, const ReceiverHull& hull, const CertifiedCell& part,
              int halvings);
  bool is_last_try(int halvings) const { return halvings == 0 || found_->is_hopeless; }
  size_t most_candidates(bool is_last) const;
  void shorten_candidates(const Vec3d& centre);
  void settle_cells(std::span<uint32_t> members, const ReceiverHull& hull,
                    const CertifiedCell& part);
  void finish_sums();
  void look_for_rim(const RaySource& target);
  ReceiverHull hull_of(std::span<const uint32_t> members);

  // certified_sphere.cpp
  void divide_round(const SphereSource& source, std::span<uint32_t> members,
                    const ReceiverHull& hull, int halvings);
  void settle_round(const SphereSource& source, std::span<const uint32_t> members,
                    const ReceiverHull& hull);

  // certified_settle.cpp: from a cell's list to answers
  size_t halve_members(std::span<uint32_t> members) const;  // at the median of the longest axis
  void settle(std::span<uint32_t> members, const ReceiverHull& hull, const FacetList& facets,
              int depth);
  bool settle_by_certificate(std::span<const uint32_t> members, const ReceiverHull& hull,
                             const FacetList& facets, FacetList& left);
  void add_lit(uint32_t member);
  void mask(std::span<const uint32_t> members, const FacetList& facets);
  void mask_often(std::span<const uint32_t> members, const FacetList& facets);
  uint64_t ray_numbers(uint32_t member, uint64_t pass) const;
  float look(uint32_t member, const FacetList& facets, uint64_t pass, float& variance);
  void add_integral(uint32_t member, float light, float share_variance);
  void add_answer(uint32_t member, float share, float variance, ShadowAnswer answer);

  CertifiedOptions options_;
  CertifiedCounters counters_;
  // the cluster at hand
  std::span<const ShadowReceiver> receivers_;
  ReceiverArrays arrays_;
  ReceiverHull cluster_hull_;
  bool has_own_horizons_ = false;
  std::vector<float> unhidden_;  // per receiver: brightness × unoccluded of all sources so far
  ResidualRays rays_;
  // the call at hand
  const FlatSource* source_ = nullptr;
  SourceTerms terms_;
  ShadowScene* scene_ = nullptr;
  FoundFacets* found_ = nullptr;
  const CertifiedCell* whole_ = nullptr;
  std::span<SourceVisibility> out_;
  uint64_t own_ = no_round_source;
  // the cell at hand
  const MaskFrame* frame_ = nullptr;
  uint64_t cell_stream_ = 0;
  bool is_complete_ = true;
  // Unoccluded light knows the horizon of the normal only: the receiver's own one hides.
  bool does_horizon_hide_ = false;
  // memory
  std::vector<Vec3> hull_origins_, hull_normals_;
  std::vector<float> unoccluded_, cell_unoccluded_, cell_sums_;
  std::vector<uint32_t> members_, cell_members_, wanted_points_;
  std::vector<uint8_t> kinds_;  // per receiver: a bit for each answer of its cells
  ShadowCandidates candidates_;
  static constexpr int most_depth = 8;
  std::array<FacetList, most_depth + 2> lists_;
  FacetFlags flags_;
  CoverageMask mask_;
  OpenSamples samples_;
  std::vector<Vec3> points_;
  std::vector<Rgb> values_;
};

}  // namespace troffer
