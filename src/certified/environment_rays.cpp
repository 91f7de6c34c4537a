#include "certified/environment_rays.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "base/random.h"
#include "base/streams.h"
#include "certified/environment_sample_counts.h"

namespace troffer {

namespace {

constexpr size_t most_waiting_rays = 16384;
// Samples per hit at most where no pilot ray arrived: so little light cannot repay more.
constexpr double most_of_closed = 1;
// Factor on the number of samples for unordered visibility, like `clutter` in open_parts.cpp.
constexpr double clutter_of_rays = 2;
// Fewest samples per hit. A viewing ray costs about as much, and neighbouring hits differ by about
// as much (docs/log/certified-visibility.md, "Lights at infinity").
constexpr double least_of_sky = 8, least_of_sun = 4;
constexpr uint32_t most_few = 16;       // samples up to which precomputed chances are used
constexpr uint32_t fewest_points = 16;  // per hit where suns reduce the number

// Shadow rays of a cluster's members to the sky and images, or to one sun.
class Casting {
 public:
  Casting(const EnvironmentSamplerInputs& d, std::span<const uint32_t> members, EnvironmentRays& s,
          RadianceBatch& out, Counters& counters)
      : d_(d), members_(members), s_(s), out_(out), counters_(counters) {}

  // sun: index of a sun; -1: the sky and images. counts: which points of the pixel's sequence each
  // member gets, at most s_.numbers of them.
  void cast(int sun, EnvironmentSampleCounts& counts) {
    is_sun_ = sun >= 0;
    for (size_t i = 0; i < members_.size(); ++i) {
      if (counts.is_first_of_pixel(i)) {
        finish_pixel();
        counts.look_at_pixel(i);
      }
      uint32_t first = 0;
      const uint32_t n = std::min(counts.of(i, first), s_.numbers[i]);
      choose(sun, i, n, first);
    }
    finish_pixel();
    trace();
  }

  // Reduces the number of sky samples where suns and other sources have brought much light.
  void set_numbers(uint32_t usual, double open_sky) {
    for (size_t i = 0; i < members_.size(); ++i) {
      const Vec3& normal = d_.hits.receivers[members_[i]].normal;
      const double own = open_sky * double(d_.points.chances_about(normal).all());
      const double part = own > 0 ? own / (own + double(s_.arrived[i])) : 0;
      const double wanted = double(usual) * std::pow(part, 4.0 / 3);
      uint32_t n = usual;
      while (n > fewest_points && double(n / 2) >= wanted) n /= 2;
      s_.numbers[i] = n;
    }
  }

 private:
  void choose(int sun, size_t i, uint32_t n, uint32_t first) {
    const uint32_t m = members_[i];
    const EnvironmentSampler::Chances& chances = chances_of(i, n);
    if (!((sun < 0 ? chances.all() : chances.of_sun(size_t(sun))) > 0)) return;
    s_.streams.assign(
        n, hash_combine(d_.hits.draw_streams[m], stream::environment_rays + uint64_t(sun + 1)));
    s_.samples.resize(n);
    s_.uniform.resize(2 * size_t(n));
    for (uint32_t j = 0; j < n; ++j) s_.samples[j] = first + j;
    sobol_groups(s_.streams.data(), s_.samples.data(), n, 0, 2, s_.uniform.data());
    for (uint32_t j = 0; j < n; ++j) {
      const float u = s_.uniform[j], v = s_.uniform[n + j];
      EnvironmentSampler::Choice c =
          sun < 0 ? d_.points.choose(chances, u, v) : d_.points.choose_sun(size_t(sun), u, v);
      c.chance *= float(n);
      s_.choices.push_back(c);
      s_.of_choice.push_back(uint32_t(i));
    }
  }

  // Returns chances for the member's own normal, or precomputed ones if it has few samples and no
  // neighbour shares its normal.
  const EnvironmentSampler::Chances& chances_of(size_t i, uint32_t n) {
    const ShadowReceiver& r = d_.hits.receivers[members_[i]];
    const auto is_as_of = [&](size_t j) {
      const Vec3& other = d_.hits.receivers[members_[j]].normal;
      return other.x == r.normal.x && other.y == r.normal.y && other.z == r.normal.z;
    };
    const bool is_shared =
        (i > 0 && is_as_of(i - 1)) || (i + 1 < members_.size() && is_as_of(i + 1));
    if (n <= most_few && !is_shared) return d_.points.chances_about(r.normal);
    d_.points.set_chances(r, s_.chances);
    return s_.chances;
  }

  // Sorts samples by part, so that consecutive rays are nearly parallel.
  void sort() {
    const size_t n = s_.choices.size();
    s_.first.assign(d_.points.parts() + 1, 0);
    for (const EnvironmentSampler::Choice& c : s_.choices) ++s_.first[c.part + 1];
    for (size_t k = 1; k < s_.first.size(); ++k) s_.first[k] += s_.first[k - 1];
    s_.sorted.resize(n);
    s_.of_sorted.resize(n);
    for (size_t k = 0; k < n; ++k) {
      const uint32_t at = s_.first[s_.choices[k].part]++;
      s_.sorted[at] = s_.choices[k];
      s_.of_sorted[at] = s_.of_choice[k];
    }
  }

  // Turns the samples of a pixel into pending rays.
  void finish_pixel() {
    const size_t n = s_.choices.size();
    if (n == 0) return;
    sort();
    s_.points.resize(n);
    for (size_t k = 0; k < n; ++k)
      s_.points[k] =
          d_.points.point(s_.sorted[k], d_.hits.receivers[members_[s_.of_sorted[k]]].normal);
    d_.points.radiance(s_.points, s_.radiance);
    s_.runs.push_back(s_.terms.size());
    for (size_t k = 0; k < n; ++k) add(s_.of_sorted[k], s_.points[k], s_.radiance[k]);
    s_.choices.clear();
    s_.of_choice.clear();
    if (s_.rays.size() >= most_waiting_rays) trace();
  }

  void add(uint32_t i, const EnvironmentSampler::Point& p, const Rgb& radiance) {
    EnvironmentRays::Term& term = s_.terms.emplace_back();
    term.member = i;
    const uint32_t m = members_[i];
    const ShadowReceiver& r = d_.hits.receivers[m];
    if (p.source == nullptr || !is_above(r, p.wi)) return;
    if (!is_through_portal(d_.scene.primitives, *p.source, r.position, p.wi)) return;
    const int32_t g = d_.hits.glossy[m];
    const auto of_gloss = [&](const GlossyHit& hit) {
      return glossy_value(hit, p.wi, d_.competition.density(*p.source, hit.place, p.wi));
    };
    const Rgb value = g < 0 ? Rgb{dot(p.wi, r.normal)} : of_gloss(d_.hits.glossy_hits[size_t(g)]);
    term.light = d_.hits.weights[m] * radiance * value * p.inverse_pdf;
    if (term.light.is_black()) return;
    term.ray = int32_t(s_.rays.size());
    s_.rays.push_back(far_ray(r, p.wi));
  }

  void trace() {
    s_.is_occluded.resize(s_.rays.size());
    d_.scene.tracer.occluded(s_.rays, s_.is_occluded, Coherence::coherent, s_.factors);
    counters_.shadow_rays += s_.rays.size();
    for (size_t k = 0; k < s_.runs.size(); ++k) {
      const size_t last = k + 1 < s_.runs.size() ? s_.runs[k + 1] : s_.terms.size();
      tell(std::span(s_.terms).subspan(s_.runs[k], last - s_.runs[k]));
    }
    s_.terms.clear();
    s_.runs.clear();
    s_.rays.clear();
  }

  // Terms of a pixel, in the order of the parts. Their variance is estimated from differences of
  // neighbours. Hits with about equal numbers of samples share a chain, because they share a
  // sequence.
  struct Chain {
    float last = 0, squares = 0;
    uint32_t count = 0;
    float variance() const {
      const auto n = float(count);
      return count > 1 ? 0.5f * squares * n / (n - 1) : sqr(last);
    }
  };

  void tell(std::span<const EnvironmentRays::Term> run) {
    std::array<Chain, 33> chains{};
    for (const EnvironmentRays::Term& t : run) {
      const uint32_t m = members_[t.member], index = d_.hits.indices[m];
      const bool is_direct = d_.hits.is_direct[m] != 0;
      Rgb light;
      if (t.ray >= 0) {
        ++out_.shadow_rays[index];
        if (s_.is_occluded[size_t(t.ray)] == 0) light = t.light * s_.factors[size_t(t.ray)];
        out_.note_draw(is_direct, luminance(light));
      }
      if (!light.is_black()) out_.add(index, is_direct, light, 0);
      const float value = luminance(light);
      if (is_sun_) s_.arrived[t.member] += value / std::max(luminance(d_.hits.weights[m]), 1e-30f);
      if (!is_direct) continue;
      Chain& c = chain_of(t, chains);
      if (c.count++ > 0) c.squares += sqr(value - c.last);
      c.last = value;
    }
    if (out_.direct_variance.empty()) return;
    for (const EnvironmentRays::Term& t : run) {
      const uint32_t m = members_[t.member];
      if (d_.hits.is_direct[m] == 0) continue;
      const Chain& c = chain_of(t, chains);
      out_.direct_variance[d_.hits.indices[m]] += c.variance() / float(c.count);
    }
  }
  Chain& chain_of(const EnvironmentRays::Term& t, std::array<Chain, 33>& chains) const {
    return chains[size_t(std::bit_width(s_.numbers[t.member]))];
  }

  const EnvironmentSamplerInputs& d_;
  std::span<const uint32_t> members_;
  EnvironmentRays& s_;
  RadianceBatch& out_;
  Counters& counters_;
  bool is_sun_ = false;
};

// Mean light of the cluster's members, luminance × sr, from up to most_looks of them.
struct MeanEnvironmentLight {
  double sky = 0, suns = 0, others = 0;  // the first two unoccluded
};

MeanEnvironmentLight mean_light(const EnvironmentSamplerInputs& d,
                                std::span<const uint32_t> members, std::span<const float> seen) {
  constexpr size_t most_looks = 16;
  const size_t looks = std::min(members.size(), most_looks);
  MeanEnvironmentLight l;
  for (size_t k = 0; k < looks; ++k) {
    const size_t i = k * members.size() / looks;
    if (!seen.empty()) l.others += double(seen[i]) / double(looks);
    const EnvironmentSampler::Chances& chances =
        d.points.chances_about(d.hits.receivers[members[i]].normal);
    l.sky += double(chances.all()) / double(looks);
    l.suns += double(chances.suns()) / double(looks);
  }
  return l;
}

// Number of samples of a pixel, or of a point. N points of a sequence over light with standard
// deviation `spread` err by spread × N^-3/4.
double points_for(double spread, double allowed) {
  return std::max(allowed > 0 ? clutter_of_rays * std::pow(spread / allowed, 4.0 / 3) : 0.0, 1.0);
}

// Samples per pixel for each sun, and for the sky. The sky's error is relative to the sky's own
// light, or in pictures to the light of a typical pixel if that is more.
struct FarNumbers {
  double sun = 0, sky = 0;
};

FarNumbers numbers_for(const EnvironmentSamplerInputs& d, std::span<const uint32_t> members,
                       const MeanEnvironmentLight& light, const EnvironmentShare& share,
                       const DrawingBudget& budget) {
  // The viewing rays of a pixel differ in any case; their hits need not be known much better than
  // that.
  constexpr double most_viewing_rays = 4, part_of_rest = 0.05;
  const auto error = double(budget.error);
  const double left =
      part_of_rest *
      (share.spread_in_pixel * sqr(light.suns) + share.spread_of_sky_in_pixel * sqr(light.sky)) /
      (most_viewing_rays * double(budget.viewing_rays));
  const double sky = share.open_sky * light.sky;
  const double arrives = sky + share.open_sun * light.suns + light.others;
  const double typical = typical_light(d.hits, members, double(budget.typical));
  const auto allowed = [&](double of) {
    return std::sqrt(sqr(error * std::max(of, typical)) + left);
  };
  FarNumbers n;
  if (d.points.suns() > 0)
    n.sun = points_for(std::sqrt(share.spread_of_sun) * light.suns, allowed(arrives));
  n.sky = points_for(std::sqrt(share.open_sky * (1 - share.open_sky)) * light.sky, allowed(sky));
  return n;
}

}  // namespace

void cast_environment_rays(const EnvironmentSamplerInputs& d, std::span<const uint32_t> members,
                           const EnvironmentShare& share, std::span<const float> seen,
                           const DrawingBudget& budget, EnvironmentRays& s, RadianceBatch& out,
                           Counters& counters) {
  const FarNumbers wanted = numbers_for(d, members, mean_light(d, members, seen), share, budget);
  const double most = share.seems_closed ? most_of_closed * double(budget.viewing_rays) : 1e30;
  // Where the scene seems closed, all light that enters is left to a pixel's first rays, as if much
  // arrived.
  const double open = share.seems_closed ? 0.5 : share.open;
  counters.mixed += members.size();
  for (const uint32_t m : members)
    if (d.hits.is_first[m] != 0) out.sources[d.hits.indices[m]] += Rgb{1, 0, 0};
  Casting casting(d, members, s, out, counters);
  s.arrived.assign(members.size(), 0);
  if (!seen.empty()) s.arrived.assign(seen.begin(), seen.end());
  s.numbers.assign(members.size(), ~0u);
  EnvironmentSampleCounts of_sun(d.hits, members, budget, std::min(wanted.sun, most), open,
                                 share.seems_closed ? 0 : least_of_sun);
  for (size_t sun = 0; sun < d.points.suns(); ++sun) casting.cast(int(sun), of_sun);
  const double least = share.seems_closed ? 0 : least_of_sky;
  EnvironmentSampleCounts of_sky(d.hits, members, budget, std::min(wanted.sky, most), open, least);
  casting.set_numbers(of_sky.usual(), share.open_sky);
  casting.cast(-1, of_sky);
}

}  // namespace troffer
