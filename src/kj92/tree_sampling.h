// Light from the treated sources at one vertex, by a bintree for each: the trees ask for rays in
// rounds, and the rays of all of them are traced together.
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
  BintreeOptions tree;  // initial_rays: of a source of middling size and importance
  // Rays that look for surprises where the preprocessing found a source hidden or visible. Where
  // they agree with it, its word is taken: nothing, or the exact unoccluded light.
  int probe_rays = 4;
  bool has_coherence = true;  // patterns are reused
  // Not in [1]: where the unoccluded light is known exactly, a tree gives only the share of it that
  // is visible (ratio estimator [2]), so that rays' values may differ as they like.
  bool uses_ratio = false;
};

// Where light is asked for.
struct TreeReceiver {
  const Vertex* vertex = nullptr;
  const SurfaceScattering* scattering = nullptr;
  uint64_t stream = 0;   // names pixel, sample and depth
  uint32_t depth = 0;    // 0: seen by a viewing ray itself
  float throughput = 1;  // the share of what is computed here that enters the picture
  const NeighbourRecords* neighbours = nullptr;
  ShadowRecord* record = nullptr;  // filled if not null
};

struct TreeLight {
  Rgb from_lights, from_patches;  // radiance towards the viewer
  uint32_t rays = 0;
  uint32_t sampled = 0, probed_visible = 0, probed_hidden = 0;  // sources
};

// One for each thread.
class TreeSampler {
 public:
  // sources[i] is the source named i in TreatedSource, where it is treated anywhere.
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
    TreePool::Entry* entry = nullptr;  // null: asks the cells of `agreed` that are in doubt …
    bool is_single = false;            // … or one ray, which tells all
    ShadowPattern agreed;
    bool has_exact = false, takes_exact = false;
    Rgb exact;             // unoccluded radiance towards the viewer, where it is known
    Rgb colour;            // all values are multiples of it; black: they are not
    float unoccluded = 0;  // luminance that would enter the picture unoccluded
    size_t first_ray = 0;
    bool is_first_round = true;
    Rgb sum;  // without tree: what arrives
    std::vector<ShadowRayResult> results;
    std::vector<int32_t> ray_of;  // of each result, from first_ray on; -1: nothing can arrive
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
