#include "certified/environment_pilots.h"

#include <algorithm>

#include "base/random.h"
#include "base/streams.h"

namespace troffer {

namespace {

// Pilot rays of a batch to the sky; suns get half as many triples.
constexpr size_t pilots = 64;
// Further pilot rays if none arrives in a scene that seems shut out: one for every hits_of_pilot
// hits, at most most_pilots.
constexpr size_t hits_of_pilot = 2, most_pilots = 1024;
// Share of light that must arrive before clutter is tested. Below it, rays err by much and proofs
// may cost more.
constexpr double open_enough = 0.25;

// Pilot rays from hits towards environment lights.
class Pilots {
 public:
  explicit Pilots(const EnvironmentSamplerInputs& draws) : d_(draws) {}

  // Casts rays number `first` to `last` to skies and images. Of every four rays, two leave one hit,
  // a third leaves the next hit of its pixel, and the fourth leaves another hit.
  void look_at_sky(size_t first, size_t last) {
    begin();
    for (size_t k = first; k < last; ++k) {
      const size_t role = (k - first) % 4, with = role < 3 ? k - first - role : k - first;
      size_t i = index(with, last - first);
      if (role == 2 && has_next(i)) ++i;
      const ShadowReceiver& r = d_.hits.receivers[i];
      ray_of_.push_back(-1);
      const EnvironmentSampler::Chances& chances = d_.points.chances_about(r.normal);
      sums_.sky += double(chances.all());
      sums_.suns += double(chances.suns());
      if (!(chances.all() > 0)) continue;
      const uint64_t a = hash_of(r.stream, k, stream::environment_pilot);
      const EnvironmentSampler::Choice c =
          d_.points.choose(chances, unit_float(uint32_t(a)), unit_float(uint32_t(a >> 32)));
      const size_t before = weights_.size();
      add(r, c);
      if (weights_.size() > before) ray_of_.back() = int32_t(before);
    }
    trace();
    for (size_t k = 0; k < weights_.size(); ++k) {
      sums_.of_sky += double(weights_[k]);
      if (is_occluded_[k] == 0) sums_.open_sky += double(weights_[k]);
    }
    for (size_t k = 0; k + 3 < ray_of_.size(); k += 4) {
      const auto arrives = [&](size_t r) {
        return ray_of_[r] >= 0 && is_occluded_[size_t(ray_of_[r])] == 0
                   ? double(weights_[size_t(ray_of_[r])])
                   : 0.0;
      };
      sums_.sky_differs += sqr(arrives(k) - arrives(k + 1));
      sums_.sky_differs_in_pixel += sqr(arrives(k) - arrives(k + 2));
      ++sums_.sky_triples;
    }
    rays_ += weights_.size();
    sums_.sky_rays += double(weights_.size());
    note_hidden();
  }

  // Casts triples of rays to suns: two from one hit to the same sun, and one from the next hit of
  // its pixel.
  void look_at_suns(size_t first, size_t last) {
    begin();
    if (d_.points.suns() == 0) return;
    for (size_t k = first; k < last; ++k) {
      const size_t i = index(k - first, last - first);
      uint64_t random = hash_of(d_.hits.receivers[i].stream, k, stream::sun_pilot);
      const EnvironmentSampler::Chances& chances =
          d_.points.chances_about(d_.hits.receivers[i].normal);
      if (!(chances.suns() > 0)) continue;
      EnvironmentSampler::Choice c =
          d_.points.choose_any_sun(chances, 0, 0, unit_float(uint32_t(random)));
      for (const size_t from : {i, i, has_next(i) ? i + 1 : i}) {
        random = mix64(random);
        c.u = unit_float(uint32_t(random));
        c.v = unit_float(uint32_t(random >> 32));
        add_always(d_.hits.receivers[from], c);
      }
    }
    trace();
    for (size_t k = 0; k + 2 < weights_.size(); k += 3) {
      const auto arrives = [&](size_t r) { return weights_[r] > 0 && is_occluded_[r] == 0; };
      sums_.open_sun += arrives(k) ? 1 : 0;
      sums_.differ += arrives(k) != arrives(k + 1) ? 1 : 0;
      sums_.differ_in_pixel += arrives(k) != arrives(k + 2) ? 1 : 0;
      ++sums_.triples;
    }
    rays_ += weights_.size();
    note_hidden();
  }

  // True if the occluded rays met more than half as many different facets as there are rays.
  bool is_clutter() {
    constexpr size_t fewest = 3;  // fewer occluded rays do not suffice for a decision
    if (hidden_.size() < fewest) return false;
    std::vector<Hit> hits(hidden_.size());
    d_.scene.tracer.closest(hidden_, hits, Coherence::coherent, Meeting::no_panes);
    std::vector<uint32_t> facets;
    for (const Hit& h : hits)
      if (h.is_valid()) facets.push_back(d_.occluders.facet_of(h.geometry, h.primitive));
    std::sort(facets.begin(), facets.end());
    const auto end = std::unique(facets.begin(), facets.end());
    return 2 * size_t(end - facets.begin()) > hidden_.size();
  }

  bool has_arrived() const { return sums_.open_sky > 0 || sums_.open_sun > 0; }
  size_t rays() const { return rays_; }

  EnvironmentShare share() const {
    EnvironmentShare s;
    // Prior: one ray that arrived and one that did not.
    const double part = sums_.of_sky > 0 ? sums_.open_sky / sums_.of_sky : 0.5, n = sums_.sky_rays;
    s.open_sky = (part * n + 1) / (n + 2);
    s.open_sun = (sums_.open_sun + 1) / (sums_.triples + 2);
    s.spread_of_sun = 0.5 * (sums_.differ + 0.5) / (sums_.triples + 1);
    s.spread_in_pixel =
        sums_.triples > 0
            ? std::max(0.5 * (sums_.differ_in_pixel - sums_.differ) / sums_.triples, 0.0)
            : 0;
    // Relative to the unoccluded light.
    const double whole = n > 0 ? sums_.of_sky / n : 0;
    s.spread_of_sky_in_pixel =
        whole > 0 ? std::max(0.5 * (sums_.sky_differs_in_pixel - sums_.sky_differs), 0.0) /
                        (sums_.sky_triples * sqr(whole))
                  : 0;
    const double all = sums_.sky + sums_.suns;
    s.open = all > 0 ? (s.open_sky * sums_.sky + s.open_sun * sums_.suns) / all : 0.5;
    return s;
  }

 private:
  size_t index(size_t k, size_t of) const { return (2 * k + 1) * d_.hits.size() / (2 * of); }
  bool has_next(size_t i) const {
    return i + 1 < d_.hits.size() && d_.hits.pixels[i + 1] == d_.hits.pixels[i];
  }
  void begin() {
    rays_of_.clear();
    ray_of_.clear();
    weights_.clear();
    is_shown_.clear();
  }
  void add(const ShadowReceiver& r, const EnvironmentSampler::Choice& c) {
    const EnvironmentSampler::Point p = d_.points.point(c, r.normal);
    if (p.source == nullptr || !is_above(r, p.wi)) return;
    weights_.push_back(luminance(far_radiance_of(*p.source, p.way)) * dot(p.wi, r.normal) *
                       p.inverse_pdf);
    push(r, p);
  }
  // Adds a ray in any case; its weight is 0 below the horizon.
  void add_always(const ShadowReceiver& r, const EnvironmentSampler::Choice& c) {
    const EnvironmentSampler::Point p = d_.points.point(c, r.normal);
    weights_.push_back(is_above(r, p.wi) ? 1.0f : 0.0f);
    push(r, p);
  }
  void push(const ShadowReceiver& r, const EnvironmentSampler::Point& p) {
    rays_of_.push_back(far_ray(r, p.wi));
    const bool is_shown =
        p.source == nullptr || is_through_portal(d_.scene.primitives, *p.source, r.position, p.wi);
    is_shown_.push_back(is_shown ? 1 : 0);
  }
  void trace() {
    is_occluded_.resize(rays_of_.size());
    d_.scene.tracer.occluded(rays_of_, is_occluded_, Coherence::coherent);
    for (size_t k = 0; k < is_shown_.size(); ++k)
      if (is_shown_[k] == 0) is_occluded_[k] = 1;
  }

  void note_hidden() {
    for (size_t k = 0; k < rays_of_.size(); ++k)
      if (is_occluded_[k] != 0 && weights_[k] > 0) hidden_.push_back(rays_of_[k]);
  }

  const EnvironmentSamplerInputs& d_;
  std::vector<Ray> rays_of_, hidden_;
  std::vector<float> weights_;
  std::vector<int32_t> ray_of_;  // per pilot sample of the sky: its ray, or -1
  std::vector<uint8_t> is_occluded_, is_shown_;
  struct Sums {
    double sky = 0, suns = 0;  // unoccluded light, summed over receivers
    double of_sky = 0, open_sky = 0, sky_rays = 0;
    double sky_triples = 0, sky_differs = 0, sky_differs_in_pixel = 0;  // squared differences
    double triples = 0, open_sun = 0, differ = 0, differ_in_pixel = 0;
  } sums_;
  size_t rays_ = 0;
};

}  // namespace

EnvironmentShare estimate_environment_share(const EnvironmentSamplerInputs& d,
                                            bool seems_shut_out) {
  Pilots p(d);
  constexpr size_t fewest = 32;  // rays needed to conclude that the scene seems closed
  const size_t n = std::min(pilots, 4 * d.hits.size());
  p.look_at_sky(0, n);
  p.look_at_suns(0, n / 2);
  if (seems_shut_out && !p.has_arrived()) {
    const size_t most = std::clamp(d.hits.size() / hits_of_pilot, n, most_pilots);
    p.look_at_sky(n, most);
    p.look_at_suns(n / 2, n / 2 + (most - n) / 4);
  }
  EnvironmentShare share = p.share();
  share.seems_closed = seems_shut_out && !p.has_arrived() && p.rays() >= fewest;
  share.is_behind_clutter = share.open > open_enough && p.is_clutter();
  return share;
}

}  // namespace troffer
