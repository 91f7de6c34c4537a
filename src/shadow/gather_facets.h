// Gathers the facets that may stand between a cluster and a source, by shafts. If they are too
// many, the cluster or the source is halved, or the list is cut. certified_light.cpp calls it for
// each source.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shadow/source_task.h"

namespace troffer {

// Some receivers, a part of a source, and the facets that may hide it.
struct SourcePart {
  std::vector<uint32_t> members;
  ReceiverHull hull;     // hull of the members
  FlatCell cell;         // source cell, for flat sources
  bool is_whole = true;  // the part is all of the source above a common horizon
  std::vector<FacetToAdd> facets;
  std::vector<RoundBody> rounds;
  std::vector<Quad> masked;  // as in ShadowCandidates
  bool is_masked_known = false;
  bool is_complete = true;      // no other occluder exists
  bool is_over_budget = false;  // the list was too long and has been cut
  bool is_dark = false;         // one facet hides all of the part from all members
};

// The parts of one source. Keeps their memory from source to source.
class SourceParts {
 public:
  void clear() { count_ = 0; }
  // Adds a part. Its vectors keep their old content, which the caller must replace.
  SourcePart& add();
  std::span<SourcePart> all() { return {parts_.data(), count_}; }

 private:
  std::vector<SourcePart> parts_;
  size_t count_ = 0;
};

// Working memory of gather_facets and of the divisions.
struct GatherMemory {
  ShadowCandidates candidates;
  SourceParts parts;
  FacetList large, left;  // for sources at infinity
  FacetFlags flags;
};

// Sets `out` to the facets in the shaft between a hull and a flat outline with unit `normal`, or a
// sphere. most: longest list.
void gather_facets(const ReceiverHull& hull, std::span<const Vec3d> outline, const Vec3d& normal,
                   size_t most, ShadowScene& scene, ShadowCandidates& out,
                   CertifiedCounters& counters);
void gather_facets(const ReceiverHull& hull, const SphereSource& sphere, size_t most,
                   ShadowScene& scene, ShadowCandidates& out, CertifiedCounters& counters);

// Adds the facets that rays have hit, then keeps the `most` facets: those first, then the largest
// as seen from `centre`.
void shorten_candidates(const FoundFacets& found, const Vec3d& centre, size_t most,
                        const ShadowScene& scene, std::vector<FacetToAdd>& facets);

// Divides the members against `cell` of a flat source, or against a sphere, into parts and sets
// memory.parts. Lists are short enough, or cut and incomplete. Reorders `members`.
void divide_flat(const SourceTask& task, std::span<uint32_t> members, const ReceiverHull& hull,
                 const FlatCell& cell, ShadowScene& scene, GatherMemory& memory,
                 CertifiedCounters& counters);
void divide_sphere(const SourceTask& task, std::span<uint32_t> members, const ReceiverHull& hull,
                   ShadowScene& scene, GatherMemory& memory, CertifiedCounters& counters);

// True if a facet near the source's outline rises above the slab of height `tolerance` in front of
// the source, in metres. Rays may end at that slab if none does. most: facets to examine; beyond
// that the result is true.
bool has_rim(const FlatSource& source, double tolerance, size_t most, ShadowScene& scene);

}  // namespace troffer
