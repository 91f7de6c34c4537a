#include "kj92/source_selection.h"

#include <algorithm>

#include "radiosity/interpolation.h"
#include "radiosity/source_contributions.h"

namespace troffer {

namespace {

// A side of a fragment that belongs to a patch.
struct FragmentSide {
  uint32_t fragment;
  uint32_t side;
};

// Sides of fragments, grouped by patch.
struct PatchFragments {
  std::vector<size_t> first;
  std::vector<FragmentSide> sides;

  explicit PatchFragments(const RadiosityMesh& mesh) : first(mesh.patches.size() + 1, 0) {
    for_each(mesh, [&](uint32_t patch, FragmentSide) { ++first[patch + 1]; });
    for (size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
    sides.resize(first.back());
    std::vector<size_t> next(first.begin(), first.end() - 1);
    for_each(mesh, [&](uint32_t patch, FragmentSide s) { sides[next[patch]++] = s; });
  }

  template <class Visit>
  static void for_each(const RadiosityMesh& mesh, Visit&& visit) {
    for (uint32_t f = 0; f < mesh.fragments.size(); ++f)
      for (uint32_t side = 0; side < 2; ++side) {
        const uint32_t point = mesh.element_points[mesh.fragments[f].element][side];
        if (point != no_point) visit(mesh.points[point].patch, FragmentSide{f, side});
      }
  }
};

Rgb least(Rgb a, Rgb b) {
  return {std::min(a.r, b.r), std::min(a.g, b.g), std::min(a.b, b.b)};
}
Rgb without(Rgb a, Rgb b) {  // clamped at 0 against rounding
  return {std::max(a.r - b.r, 0.0f), std::max(a.g - b.g, 0.0f), std::max(a.b - b.b, 0.0f)};
}

// Selects the sources of one patch; its members are reused from patch to patch.
class PatchSelector {
 public:
  PatchSelector(const RadiositySolution& solution, const Tracer& tracer,
                const LightPrimitives& primitives, const SelectionOptions& options)
      : solution_(solution), tracer_(tracer), lights_(primitives), options_(options) {}

  void run(uint32_t patch, std::span<const FragmentSide> sides, std::vector<TreatedSource>& treated,
           std::vector<GeneralIrradiance>& knots) {
    treated.clear();
    gather_points(sides);
    if (!options_.is_enabled) {
      treat_all_lights(treated);
    } else {
      treat_lights_without_surface(treated);
      find_candidates(patch);
      for (const uint32_t source : candidates_) consider(source, treated);
    }
    std::sort(treated.begin(), treated.end(),
              [](const TreatedSource& a, const TreatedSource& b) { return a.source < b.source; });
    for (const FragmentSide& s : sides) fill_knots(s, knots);
  }

 private:
  // Collects the points that interpolation on the patch uses, sorted, and sets their general
  // radiosity to the total.
  void gather_points(std::span<const FragmentSide> sides) {
    points_.ids.clear();
    for (const FragmentSide& s : sides)
      for (size_t k = 0; k < knots_per_fragment; ++k) {
        interpolate_at_knot(solution_.mesh, s.fragment, k, s.side == 1, at_);
        for (const PointWeight& w : at_.weights()) points_.ids.push_back(w.point);
      }
    std::sort(points_.ids.begin(), points_.ids.end());
    points_.ids.erase(std::unique(points_.ids.begin(), points_.ids.end()), points_.ids.end());
    points_.general.resize(points_.ids.size());
    points_.totals.resize(points_.ids.size());
    points_.mean_total = 0;
    for (size_t i = 0; i < points_.ids.size(); ++i) {
      const uint32_t p = points_.ids[i];
      GeneralIrradiance& g = points_.general[i];
      g.direct = solution_.general_direct[p];
      g.indirect = without(solution_.general[p], g.direct);
      for (const StoredContribution& c : solution_.contributions(p)) {
        if (c.source == no_source) continue;
        (solution_.is_light(c.source) ? g.direct : g.indirect) += c.received;
      }
      points_.totals[i] = luminance(g.direct + g.indirect);
      // Unshot light may come from everywhere, but not to points that get no other light.
      if (points_.totals[i] > 0) g.indirect += solution_.ambient;
      points_.mean_total += points_.totals[i] / float(points_.ids.size());
    }
  }

  bool is_allowed(uint32_t source) const {
    const bool is_light = solution_.is_light(source);
    if (!options_.is_restricted) return is_light || options_.uses_patches;
    return std::find(options_.only.begin(), options_.only.end(), source) != options_.only.end();
  }

  // Collects the sources that any of the points keeps and that come near a threshold there.
  void find_candidates(uint32_t patch) {
    const SelectionThresholds& t = options_.thresholds;
    const float near = 0.5f * std::min({t.major_share, t.shadow_edge, t.probe_share});
    candidates_.clear();
    for (size_t i = 0; i < points_.ids.size(); ++i) {
      const float whole = std::max(points_.totals[i], points_.mean_total);
      for (const StoredContribution& c : solution_.contributions(points_.ids[i])) {
        if (c.source == no_source || !is_allowed(c.source)) continue;
        if (!solution_.is_light(c.source)) {
          // A patch counts only where it is partly hidden; elsewhere interpolation is as good.
          if (solution_.patch_of(c.source) == patch) continue;
          if (luminance(c.received) >= t.visible_above * luminance(c.unoccluded)) continue;
        }
        if (luminance(c.unoccluded) >= near * whole) candidates_.push_back(c.source);
      }
    }
    std::sort(candidates_.begin(), candidates_.end());
    candidates_.erase(std::unique(candidates_.begin(), candidates_.end()), candidates_.end());
  }

  // Sets what the source gives to each point: the stored contribution, or a new computation.
  void look_up(uint32_t source) {
    received_.assign(points_.ids.size(), {});
    lookup_.missing.clear();
    lookup_.points.clear();
    for (size_t i = 0; i < points_.ids.size(); ++i) {
      bool is_kept = false;
      for (const StoredContribution& c : solution_.contributions(points_.ids[i]))
        if (c.source == source) {
          received_[i] = c;
          is_kept = true;
        }
      if (is_kept) continue;
      lookup_.missing.push_back(i);
      lookup_.points.push_back(points_.ids[i]);
    }
    if (lookup_.missing.empty()) return;
    lookup_.completed.resize(lookup_.missing.size());
    source_contributions(tracer_, lights_, solution_, source, lookup_.points, lookup_.completed,
                         lookup_.scratch);
    for (size_t k = 0; k < lookup_.missing.size(); ++k)
      received_[lookup_.missing[k]] = lookup_.completed[k];
  }

  void consider(uint32_t source, std::vector<TreatedSource>& treated) {
    look_up(source);
    at_points_.clear();
    for (size_t i = 0; i < points_.ids.size(); ++i)
      at_points_.push_back({luminance(received_[i].received), luminance(received_[i].unoccluded),
                            points_.totals[i]});
    const SourceClass c = classify(at_points_, points_.mean_total, options_.thresholds);
    const bool is_treated = solution_.is_light(source) ? c.treatment != SourceTreatment::general
                                                       : c.treatment == SourceTreatment::sampled;
    if (!is_treated) return;
    treated.push_back({source, c});
    for (size_t i = 0; i < points_.ids.size(); ++i) {
      Rgb& general =
          solution_.is_light(source) ? points_.general[i].direct : points_.general[i].indirect;
      general = without(general, least(received_[i].received, general));
    }
  }

  bool is_without_surface(uint32_t light) const {
    const LightPrimitives::Range pieces = lights_.of_light(light);
    return pieces.first != pieces.last && !lights_[pieces.first].has_surface();
  }

  bool is_asked_for(uint32_t light) const {
    return !options_.is_restricted || is_without_surface(light) ||
           std::find(options_.only.begin(), options_.only.end(), light) != options_.only.end();
  }

  // Adds the lights without surface, which the radiosity solution does not contain.
  void treat_lights_without_surface(std::vector<TreatedSource>& treated) const {
    for (uint32_t e = 0; e < solution_.light_count; ++e)
      if (is_without_surface(e))
        treated.push_back({e, {SourceView::partly, SourceTreatment::sampled, 0, 1, 1}});
  }

  void treat_all_lights(std::vector<TreatedSource>& treated) {
    for (uint32_t e = 0; e < solution_.light_count; ++e)
      if (is_asked_for(e))
        treated.push_back({e, {SourceView::partly, SourceTreatment::sampled, 0, 1, 1}});
    if (!options_.is_restricted) {
      for (GeneralIrradiance& g : points_.general) g.direct = Rgb{0};
      return;
    }
    for (const TreatedSource& t : treated) {
      look_up(t.source);
      for (size_t i = 0; i < points_.ids.size(); ++i)
        points_.general[i].direct = without(points_.general[i].direct, received_[i].received);
    }
  }

  void fill_knots(const FragmentSide& s, std::vector<GeneralIrradiance>& knots) {
    for (size_t k = 0; k < knots_per_fragment; ++k) {
      interpolate_at_knot(solution_.mesh, s.fragment, k, s.side == 1, at_);
      GeneralIrradiance sum;
      for (const PointWeight& w : at_.weights()) {
        const auto it = std::lower_bound(points_.ids.begin(), points_.ids.end(), w.point);
        const GeneralIrradiance& g = points_.general[size_t(it - points_.ids.begin())];
        sum.direct += g.direct * w.weight;
        sum.indirect += g.indirect * w.weight;
      }
      knots[knots_per_fragment * (2 * size_t(s.fragment) + s.side) + k] = sum;
    }
  }

  const RadiositySolution& solution_;
  const Tracer& tracer_;
  const LightPrimitives& lights_;
  const SelectionOptions& options_;

  Interpolation at_;
  struct Points {  // sample points of the patch
    std::vector<uint32_t> ids;
    std::vector<GeneralIrradiance> general;  // not accounted for by treated sources
    std::vector<float> totals;
    float mean_total = 0;
  } points_;
  std::vector<uint32_t> candidates_;
  std::vector<StoredContribution> received_;
  std::vector<SourceAtPoint> at_points_;
  struct Lookup {  // working memory of look_up
    std::vector<size_t> missing;
    std::vector<uint32_t> points;
    std::vector<StoredContribution> completed;
    TransferScratch scratch;
  } lookup_;
};

}  // namespace

SourceSelection::SourceSelection(const RadiositySolution& solution, const Tracer& tracer,
                                 const LightPrimitives& primitives, const SelectionOptions& options,
                                 int threads, const StopFlag& stop) {
  const RadiosityMesh& mesh = solution.mesh;
  const PatchFragments fragments(mesh);
  const size_t patches = mesh.patches.size();
  knots_.assign(2 * knots_per_fragment * mesh.fragments.size(), {});
  std::vector<std::vector<TreatedSource>> treated(patches);
  std::vector<PatchSelector> selectors(size_t(thread_count(threads)),
                                       PatchSelector(solution, tracer, primitives, options));
  parallel_for_slots(patches, threads, [&](size_t patch, size_t slot) {
    if (stop.load(std::memory_order_relaxed)) return;
    const std::span sides(fragments.sides.data() + fragments.first[patch],
                          fragments.first[patch + 1] - fragments.first[patch]);
    selectors[slot].run(uint32_t(patch), sides, treated[patch], knots_);
  });
  first_.push_back(0);
  for (const auto& list : treated) {
    sources_.insert(sources_.end(), list.begin(), list.end());
    first_.push_back(sources_.size());
  }
}

size_t SourceSelection::memory_bytes() const {
  return sources_.capacity() * sizeof(TreatedSource) + first_.capacity() * sizeof(size_t) +
         knots_.capacity() * sizeof(GeneralIrradiance);
}

}  // namespace troffer
