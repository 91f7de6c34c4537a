#include "kj92/tree_sampling.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "kj92/bintree_pattern.h"

namespace troffer {

namespace {

// Sources below or above these shares of the hemisphere start with half or twice the rays. [1, §2]
// asks for 4 to 16 rays by size and importance. Shares are in projected solid angle over pi.
constexpr float small_source = 0.002f, large_source = 0.5f;
// Lower limit of the throughput that scales allowed errors.
constexpr float least_throughput = 0.02f;
// Number of rays from which ray packets are faster.
constexpr size_t packet_rays = 4;

int initial_rays(const TreeSamplingOptions& o, const TreatedSource& t, float projected) {
  const int usual = o.tree.initial_rays;
  if (t.source_class.treatment == SourceTreatment::probed) return std::min(usual, o.probe_rays);
  if (projected > 0 && projected < small_source) return std::max(usual / 2, 1);
  return projected > large_source ? 2 * usual : usual;
}

}  // namespace

TreeSampler::Task& TreeSampler::new_task() {
  if (task_count_ == tasks_.size()) tasks_.emplace_back();
  Task& t = tasks_[task_count_++];
  t.entry = nullptr;
  t.is_single = false;
  t.has_exact = t.takes_exact = false;
  t.exact = t.colour = t.sum = Rgb{0};
  t.is_first_round = true;
  t.unoccluded = 0;
  return t;
}

TreeLight TreeSampler::run(const TreeReceiver& r, std::span<const TreatedSource> treated) {
  TreeLight light;
  task_count_ = 0;
  pool_.release_all();
  for (const TreatedSource& t : treated) begin(r, t);
  active_.clear();
  for (size_t i = 0; i < task_count_; ++i) active_.push_back(i);
  bool is_first = true;
  while (!active_.empty()) {
    rays_.clear();
    for (const size_t i : active_) {
      Task& t = tasks_[i];
      if (t.is_single)
        ask_single(r, t);
      else
        t.entry == nullptr ? ask_lattice(r, t) : ask_tree(r, t);
    }
    if (is_first) share_allowance(r);
    is_first = false;
    is_occluded_.resize(rays_.size());
    scene_.tracer.occluded(rays_, is_occluded_,
                           rays_.size() >= packet_rays ? Coherence::coherent : Coherence::none,
                           factors_);
    light.rays += uint32_t(rays_.size());
    next_active_.clear();
    for (const size_t i : active_)
      if (answer(tasks_[i])) next_active_.push_back(i);
    active_.swap(next_active_);
  }
  for (size_t i = 0; i < task_count_; ++i) {
    const Task& t = tasks_[i];
    (t.source->is_patch() ? light.from_patches : light.from_lights) += light_of(r, t);
    const SourceClass& c = t.treated.source_class;
    if (c.treatment == SourceTreatment::sampled)
      ++light.sampled;
    else
      ++(c.view == SourceView::visible ? light.probed_visible : light.probed_hidden);
    if (r.record != nullptr) add_record(r, t);
  }
  return light;
}

void TreeSampler::begin(const TreeReceiver& r, const TreatedSource& treated) {
  const TreeSource& source = sources_[index_of_source_[treated.source]];
  if (source.is_empty()) return;
  const SurfaceScattering& s = *r.scattering;
  Rgb exact;
  const bool has_exact = s.is_lambertian && source.has_exact_irradiance();
  if (has_exact) {
    exact = s.diffuse.diffuse * source.exact_irradiance(scene_, *r.vertex) * inv_pi_f;
    if (exact.is_black()) return;
  }
  Task& t = new_task();
  t.source = &source;
  t.treated = treated;
  t.is_single = source.is_delta();
  t.has_exact = has_exact;
  t.exact = exact;
  if (t.is_single) return;
  if (s.is_lambertian && source.is_constant()) t.colour = s.diffuse.diffuse * source.radiance();
  if (r.neighbours != nullptr && r.record != nullptr &&
      agreed_pattern(*r.neighbours, *r.record, treated.source, t.agreed))
    return;
  begin_tree(r, t);
}

void TreeSampler::begin_tree(const TreeReceiver& r, Task& t) {
  const Surface& surface = r.vertex->surface;
  const TreeKey key{t.treated.source, surface.geometry, r.depth, r.vertex->is_front};
  t.entry = &pool_.acquire(key, r.vertex->frame.normal, options_.has_coherence);
  const uint64_t stream = hash_combine(r.stream, t.treated.source);
  const float unoccluded = luminance(t.exact);
  Bintree& tree = t.entry->tree;
  if (t.entry->has_pattern) {
    tree.shrink();
    tree.resample(stream);
  } else {
    const float colour = luminance(t.colour);
    const float projected = t.has_exact && colour > 0 ? unoccluded / colour : 0.1f;
    tree.start(stream, 1, initial_rays(options_, t.treated, projected));
  }
  t.entry->has_pattern = true;
}

void TreeSampler::ask_tree(const TreeReceiver& r, Task& t) {
  const std::span<const Vec2> uv = t.entry->tree.pending();
  t.first_ray = rays_.size();
  t.results.resize(uv.size());
  t.ray_of.resize(uv.size());
  int32_t rays = 0;
  for (size_t i = 0; i < uv.size(); ++i) {
    TreeSourceSample s;
    const bool arrives = t.source->sample(scene_, uv[i], *r.vertex, *r.scattering,
                                          float(options_.tree.initial_rays), s);
    t.results[i] = {true, arrives ? luminance(s.value) : 0};
    t.ray_of[i] = arrives ? rays++ : -1;
    if (arrives) rays_.push_back(s.shadow_ray);
  }
}

// The allowed error is relative to the light of all sources together. Each source gets the part of
// the variance that equals its part of the light. Weak sources then need few rays, and the
// variances add up to the allowed one.
void TreeSampler::share_allowance(const TreeReceiver& r) {
  float sum = 0;
  for (size_t i = 0; i < task_count_; ++i) {
    Task& t = tasks_[i];
    t.unoccluded = t.has_exact          ? luminance(t.exact)
                   : t.entry != nullptr ? t.entry->tree.mean_of_pending(t.results)
                                        : 0;
    sum += t.unoccluded * t.treated.source_class.most_visibility;
  }
  const float carried = std::clamp(r.throughput, least_throughput, 1.0f);
  for (size_t i = 0; i < task_count_; ++i) {
    Task& t = tasks_[i];
    if (t.entry == nullptr || !(t.unoccluded > 0)) continue;
    const float leniency = std::sqrt(std::max(sum / t.unoccluded, 1.0f)) / carried;
    t.entry->tree.set_unoccluded(t.unoccluded, leniency);
  }
}

void TreeSampler::ask_lattice(const TreeReceiver& r, Task& t) {
  Random random(hash_combine(r.stream, t.treated.source));
  t.first_ray = rays_.size();
  t.values.clear();
  for (int cell = 0; cell < ShadowPattern::cells; ++cell) {
    const Vec2 jitter = random.next_vec2();
    const uint64_t bit = uint64_t(1) << cell;
    if ((t.agreed.dark & bit) != 0) continue;
    const SourceCell c = pattern_cell(cell);
    const Vec2 uv{c.u0 + jitter.x * (c.u1 - c.u0), c.v0 + jitter.y * (c.v1 - c.v0)};
    TreeSourceSample s;
    if (!t.source->sample(scene_, uv, *r.vertex, *r.scattering, float(options_.tree.initial_rays),
                          s))
      continue;
    const Rgb value = s.value / float(ShadowPattern::cells);
    if ((t.agreed.lit & bit) != 0) {
      t.sum += value;
    } else {
      rays_.push_back(s.shadow_ray);
      t.values.push_back(value);
    }
  }
}

void TreeSampler::ask_single(const TreeReceiver& r, Task& t) {
  t.first_ray = rays_.size();
  t.values.clear();
  TreeSourceSample s;
  if (!t.source->sample(scene_, {0.5f, 0.5f}, *r.vertex, *r.scattering, 1, s)) return;
  rays_.push_back(s.shadow_ray);
  t.values.push_back(s.value);
}

void TreeSampler::answer_lattice(Task& t) {
  for (size_t i = 0; i < t.values.size(); ++i)
    if (is_occluded_[t.first_ray + i] == 0) t.sum += t.values[i] * factors_[t.first_ray + i];
}

// Returns true if the task asks for more rays.
bool TreeSampler::answer(Task& t) {
  if (t.entry == nullptr) {
    answer_lattice(t);
    return false;
  }
  for (size_t i = 0; i < t.results.size(); ++i)
    if (t.ray_of[i] >= 0) {
      const size_t ray = t.first_ray + size_t(t.ray_of[i]);
      t.results[i].is_visible = is_occluded_[ray] == 0;
      if (!factors_.values.empty()) t.results[i].kernel *= luminance(factors_[ray]);
    }
  Bintree& tree = t.entry->tree;
  tree.supply(t.results);
  const bool is_first = t.is_first_round;
  t.is_first_round = false;
  if (is_first && t.treated.source_class.treatment == SourceTreatment::probed) {
    // The result of the preprocessing is accepted unless a probe ray contradicts it.
    const ShadowFlag seen = tree.nodes()[BintreeNodes::root].flag;
    if (t.treated.source_class.view == SourceView::occluded && seen == ShadowFlag::shadow)
      return false;
    if (t.treated.source_class.view == SourceView::visible && seen == ShadowFlag::light &&
        t.has_exact) {
      t.takes_exact = true;
      return false;
    }
  }
  return !tree.pending().empty();
}

Rgb TreeSampler::light_of(const TreeReceiver& r, const Task& t) const {
  if (t.entry == nullptr) return t.sum;
  if (t.takes_exact) return t.exact;
  const Bintree& tree = t.entry->tree;
  // With panes, transmittance is known for visible rays only, so a ratio to the light without panes
  // is not possible.
  if (options_.uses_ratio && t.has_exact && !scene_.tracer.has_panes()) {
    const float all = tree.kernel_mean();
    return all > 0 ? t.exact * (tree.estimate().mean / all) : Rgb{0};
  }
  if (const float l = luminance(t.colour); l > 0)
    return t.colour * (tree.nodes()[BintreeNodes::root].mean / l);
  Rgb sum;
  tree.nodes().for_each_leaf([&](int32_t leaf) {
    const BintreeNode& n = tree.nodes()[leaf];
    TreeSourceSample s;
    if (n.is_visible && n.kernel > 0 &&
        t.source->sample(scene_, n.uv, *r.vertex, *r.scattering, float(options_.tree.initial_rays),
                         s))
      sum += s.value * (tree.nodes().cell(leaf).measure() *
                        (scene_.tracer.has_panes() ? n.kernel / luminance(s.value) : 1.0f));
  });
  return sum;
}

void TreeSampler::add_record(const TreeReceiver& r, const Task& t) const {
  if (t.is_single) return;  // a single ray has no pattern
  SourcePattern p;
  p.source = t.treated.source;
  if (t.entry == nullptr) {
    p.pattern = t.agreed;
    p.weight = luminance(t.has_exact ? t.exact : t.sum);
  } else {
    p.pattern = pattern_of(t.entry->tree.nodes());
    p.weight = t.unoccluded;
  }
  r.record->patterns.push_back(p);
}

}  // namespace troffer
