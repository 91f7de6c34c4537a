#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "kj92/tree_pool.h"
#include "methods.h"
#include "shadow_rays.h"

namespace troffer::bench {

namespace {

// Copies of the constants in kj92/tree_sampling.cpp.
constexpr float small_source = 0.002f, large_source = 0.5f;
constexpr size_t packet_rays = 4;

// One tree that works for one hit.
struct Task {
  size_t pair = 0;
  const FlatSource* source = nullptr;
  TreePool::Entry* entry = nullptr;
  double unoccluded = 0;
  size_t first_ray = 0;
  std::vector<ShadowRayResult> results;
  std::vector<int32_t> ray_of;  // -1: nothing can arrive
};

class Sampler {
 public:
  Sampler(const Pairs& pairs, const BintreeOptions& options, bool has_coherence)
      : pairs_(pairs), options_(options), has_coherence_(has_coherence), pool_(options) {
    for (const FlatSource& s : pairs.scene.sources) areas_.push_back(area_of(s));
    tasks_.resize(areas_.size());
  }

  void run(uint64_t seed, Answers& out) {
    for (size_t t = 0; t < pairs_.tiles.size(); ++t) {
      pool_.forget();
      for (size_t r = 0; r < pairs_.tiles[t].size(); ++r) run_hit(t, r, seed, out);
    }
  }

 private:
  void run_hit(size_t t, size_t r, uint64_t seed, Answers& out) {
    const Tile& tile = pairs_.tiles[t];
    pool_.release_all();
    size_t count = 0;
    double sum = 0;
    for (size_t s = 0; s < areas_.size(); ++s) {
      const size_t pair = pairs_.index(t, s, r);
      if (!(pairs_.unoccluded[pair] > 0)) continue;
      Task& task = tasks_[count];
      task.pair = pair;
      task.source = &pairs_.scene.sources[s];
      task.unoccluded = pairs_.unoccluded[pair];
      begin(tile, r, s, seed, task);
      sum += pairs_.scene.radiance[s] * task.unoccluded;
      ++count;
    }
    // as in rendering, each source's share of the allowed variance is its share of the light
    for (size_t i = 0; i < count; ++i) {
      const size_t s = size_t(tasks_[i].source - pairs_.scene.sources.data());
      const double share = pairs_.scene.radiance[s] * tasks_[i].unoccluded / sum;
      tasks_[i].entry->tree.set_unoccluded(1, float(std::sqrt(std::max(1 / share, 1.0))));
    }
    answer(tile, r, count, out);
  }

  void begin(const Tile& tile, size_t r, size_t s, uint64_t seed, Task& task) {
    const TreeKey key{uint32_t(s), tile.geometries[r], 0, tile.is_front[r] != 0};
    task.entry = &pool_.acquire(key, tile.normals[r], has_coherence_);
    const uint64_t stream = stream_of(tile, r, s, seed);
    Bintree& tree = task.entry->tree;
    if (task.entry->has_pattern) {
      tree.shrink();
      tree.resample(stream);
    } else {
      const auto projected = float(task.unoccluded / pi);
      int initial = options_.initial_rays;
      if (projected < small_source) initial = std::max(initial / 2, 1);
      if (projected > large_source) initial *= 2;
      tree.start(stream, 1, initial);
    }
    task.entry->has_pattern = true;
  }

  // Traces rounds of rays for all trees together, until no tree asks for more.
  void answer(const Tile& tile, size_t r, size_t count, Answers& out) {
    active_.clear();
    for (size_t i = 0; i < count; ++i) active_.push_back(i);
    while (!active_.empty()) {
      rays_.clear();
      for (const size_t i : active_) ask(tile, r, tasks_[i]);
      hidden_.resize(rays_.size());
      pairs_.scene.prepared.tracer.occluded(
          rays_, hidden_, rays_.size() >= packet_rays ? Coherence::coherent : Coherence::none);
      out.rays += rays_.size();
      next_.clear();
      for (const size_t i : active_) {
        Task& t = tasks_[i];
        for (size_t k = 0; k < t.results.size(); ++k)
          if (t.ray_of[k] >= 0)
            t.results[k].is_visible = hidden_[t.first_ray + size_t(t.ray_of[k])] == 0;
        t.entry->tree.supply(t.results);
        if (!t.entry->tree.pending().empty()) next_.push_back(i);
      }
      active_.swap(next_);
    }
    for (size_t i = 0; i < count; ++i) {
      const Bintree& tree = tasks_[i].entry->tree;
      const float all = tree.kernel_mean();
      out.visible[tasks_[i].pair] = all > 0 ? tree.estimate().mean / all : 0.5f;
      out.variance[tasks_[i].pair] = tree.estimate().variance;
    }
  }

  void ask(const Tile& tile, size_t r, Task& t) {
    const std::span<const Vec2> points = t.entry->tree.pending();
    const FlatSource& s = *t.source;
    const Vec3 o = Vec3(s.plane.origin - Vec3d(tile.positions[r])), u(s.plane.u), v(s.plane.v);
    const Vec3 shift = tile.positions[r] - tile.origins[r], normal(s.plane.normal);
    const float length = ray_length(s, tile.origins[r]);
    const auto scale = float(areas_[size_t(t.source - pairs_.scene.sources.data())] / t.unoccluded);
    const bool is_plain = !s.is_disk && s.outline.empty();
    t.first_ray = rays_.size();
    t.results.resize(points.size());
    t.ray_of.resize(points.size());
    int32_t rays = 0;
    for (size_t i = 0; i < points.size(); ++i) {
      const Vec2 uv = is_plain ? points[i] : onto_outline(s, points[i]);
      const Vec3 d = o + u * uv.x + v * uv.y;
      const float cosine = dot(d, tile.normals[r]), square = dot(d, d);
      const bool arrives = cosine > 0;
      const float kernel = arrives ? cosine * -dot(d, normal) / (square * square) * scale : 0;
      t.results[i] = {true, kernel};
      t.ray_of[i] = arrives ? rays++ : -1;
      if (arrives) rays_.push_back({tile.origins[r], 0, d + shift, length});
    }
  }

  const Pairs& pairs_;
  BintreeOptions options_;
  bool has_coherence_;
  TreePool pool_;
  std::vector<double> areas_;
  std::vector<Task> tasks_;
  std::vector<size_t> active_, next_;
  std::vector<Ray> rays_;
  std::vector<uint8_t> hidden_;
};

}  // namespace

void run_kj92(const Pairs& pairs, const BintreeOptions& options, bool has_coherence, uint64_t seed,
              Answers& out) {
  out.reset(pairs.size());
  const double start = thread_seconds();
  Sampler(pairs, options, has_coherence).run(seed, out);
  out.seconds = thread_seconds() - start;
}

}  // namespace troffer::bench
