#include "gather/lit_regions.h"

#include <algorithm>
#include <cmath>

#include "base/box.h"
#include "base/units.h"
#include "base/warp.h"

namespace troffer {

namespace {

constexpr double least_brightness = 2;  // threshold of a bright cell, over the mean
// Guiding pays only if the best possible share of rays towards bright cells would leave less than
// this part of the mean square.
constexpr double most_left = 0.6;
constexpr float first_radius = 2;  // of a region, in cells; it grows until most_places suffice
// Least sine of a cone's half angle; least distance of a place from a region's centre, in radii.
constexpr float least_sine = 0.02f, least_distance = 1.2f;
// Share of its cone that a region of mixed normals is taken to fill; least length of the mean
// normal of a region that counts as flat.
constexpr float unknown_fill = 0.5f, least_flat = 0.8f;
// Least visible share, since a few tests may miss what is seen; least share of rays for a cone.
constexpr float least_visible = 0.02f, least_share = 0.003f;
constexpr double most_correction = 16;  // limit of found over expected light, either way
constexpr size_t least_tries = 2;       // visibility tests of each region

struct BrightCell {
  Vec3 position, normal;
  double share = 0;       // share of pilot rays that meet it
  double irradiance = 0;  // mean irradiance that one of them brings
  const PilotHit* first = nullptr;
  uint32_t hits = 0;
};

struct Sphere {
  Vec3 centre;
  float radius = 0;
};

Sphere sphere_around(std::span<const BrightCell> cells, float margin) {
  Box box;
  for (const BrightCell& c : cells) box.grow(c.position);
  Sphere s{box.centre(), 0};
  for (const BrightCell& c : cells) s.radius = std::max(s.radius, length(c.position - s.centre));
  s.radius += margin;
  return s;
}

// Splits cells at the middle of the longest side of their box until every part is small enough.
void divide(std::span<BrightCell> cells, float margin, float most_radius,
            std::vector<std::span<BrightCell>>& out) {
  if (cells.size() < 2 || sphere_around(cells, margin).radius <= most_radius)
    return out.push_back(cells);
  Box box;
  for (const BrightCell& c : cells) box.grow(c.position);
  const Vec3 d = box.extent();
  const size_t axis = d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
  const float middle = box.centre()[axis];
  const auto half = std::stable_partition(
      cells.begin(), cells.end(), [&](const BrightCell& c) { return c.position[axis] < middle; });
  const auto first = size_t(half - cells.begin());
  if (first == 0 || first == cells.size()) return out.push_back(cells);
  divide(cells.first(first), margin, most_radius, out);
  divide(cells.subspan(first), margin, most_radius, out);
}

LitRegion place_of(std::span<const BrightCell> cells, float margin) {
  LitRegion p;
  const Sphere s = sphere_around(cells, margin);
  p.centre = s.centre;
  p.radius = s.radius;
  double share = 0, squares = 0;
  for (const BrightCell& c : cells) {
    share += c.share;
    squares += c.share * sqr(c.irradiance);
    p.normal += c.normal * float(c.share);
  }
  p.normal = p.normal * float(1 / share);
  p.mean_square = float(squares / share);
  return p;
}

LitRegionHits hits_of(std::span<const BrightCell> cells) {
  LitRegionHits h;
  const size_t step = std::max<size_t>(cells.size() / LitRegionHits::most, 1);
  for (size_t i = 0; i < cells.size() && h.count < LitRegionHits::most; i += step)
    h.hits[h.count++] = cells[i].first->hit;
  // Takes further hits of each cell if there are few cells.
  for (uint32_t k = 1; k < LitRegionHits::most && h.count < LitRegionHits::most; ++k)
    for (const BrightCell& c : cells)
      if (k < c.hits && h.count < LitRegionHits::most) h.hits[h.count++] = c.first[k].hit;
  return h;
}

// One region as a place sees it. Without initial values, because most elements of the array are
// never used.
struct Towards {
  uint32_t place;
  float height;     // 1 - cosine of the cone's half angle
  float by_cosine;  // share of cosine-distributed rays within the cone
  float expected;   // mean over those rays of the squared irradiance from the region
  float wanted;     // rays that the region deserves, not normalised
};

// Sets all of t except for `place`; false if the region is invisible from there, or too near.
bool look_towards(const LitRegion& p, float visible, const CellHit& at, Towards& t) {
  const Vec3 d = p.centre - at.position;
  const bool is_flat = length_squared(p.normal) >= sqr(least_flat);
  if (is_flat && dot(d, p.normal) >= 0) return false;
  const float distance = length(d);
  if (!(distance > least_distance * p.radius)) return false;
  const Vec3 axis = d * (1 / distance);
  const float sine = std::max(p.radius / distance, least_sine), height = dot(axis, at.normal);
  if (height <= -sine) return false;
  // Mean cosine over the cone, approximated where the horizon cuts through it.
  const float mean_cosine = height >= sine ? height : sqr(height + sine) / (4 * sine);
  const float fill = is_flat ? std::max(-dot(axis, p.normal), 0.0f) : unknown_fill;
  t.height = sqr(sine) / (1 + std::sqrt(1 - sqr(sine)));
  t.by_cosine = std::min(2 * t.height * mean_cosine, 1.0f);
  const float mean_square = p.mean_square * fill * visible;
  t.expected = t.by_cosine * mean_square;
  t.wanted = t.by_cosine * std::sqrt(mean_square);
  return true;
}

}  // namespace

LitRegions::LitRegions(const Tracer& tracer, std::vector<PilotHit> seen,
                       std::span<const Rgb> irradiance, float cell_size)
    : tracer_(&tracer) {
  std::stable_sort(seen.begin(), seen.end(),
                   [](const PilotHit& a, const PilotHit& b) { return a.cell < b.cell; });
  std::vector<BrightCell> cells;
  double shares = 0, sum = 0, squares = 0;
  for (size_t i = 0; i < seen.size();) {
    BrightCell& c = cells.emplace_back();
    c.first = &seen[i];
    const double e = double(luminance(irradiance[seen[i].cell]));
    double brought = 0;
    for (; i < seen.size() && seen[i].cell == c.first->cell; ++i, ++c.hits) {
      c.share += double(seen[i].share);
      brought += double(seen[i].share) * double(seen[i].weight) * e;
      c.position += seen[i].hit.position * seen[i].share;
      c.normal += seen[i].hit.horizon * seen[i].share;
    }
    if (!(c.share > 0)) {
      cells.pop_back();
      continue;
    }
    c.position = c.position * float(1 / c.share);
    c.normal = c.normal * float(1 / c.share);
    c.irradiance = brought / c.share;
    shares += c.share;
    sum += brought;
    squares += brought * c.irradiance;
  }
  if (!(shares > 0)) return;
  const double mean = sum / shares;
  std::erase_if(cells,
                [&](const BrightCell& c) { return !(c.irradiance > least_brightness * mean); });
  double bright = 0, bright_shares = 0;
  for (const BrightCell& c : cells) {
    bright += c.share * sqr(c.irradiance);
    bright_shares += c.share;
  }
  const double left = std::max(squares - bright, 0.0), left_shares = shares - bright_shares;
  const double best = sqr(std::sqrt(bright * bright_shares) + std::sqrt(left * left_shares));
  if (!(best < most_left * squares * shares)) return;
  rest_ = float(left / shares);
  const float margin = 0.5f * cell_size;
  std::vector<std::span<BrightCell>> parts;
  for (float radius = first_radius * cell_size; parts.empty() || parts.size() > most_places;
       radius *= 1.5f) {
    parts.clear();
    divide(cells, margin, radius, parts);
  }
  for (const std::span<BrightCell> part : parts) {
    places_.push_back(place_of(part, margin));
    hits_.push_back(hits_of(part));
  }
}

RegionVisibility LitRegions::visibility_from(std::span<const CellHit> from, size_t rays) const {
  RegionVisibility sight{std::vector<float>(places_.size(), 1), rest_};
  if (places_.empty() || from.empty()) return sight;
  const size_t tried = std::clamp(rays / places_.size(), least_tries, size_t{LitRegionHits::most});
  std::vector<Ray> towards;
  for (const LitRegionHits& h : hits_)
    for (size_t i = 0; i < tried; ++i) {
      const CellHit &a = from[i * from.size() / tried], &b = h.hits[i % h.count];
      towards.push_back(
          segment(a.position + a.horizon * a.offset, b.position + b.horizon * b.offset));
    }
  std::vector<uint8_t> is_occluded(towards.size());
  tracer_->occluded(towards, is_occluded);
  for (size_t k = 0; k < places_.size(); ++k) {
    const auto first = is_occluded.begin() + std::ptrdiff_t(k * tried);
    const auto seen = std::count(first, first + std::ptrdiff_t(tried), 0);
    sight.visible[k] = std::max(float(seen) / float(tried), least_visible);
  }
  return sight;
}

GatherDistribution::GatherDistribution(const LitRegions& places, std::span<const float> visible,
                                       float rest, const CellHit& at) {
  if (places.all().empty()) return;
  std::array<Towards, LitRegions::most_places> towards;
  size_t count = 0;
  const float others = std::sqrt(rest);
  float all = others;
  for (uint32_t k = 0; k < places.all().size(); ++k) {
    if (!look_towards(places.all()[k], visible[k], at, towards[count])) continue;
    towards[count].place = k;
    all += towards[count++].wanted;
  }
  if (!(all > 0)) return;
  const auto share_of = [&](const Towards& t) {
    const float share = (t.wanted - others * t.by_cosine) / all;
    return share > least_share ? share : 0;
  };
  float sum = 0;
  for (size_t i = 0; i < count; ++i) sum += share_of(towards[i]);
  const float scale = sum > 1 - least_by_cosine ? (1 - least_by_cosine) / sum : 1;
  for (size_t i = 0; i < count; ++i) {
    const Towards& t = towards[i];
    const float share = share_of(t) * scale;
    if (share == 0) continue;
    const Vec3 axis = normalize(places.all()[t.place].centre - at.position);
    cones_.push_back({Frame(axis), t.height, share, share / (2 * pi_f * t.height)});
    by_cosine_ -= share;
    expected_ += t.expected;
  }
}

float GatherDistribution::density_towards(const Vec3& direction) const {
  float density = 0;
  for (const Cone& c : cones_)
    if (length_squared(direction - c.frame.normal) <= 2 * c.height) density += c.density;
  return density;
}

float GatherDistribution::density(const CellHit& at, const Vec3& direction) const {
  return by_cosine_ * std::max(dot(direction, at.normal), 0.0f) * inv_pi_f +
         density_towards(direction);
}

Vec3 GatherDistribution::direction(const CellHit& at, Vec2 number, float& weight) const {
  const Frame frame(at.normal);
  weight = 1;
  if (cones_.empty()) return frame.to_world(cosine_hemisphere_from_square(number));
  Vec3 world;
  if (number.x < by_cosine_) {
    number.x = std::min(number.x / by_cosine_, one_minus_epsilon);
    world = frame.to_world(cosine_hemisphere_from_square(number));
  } else {
    float left = number.x - by_cosine_;
    size_t k = 0;
    while (k + 1 < cones_.size() && left >= cones_[k].share) left -= cones_[k++].share;
    const Cone& c = cones_[k];
    const Vec2 d =
        disk_from_square(Vec2{std::clamp(left / c.share, 0.0f, one_minus_epsilon), number.y});
    const float below = (sqr(d.x) + sqr(d.y)) * c.height;  // 1 - cosine to the cone's axis
    const float scale = std::sqrt(c.height * (2 - below));
    world = c.frame.to_world({d.x * scale, d.y * scale, 1 - below});
  }
  const float by_cosine = std::max(dot(world, at.normal), 0.0f) * inv_pi_f;
  weight = by_cosine > 0 ? by_cosine / density(at, world) : 0;
  return world;
}

void GuidingStatistics::add(const GatherDistribution& aim, const Vec3& direction, float weight,
                            float irradiance) {
  expected_ += double(aim.expected());
  if (!(weight > 0)) return;
  const double square = sqr(double(irradiance)) / double(weight);
  if (aim.is_towards_bright(direction)) {
    bright_ += square;
  } else {
    rest_ += square;
    rest_rays_ += double(weight);
  }
}

void GuidingStatistics::tell(RegionVisibility& sight) const {
  if (rest_rays_ > 0) sight.rest = float(rest_ / rest_rays_);
  if (!(expected_ > 0)) return;
  const auto scale = float(std::clamp(bright_ / expected_, 1 / most_correction, most_correction));
  for (float& v : sight.visible) v *= scale;
}

}  // namespace troffer
