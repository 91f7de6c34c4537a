#include "bake/cut_off.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "base/frame.h"
#include "base/random.h"
#include "base/streams.h"
#include "base/warp.h"
#include "render/cell_pilot.h"
#include "trace/surface.h"
#include "transport/prepared_scene.h"
#include "transport/purposes.h"

namespace troffer {

namespace {

constexpr float darkest = 0.01f;   // relative to the light next to it: dark up to here
constexpr float faint = 0.05f;     // the same, where the place is enclosed
constexpr float lit = 0.1f;        // relative to the brightest samples: lit from here on
constexpr size_t most_tested = 6;  // lit places that each dark one is tested against

// True if a segment slightly above the surface can test the pair. Curved surfaces would hide
// themselves.
bool can_be_tested(const LitPlace& a, const LitPlace& b, float offset) {
  return dot(a.normal, b.normal) > 0.999f && length(a.position - b.position) > 16 * offset;
}

Ray between(const LitPlace& a, const LitPlace& b, float offset) {
  const float height = std::max(4 * offset, 0.01f * length(a.position - b.position));
  return segment(a.position + a.normal * height, b.position + b.normal * height);
}

// Returns the mean light of the brightest quarter.
float bright_light(std::span<const LitPlace> samples) {
  std::vector<float> light;
  for (const LitPlace& s : samples) light.push_back(s.light);
  std::sort(light.begin(), light.end(), std::greater<>());
  const size_t n = std::max<size_t>(light.size() / 4, 1);
  float sum = 0;
  for (size_t i = 0; i < n && i < light.size(); ++i) sum += light[i];
  return sum / float(n);
}

// Returns the nearest lit places and a selection of the others.
std::vector<uint32_t> tested_with(const LitPlace& dark, std::span<const LitPlace> samples,
                                  std::vector<uint32_t> lit_ones) {
  const auto distance = [&](uint32_t i) { return length(samples[i].position - dark.position); };
  const size_t near = std::min(most_tested / 2, lit_ones.size());
  std::partial_sort(lit_ones.begin(), lit_ones.begin() + std::ptrdiff_t(near), lit_ones.end(),
                    [&](uint32_t a, uint32_t b) { return distance(a) < distance(b); });
  std::vector<uint32_t> out(lit_ones.begin(), lit_ones.begin() + std::ptrdiff_t(near));
  const size_t step = std::max<size_t>((lit_ones.size() - near) / (most_tested / 2), 1);
  for (size_t i = near; i < lit_ones.size() && out.size() < most_tested; i += step)
    out.push_back(lit_ones[i]);
  return out;
}

// Finds texels by their place on the pages.
class TexelMap {
 public:
  TexelMap(const TexelSites& sites, const Atlas& atlas) : sites_(sites), atlas_(atlas) {
    for (uint32_t i = 0; i < sites.texels().size(); ++i) {
      const TexelSites::Texel& t = sites.texels()[i];
      number_[key(t.stand, t.x, t.y)] = i;
    }
  }
  // Returns the neighbours in the same chart.
  void neighbours(size_t site, std::vector<uint32_t>& out) const {
    out.clear();
    const TexelSites::Texel& t = sites_.texels()[site];
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const auto found = number_.find(key(t.stand, t.x + dx, t.y + dy));
        if ((dx != 0 || dy != 0) && found != number_.end() &&
            sites_.texels()[found->second].chart == t.chart)
          out.push_back(found->second);
      }
  }

 private:
  const TexelSites& sites_;
  const Atlas& atlas_;
  std::unordered_map<uint64_t, uint32_t> number_;

  uint64_t key(uint32_t stand, int x, int y) const {
    return (uint64_t(uint32_t(atlas_.page[stand])) << 32 | uint64_t(uint16_t(y)) << 16) |
           uint64_t(uint16_t(x));
  }
};

}  // namespace

bool is_enclosed(const PreparedScene& scene, const LitPlace& place, float offset, float diagonal) {
  constexpr uint32_t looks = 16;
  constexpr float near = 0.1f, metre = 1;  // near: share of the scene's diagonal; metre: m
  const float limit = std::min(near * diagonal, metre);
  std::vector<Ray> rays;
  std::vector<Hit> hits(looks);
  const Frame frame(place.normal);
  for (uint32_t k = 0; k < looks; ++k) {
    Ray ray;
    ray.origin = place.position + place.normal * offset;
    ray.direction = frame.to_world(cosine_hemisphere_from_square(
        SobolGroup(hash_of(stream::cut_off_texels), purpose_camera, k).get2(0)));
    rays.push_back(ray);
  }
  scene.tracer.closest(rays, hits);
  const auto close = std::count_if(hits.begin(), hits.end(),
                                   [&](const Hit& h) { return h.is_valid() && h.t <= limit; });
  return 2 * uint32_t(close) >= looks;
}

namespace {

// True if a place is dark relative to the light beside it. Inside walls and furniture a little
// light arrives through gaps and large cells, so enclosed places have a higher limit. A place that
// is as dark but open belongs to a dark room, and counts.
bool is_dark(const PreparedScene& scene, const LitPlace& place, float beside, float offset,
             float diagonal) {
  if (place.light <= darkest * beside) return true;
  return place.light <= faint * beside && is_enclosed(scene, place, offset, diagonal);
}

}  // namespace

std::vector<uint8_t> cut_off_samples(const PreparedScene& scene, std::span<const LitPlace> samples,
                                     float offset, float diagonal) {
  std::vector<uint8_t> is_cut_off(samples.size(), 0);
  if (samples.empty()) return is_cut_off;
  const float bright = bright_light(samples);
  std::vector<uint32_t> dark_ones, lit_ones;
  for (uint32_t i = 0; i < samples.size(); ++i) {
    if (is_dark(scene, samples[i], bright, offset, diagonal)) dark_ones.push_back(i);
    if (samples[i].light >= lit * bright) lit_ones.push_back(i);
  }
  if (!(bright > 0) || dark_ones.empty() || lit_ones.empty()) return is_cut_off;
  std::vector<Ray> rays;
  std::vector<uint8_t> is_hidden;
  for (const uint32_t i : dark_ones) {
    rays.clear();
    bool is_plain = true;
    for (const uint32_t k : tested_with(samples[i], samples, lit_ones)) {
      is_plain = is_plain && can_be_tested(samples[i], samples[k], offset);
      rays.push_back(between(samples[i], samples[k], offset));
    }
    if (!is_plain) continue;
    is_hidden.assign(rays.size(), 0);
    scene.tracer.occluded(rays, is_hidden);
    is_cut_off[i] = std::all_of(is_hidden.begin(), is_hidden.end(), [](uint8_t h) { return h; });
  }
  return is_cut_off;
}

void forget_cut_off_texels(const PreparedScene& scene, const TexelSites& sites, const Atlas& atlas,
                           std::vector<SiteLight>& light) {
  const TexelMap map(sites, atlas);
  std::vector<uint32_t> around, first, second;
  const auto place = [&](size_t i) {
    return LitPlace{light[i].place, light[i].normal, luminance(light[i].irradiance)};
  };
  const Box box = bounds(scene.scene);
  enum class Beside : uint8_t { nothing_lit, lit, cut_off };
  const auto beside = [&](size_t i) {
    Beside found = Beside::nothing_lit;
    const LitPlace own = place(i);
    map.neighbours(i, around);
    for (const uint32_t n : around) {
      const LitPlace other = place(n);
      if (!light[n].is_known || !(other.light > 0)) continue;
      const float offset = offset_of_point(own.position, box);
      if (!is_dark(scene, own, other.light, offset, box.diagonal())) continue;
      const std::array<Ray, 1> ray{between(own, other, offset)};
      std::array<uint8_t, 1> is_hidden{};
      if (can_be_tested(own, other, offset)) scene.tracer.occluded(ray, is_hidden);
      if (!is_hidden[0]) return Beside::lit;
      found = Beside::cut_off;
    }
    return found;
  };
  std::vector<float> limit(light.size(), 0);
  for (uint32_t i = 0; i < light.size(); ++i) {
    if (!light[i].is_known || beside(i) != Beside::cut_off) continue;
    for (const uint32_t n : around)
      if (light[n].is_known) limit[i] = std::max(limit[i], luminance(light[n].irradiance));
    first.push_back(i);
  }
  // Dark texels behind them go, too: otherwise they would darken the values that fill the gap.
  std::vector<uint32_t> behind;
  for (const uint32_t i : first) {
    map.neighbours(i, behind);
    for (const uint32_t n : behind)
      if (light[n].is_known &&
          is_dark(scene, place(n), limit[i], offset_of_point(light[n].place, box),
                  box.diagonal()) &&
          beside(n) == Beside::nothing_lit)
        second.push_back(n);
  }
  for (const uint32_t i : first) light[i].is_known = false;
  for (const uint32_t i : second) light[i].is_known = false;
}

}  // namespace troffer
