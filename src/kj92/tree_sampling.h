// Light of the treated sources at one vertex, by one bintree per source. All trees ask for rays in
// rounds that are traced together. BintreeDirect runs one sampler per thread.
// References: [1] Kok & Jansen, Eurographics '92, §2 to §4. [2] Heitz, Hill & McGuire, "Combining
//   Analytic Direct Illumination and Stochastic Shadows", I3D 2018.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kj92/source_selection.h"
#include "kj92/tree_pool.h"
#include "kj92/tree_source.h"
#include "transport/batch.h"

namespace troffer {

struct TreeSamplingOptions {
  BintreeOptions tree;  // initial_rays: for a source of medium size and importance
  // Probe rays for sources that the preprocessing found hidden or fully visible. If all probes
  // agree, the result is zero or the exact unoccluded light.
  int probe_rays = 4;
  bool has_coherence = true;  // reuse of patterns from hit to hit
  // Extension of [1]: where the unoccluded light is known exactly, the tree estimates only its
  // visible share (ratio estimator [2]). Variation of ray values then adds no noise.
  bool uses_ratio = false;
};

// A vertex that receives light.
struct TreeReceiver {
  const Vertex* vertex = nullptr;
  const SurfaceScattering* scattering = nullptr;
  uint64_t stream = 0;   // hash of pixel, sample and depth
  uint32_t depth = 0;    // 0 for vertices seen by viewing rays
  float throughput = 1;  // share of the result that enters the picture
  const NeighbourRecords* neighbours = nullptr;
  ShadowRecord* record = nullptr;  // filled if not null
};

// Result of TreeSampler::run.
struct TreeLight {
  Rgb from_lights, from_patches;  // radiance towards the viewer
  uint32_t rays = 0;
  uint32_t sampled = 0, probed_visible = 0, probed_hidden = 0;  // numbers of sources
};

// Samples the sources of one vertex after another. One per thread.
class TreeSampler {
 public:
  // sources[index_of_source[s]] is the source s of TreatedSource.
  TreeSampler(const PreparedScene& scene, const std::vector<TreeSource>& sources,
              const std::vector<uint32_t>& index_of_source, const TreeSamplingOptions& options)
      : scene_(scene),
        sources_(sources),
        index_of_source_(index_of_source),
        options_(options),
        pool_(options.tree) {}

  void forget_patterns() { pool_.forget(); }
  TreeLight run(const TreeReceiver& receiver, std::span<const TreatedSource> treated);

 private:
  struct Task {
    const TreeSource* source = nullptr;
    TreatedSource treated;
    TreePool::Entry* entry = nullptr;  // null: samples the doubtful cells of `agreed`
    bool is_single = false;            // casts one ray, without a tree
    ShadowPattern agreed;
    bool has_exact = false, takes_exact = false;
    Rgb exact;             // unoccluded radiance towards the viewer, if known
    Rgb colour;            // common factor of all values; black if there is none
    float unoccluded = 0;  // luminance of the unoccluded light towards the viewer
    size_t first_ray = 0;
    bool is_first_round = true;
    Rgb sum;  // without tree: light that arrives
    std::vector<ShadowRayResult> results;
    std::vector<int32_t> ray_of;  // ray of each result, after first_ray; -1: no light can arrive
    std::vector<Rgb> values;      // without tree
  };

  Task& new_task();
  void begin(const TreeReceiver& r, const TreatedSource& treated);
  void begin_tree(const TreeReceiver& r, Task& t);
  void share_allowance(const TreeReceiver& r);
  void ask_tree(const TreeReceiver& r, Task& t);
  void ask_lattice(const TreeReceiver& r, Task& t);
  void ask_single(const TreeReceiver& r, Task& t);
  bool answer(Task& t);
  void answer_lattice(Task& t);
  Rgb light_of(const TreeReceiver& r, const Task& t) const;
  void add_record(const TreeReceiver& r, const Task& t) const;

  const PreparedScene& scene_;
  const std::vector<TreeSource>& sources_;
  const std::vector<uint32_t>& index_of_source_;
  TreeSamplingOptions options_;
  TreePool pool_;
  std::vector<Task> tasks_;
  size_t task_count_ = 0;
  std::vector<size_t> active_, next_active_;
  std::vector<Ray> rays_;
  std::vector<uint8_t> is_occluded_;
  PaneFactors factors_;
};

}  // namespace troffer
