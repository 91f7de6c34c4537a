// Light of bright patches by certified visibility: where the selection of sources took a patch of
// the radiosity solution out of the general value, its light is added here, with its shadows.
//
// A patch sends what its elements hold: radiance shot × the share of the element at each point, as
// the preprocessing had it when it found what was taken out. Its pieces are flat sources. Hits wait
// until the wave has arrived; those on one patch, which have the same sources, are clustered. What
// is added counts as indirect. Unbiased as an estimate of what the solution's patches send.
// References: docs/certified.md, "Bright patches".
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "integrate/shadow_world.h"
#include "integrate/waiting_hits.h"
#include "radiosity/shooter.h"
#include "radiosity/solution.h"
#include "select/source_selection.h"
#include "shadow/receiver_clusters.h"

namespace troffer {

// What the method wants of the preprocessing: every light is treated everywhere, and with patches
// those that are flat, partly hidden, and far enough away for their elements to tell how they
// shine.
SelectionOptions certified_selection(bool has_patches);

// A piece of a patch as a source of the pieces' mean radiance.
struct PatchSource {
  FlatSource flat;
  Rgb radiance;                      // the mean over the patch
  const Shooter* shooter = nullptr;  // of the patch
  uint32_t points = 0;               // PatchIntegrand::points_for
  uint64_t stream = 0;
};

// What points of a patch send on to matte hits: its radiance there.
class PatchIntegrand final : public ShadowIntegrand {
 public:
  // At how many points to look at a patch: the more its elements differ, the more; 0: they hardly
  // do, its mean does.
  static uint32_t points_for(const Shooter& shooter);

  std::vector<const PatchSource*>& sources() { return sources_; }  // of the cluster's requests
  uint32_t points(uint32_t request, uint32_t) override { return sources_[request]->points; }
  void evaluate(uint32_t request, uint32_t member, std::span<const Vec3> points,
                std::span<Rgb> values) override;

 private:
  std::vector<const PatchSource*> sources_;
};

// Memory of one thread.
struct CertifiedPatchesScratch {
  explicit CertifiedPatchesScratch(const CertifiedOptions& o) : options(o) {}
  WaitingHits hits;
  std::vector<uint32_t> patches;  // that the hits lie on
  CertifiedOptions options;
  PatchIntegrand integrand;
  std::vector<FoundFacets> found;  // per source: what this batch has learnt …
  std::vector<uint32_t> touched;   // … of these
  std::vector<uint32_t> order;     // of the hits, by patch
  std::vector<Vec3> positions, horizons;
  ReceiverClusters clusters;
  CertifiedCluster cluster;
  std::vector<uint32_t> members;  // of the cluster
};

class CertifiedPatches {
 public:
  CertifiedPatches() = default;
  // Of the patches that the selection treats anywhere. `solution` and `selection` belong to the
  // scene, and the solution must outlive this; the selection is one by certified_selection().
  CertifiedPatches(const PreparedScene& scene, const RadiositySolution& solution,
                   const SourceSelection& selection);

  bool is_empty() const { return sources_.empty(); }

  // Of estimates by settings that suit the scene's lights: patches are weaker.
  static CertifiedOptions options(const CertifiedOptions& of_lights);

  // What a batch learns is forgotten at its beginning.
  void forget(CertifiedPatchesScratch& s) const;
  // A hit on `patch` waits for the patch's sources, if there are any.
  void add(const Walk& walk, const Vertex& v, const Rgb& reflectance, uint32_t patch,
           CertifiedPatchesScratch& s) const;
  // Adds the light of patches at all hits that wait, and lets them go.
  void illuminate(CertifiedPatchesScratch& s, ShadowWorld& world, RadianceBatch& out,
                  Counters& counters) const;

 private:
  void add_shooter(const RadiositySolution& solution, uint32_t patch);
  std::span<const uint32_t> sources_at(uint32_t patch) const {
    return {lit_by_.data() + first_[patch], first_[patch + 1] - first_[patch]};
  }
  void illuminate_patch(std::span<const uint32_t> hits, CertifiedPatchesScratch& s,
                        ShadowWorld& world, RadianceBatch& out, Counters& counters) const;
  void illuminate_cluster(std::span<const uint32_t> sources, CertifiedPatchesScratch& s,
                          ShadowWorld& world, RadianceBatch& out, Counters& counters) const;

  std::vector<std::unique_ptr<const Shooter>> shooters_;  // of treated patches; they stay in place
  std::vector<PatchSource> sources_;                      // their pieces
  // Per patch, the sources treated there: [first_[p], first_[p + 1]) of lit_by_.
  std::vector<size_t> first_;
  std::vector<uint32_t> lit_by_;
};

}  // namespace troffer
