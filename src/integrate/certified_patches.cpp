#include "integrate/certified_patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/random.h"
#include "radiosity/source_contributions.h"

namespace troffer {

namespace {

// By how much larger the relative error of a patch's light may be than that of a light's: it is
// a small part of a pixel's light.
constexpr float looser = 8;
// Tells random numbers from those of lights.
constexpr uint32_t purpose_patches = 0x70617463;

// Patches of more pieces, each of which would be a source, stay in the general light. So do those
// nearer than their own length: what a hit gets from them would show their elements' edges.
constexpr uint32_t most_pieces_of_patch = 4;
constexpr float nearest = 1;

}  // namespace

SelectionOptions certified_selection(bool has_patches) {
  SelectionOptions o;
  o.is_enabled = has_patches;
  o.treats_all_lights = true;
  o.most_patch_pieces = most_pieces_of_patch;
  o.nearest_patch = nearest;
  return o;
}

// The error of n points, well spread, is about n^-3/4 times the standard deviation.
uint32_t PatchIntegrand::points_for(const Shooter& shooter) {
  if (shooter.share.empty()) return 0;
  double squares = 0, area = 0;
  for (size_t i = 0; i < shooter.share.size(); ++i) {
    squares += double(shooter.parts[i].area) * sqr(double(shooter.share[i]) - 1);
    area += double(shooter.parts[i].area);
  }
  const double deviation = std::sqrt(squares / area);
  constexpr double least_deviation = 0.03;
  if (deviation < least_deviation) return 0;
  return uint32_t(std::clamp(std::ceil(48 * std::pow(deviation, 4.0 / 3)), 4.0, 64.0));
}

void PatchIntegrand::evaluate(uint32_t request, uint32_t, std::span<const Vec3> points,
                              std::span<Rgb> values) {
  const PatchSource& source = *sources_[request];
  for (size_t i = 0; i < points.size(); ++i)
    values[i] = source.radiance * share_at(*source.shooter, points[i]);
}

CertifiedPatches::CertifiedPatches(const PreparedScene& scene, const RadiositySolution& solution,
                                   const SourceSelection& selection) {
  const auto patches = uint32_t(solution.mesh.patches.size());
  const auto lights = uint32_t(scene.scene.lights.size());
  std::vector<uint8_t> is_treated(patches, 0);
  for (uint32_t p = 0; p < patches; ++p)
    for (const TreatedSource& t : selection.of_patch(p))
      if (t.source >= lights) is_treated[t.source - lights] = 1;
  std::vector<std::array<uint32_t, 2>> pieces(patches);  // sources of each patch
  for (uint32_t p = 0; p < patches; ++p) {
    pieces[p][0] = uint32_t(sources_.size());
    if (is_treated[p] != 0) add_shooter(solution, p);
    pieces[p][1] = uint32_t(sources_.size());
  }
  first_.push_back(0);
  for (uint32_t p = 0; p < patches; ++p) {
    for (const TreatedSource& t : selection.of_patch(p)) {
      if (t.source < lights) continue;
      const auto [first, last] = pieces[t.source - lights];
      for (uint32_t i = first; i < last; ++i) lit_by_.push_back(i);
    }
    first_.push_back(lit_by_.size());
  }
}

void CertifiedPatches::add_shooter(const RadiositySolution& solution, uint32_t patch) {
  shooters_.push_back(std::make_unique<Shooter>(whole_patch_shooter(solution, patch)));
  const Shooter& shooter = *shooters_.back();
  const uint32_t points = PatchIntegrand::points_for(shooter);
  for (const LightPrimitive& piece : shooter.pieces) {
    PatchSource s;
    if (!make_flat_source(piece, false, s.flat)) continue;
    s.radiance = piece.mean_radiance;
    s.shooter = &shooter;
    s.points = points;
    s.stream = hash_of(purpose_patches, patch, uint64_t(&piece - shooter.pieces.data()));
    sources_.push_back(std::move(s));
  }
}

CertifiedOptions CertifiedPatches::options(const CertifiedOptions& of_lights) {
  CertifiedOptions o = of_lights;
  o.lattice = coarse_lattice;
  o.cells = CellLimits();
  o.residual_error *= looser;
  o.rays.pair_error *= looser;
  return o;
}

void CertifiedPatches::forget(CertifiedPatchesScratch& s) const {
  s.found.resize(sources_.size());
  for (const uint32_t i : s.touched) s.found[i] = {};
  s.touched.clear();
}

void CertifiedPatches::add(const Walk& walk, const Vertex& v, const Rgb& reflectance,
                           uint32_t patch, CertifiedPatchesScratch& s) const {
  if (is_empty() || sources_at(patch).empty() || reflectance.is_black()) return;
  s.hits.add_matte(walk, v, reflectance, false);
  s.patches.push_back(patch);
}

void CertifiedPatches::illuminate(CertifiedPatchesScratch& s, ShadowWorld& world,
                                  RadianceBatch& out, Counters& counters) const {
  s.order.resize(s.hits.size());
  std::iota(s.order.begin(), s.order.end(), 0u);
  std::sort(s.order.begin(), s.order.end(), [&](uint32_t a, uint32_t b) {
    return s.patches[a] != s.patches[b] ? s.patches[a] < s.patches[b] : a < b;
  });
  for (size_t first = 0, last = 0; first < s.order.size(); first = last) {
    const uint32_t patch = s.patches[s.order[first]];
    while (last < s.order.size() && s.patches[s.order[last]] == patch) ++last;
    illuminate_patch({s.order.data() + first, last - first}, s, world, out, counters);
  }
  s.hits.clear();
  s.patches.clear();
}

void CertifiedPatches::illuminate_patch(std::span<const uint32_t> hits, CertifiedPatchesScratch& s,
                                        ShadowWorld& world, RadianceBatch& out,
                                        Counters& counters) const {
  s.positions.clear();
  s.horizons.clear();
  for (const uint32_t h : hits) {
    s.positions.push_back(s.hits.positions[h]);
    s.horizons.push_back(s.hits.horizons[h]);
  }
  cluster_receivers(s.positions, s.horizons, std::numeric_limits<float>::infinity(), s.clusters);
  for (size_t c = 0; c < s.clusters.size(); ++c) {
    s.members.clear();
    s.cluster.receivers.clear();
    for (const uint32_t i : s.clusters.members(c)) {
      s.members.push_back(hits[i]);
      s.cluster.receivers.push_back(s.hits.receivers[hits[i]]);
    }
    illuminate_cluster(sources_at(s.patches[hits[0]]), s, world, out, counters);
  }
}

void CertifiedPatches::illuminate_cluster(std::span<const uint32_t> sources,
                                          CertifiedPatchesScratch& s, ShadowWorld& world,
                                          RadianceBatch& out, Counters& counters) const {
  s.cluster.shadow.set(s.cluster.receivers);
  s.cluster.requests.clear();
  s.integrand.sources().clear();
  for (const uint32_t i : sources) {
    const PatchSource& source = sources_[i];
    s.cluster.requests.push_back(
        {&source.flat, nullptr, source.stream, luminance(source.radiance), &s.found[i]});
    s.integrand.sources().push_back(&source);
    s.touched.push_back(i);
  }
  const auto add_answers = [&](uint32_t request, std::span<const SourceVisibility> answers) {
    const PatchSource& source = *s.integrand.sources()[request];
    for (size_t i = 0; i < s.members.size(); ++i) {
      const SourceVisibility& a = answers[i];
      if (a.answer == ShadowAnswer::below) continue;
      count_answer(a, counters);
      const uint32_t m = s.members[i], index = s.hits.indices[m];
      out.shadow_rays[index] += a.rays;
      if (a.answer == ShadowAnswer::dark) continue;
      const Rgb light = source.points > 0 ? a.value : source.radiance * (a.unoccluded * a.visible);
      out.add(index, false, s.hits.weights[m] * light, 0);
    }
  };
  certified_light(s.cluster.shadow, s.cluster.requests, &s.integrand, world, s.options,
                  s.cluster.memory, add_answers);
}

}  // namespace troffer
