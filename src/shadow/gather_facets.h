// The facets that can stand between a cluster and a source: gathered by shafts, and where they are
// too many, the cluster or the source halved, or the list cut.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shadow/source_task.h"

namespace troffer {

// Receivers against some of a source, with what may hide it.
struct SourcePart {
  std::vector<uint32_t> members;
  ReceiverHull hull;     // of the members
  FlatCell cell;         // of a flat source
  bool is_whole = true;  // it is all of the source that stands above a common horizon
  std::vector<FacetToAdd> facets;
  std::vector<RoundBody> rounds;
  std::vector<Quad> masked;  // as in ShadowCandidates
  bool is_masked_known = false;
  bool is_complete = true;      // nothing else can hide anything
  bool is_over_budget = false;  // the list was too long and has been cut
  bool is_dark = false;         // one facet hides all of it from all members
};

// The parts that one source comes to; keeps their memory from source to source.
class SourceParts {
 public:
  void clear() { count_ = 0; }
  // One more; its vectors hold what they held.
  SourcePart& add();
  std::span<SourcePart> all() { return {parts_.data(), count_}; }

 private:
  std::vector<SourcePart> parts_;
  size_t count_ = 0;
};

// What gathering writes to.
struct GatherMemory {
  ShadowCandidates candidates;
  SourceParts parts;
  FacetList large, left;  // of far sources
  FacetFlags flags;
};

// Sets `out` to the facets in the shaft between a hull and a flat outline, or a sphere.
void gather_facets(const ReceiverHull& hull, std::span<const Vec3d> outline, const Vec3d& normal,
                   size_t most, ShadowScene& scene, ShadowCandidates& out,
                   CertifiedCounters& counters);
void gather_facets(const ReceiverHull& hull, const SphereSource& sphere, size_t most,
                   ShadowScene& scene, ShadowCandidates& out, CertifiedCounters& counters);

// Adds the facets that rays have met, and keeps the `most` that hide most, these first.
void shorten_candidates(const FoundFacets& found, const Vec3d& centre, size_t most,
                        const ShadowScene& scene, std::vector<FacetToAdd>& facets);

// Sets memory.parts to what the members against `cell` (of a flat source), or against a sphere, are
// divided into: parts whose lists are short enough, or cut. `members` is reordered.
void divide_flat(const SourceTask& task, std::span<uint32_t> members, const ReceiverHull& hull,
                 const FlatCell& cell, ShadowScene& scene, GatherMemory& memory,
                 CertifiedCounters& counters);
void divide_sphere(const SourceTask& task, std::span<uint32_t> members, const ReceiverHull& hull,
                   ShadowScene& scene, GatherMemory& memory, CertifiedCounters& counters);

// Whether a facet rises out of the slab before the source that rays may leave out, within its
// outline. most: facets to look at.
bool has_rim(const FlatSource& source, double tolerance, size_t most, ShadowScene& scene);

}  // namespace troffer
