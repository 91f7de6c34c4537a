#include "report/glare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/random.h"
#include "base/units.h"
#include "light/light.h"
#include "report/luminaire_parts.h"
#include "trace/surface.h"

namespace troffer {

namespace {

constexpr double least_area = 0.005;         // m² [2]
constexpr double most_solid_angle = 0.1;     // sr [1]
constexpr double highest = 1.9, widest = 3;  // limits of CIE 117's table: height, sideways distance
constexpr size_t replicates = 4;

// Guth's position index at and above the line of sight [3]. tau: angle from the vertical; sigma:
// angle from the line of sight; both in degrees.
double index_above(double tau, double sigma) {
  const double a = 35.2 - 0.31889 * tau - 1.22 * std::exp(-2 * tau / 9);
  const double b = 21 + 0.26667 * tau - 0.002963 * tau * tau;
  return std::exp(a * 1e-3 * sigma + b * 1e-5 * sigma * sigma);
}

double index_below(double off_axis) {  // Position index below the line of sight [4]. off_axis:
                                       // distance from the axis over the distance ahead.
  return 1 + (off_axis < 0.6 ? 0.8 : 1.2) * off_axis;
}

// Sums over the visible part of a luminaire, or of one connected part of it.
struct Sums {
  double solid_angle = 0, illuminance = 0;  // ∫dω, ∫L dω
  double area = 0;                          // ∫r² dω, m²
  double point_strength = 0;                // Σ I² / (least_area r²) of point lights
  Vec3d direction;                          // ∫ω dω, or the direction of the point
  Sums& operator+=(const Sums& o) {
    solid_angle += o.solid_angle;
    illuminance += o.illuminance;
    area += o.area;
    point_strength += o.point_strength;
    direction += o.direction;
    return *this;
  }
  double luminance() const { return solid_angle > 0 ? illuminance / solid_angle : 0; }
  // L² ω; a luminaire below the least area counts as if it had that area.
  double strength() const {
    return point_strength + sqr(luminance()) * solid_angle * std::min(1.0, area / least_area);
  }
};

class Eye {
 public:
  Eye(const PreparedScene& scene, const Observer& observer, const Vec3d& up)
      : scene_(scene),
        place_(Vec3(observer.position - scene.scene.origin)),
        sight_(observer.direction),
        up_(up),
        lm_per_unit_(scene.scene.is_photometric ? 1 : luminous_efficacy) {
    const Vec3 reach = abs(place_);
    offset_ = 4 * ray_offset(std::max(1.0f, std::max(reach.x, std::max(reach.y, reach.z))));
  }

  // Adds `side` × `side` samples of a piece. Samples that are hidden or behind the eye add nothing.
  void look(const LightPrimitive& p, int side, Random& random, Sums& sums) const {
    const int n = p.shape == PrimitiveShape::point ? 1 : side * side;
    for (int i = 0; i < n; ++i) {
      const Vec2 jitter = random.next_vec2();
      const Vec2 u{(float(i % side) + jitter.x) / float(side),
                   (float(i / side) + jitter.y) / float(side)};
      LightSample s;
      if (!sample(scene_.scene, p, place_, u, s) || !(dot(Vec3d(s.wi), sight_) > 0)) continue;
      const double open = open_share(s);
      if (open > 0) add(s, open, 1.0 / n, sums);
    }
  }
  double index_of(const Sums& sums) const { return position_index(sums.direction, sight_, up_); }

 private:
  void add(const LightSample& s, double open, double weight, Sums& sums) const {
    const double light = double(luminance(s.radiance)) * lm_per_unit_ * open;
    const double r2 = sqr(double(s.distance));
    if (s.is_delta) {  // irradiance is I / r²
      sums.point_strength += light * light * r2 / least_area;
      sums.direction += Vec3d(s.wi);
      return;
    }
    const double w = weight / double(s.pdf_solid_angle);
    sums.solid_angle += w;
    sums.illuminance += w * light;
    sums.area += w * r2;
    sums.direction += Vec3d(s.wi) * w;
  }
  // Returns the share of a sample's light that arrives: 0 if something hides it, less than 1
  // behind glass.
  double open_share(const LightSample& s) const {
    Ray ray;
    ray.origin = place_;
    ray.direction = ended_before_light(s.wi * s.distance, s.normal, offset_);
    ray.t_max = 1;
    std::array<uint8_t, 1> hidden{};
    PaneFactors factors;
    scene_.tracer.occluded(std::span<const Ray>(&ray, 1), hidden, Coherence::none, factors);
    return hidden[0] != 0 ? 0 : double(luminance(factors[0]));
  }

  const PreparedScene& scene_;
  Vec3 place_;
  Vec3d sight_, up_;
  double lm_per_unit_;
  float offset_ = 0;
};

// Samples along each side of a piece, so that the pieces of a replicate share its samples.
int samples_of(size_t pieces, int samples) {
  const double each = double(samples) / double(replicates);
  return std::max(1, int(std::sqrt(each / double(std::max<size_t>(pieces, 1)))));
}

// Fills in `l`. Returns false if nothing of the luminaire is visible, or if its position does not
// count.
bool see(const PreparedScene& scene, const Eye& eye, const LightPieces& pieces, int side,
         uint64_t seed, SeenLuminaire& l) {
  std::array<Sums, replicates> sums;
  Sums all;
  double mean = 0, squares = 0;
  for (size_t r = 0; r < replicates; ++r) {
    for (const uint32_t k : pieces) {
      Random random(hash_of(seed, r, k));
      eye.look(scene.primitives[k], side, random, sums[r]);
    }
    all += sums[r];
    mean += sums[r].strength() / replicates;
  }
  if (!(mean > 0)) return false;
  l.position_index = eye.index_of(all);
  if (!std::isfinite(l.position_index)) return false;
  for (const Sums& s : sums) squares += sqr(s.strength() - mean);
  l.solid_angle = all.solid_angle / replicates;
  l.luminance = all.luminance();
  l.is_small = all.area / replicates < least_area;
  l.term = scaled({mean, std::sqrt(squares / (replicates * (replicates - 1)))},
                  1 / sqr(l.position_index));
  return true;
}

}  // namespace

double position_index(const Vec3d& towards, const Vec3d& line_of_sight, const Vec3d& up) {
  constexpr double outside = std::numeric_limits<double>::infinity();
  const Vec3d vertical = normalize(up - line_of_sight * dot(up, line_of_sight));
  const double ahead = dot(towards, line_of_sight), height = dot(towards, vertical);
  const double beside = std::abs(dot(towards, cross(line_of_sight, vertical)));
  if (!(ahead > 0) || height > highest * ahead || beside > widest * ahead) return outside;
  const double off_axis = std::hypot(height, beside) / ahead;
  if (height < 0) return index_below(off_axis);
  const double tau = deg_from_rad(std::atan2(beside, height));
  return index_above(off_axis > 0 ? tau : 0, deg_from_rad(std::atan(off_axis)));
}

double wide_position_index(const Vec3d& direction) {
  constexpr double largest = 16, farthest = 3;  // evalglare.c, get_posindex
  const Vec3d w = normalize(direction);
  // Below, evalglare takes the tangents of the angles from the two planes through the line of sight
  // for the distances beside and below it.
  const auto tangent = [](double sine) {
    return sine / std::sqrt(std::max(1 - sine * sine, 1e-12));
  };
  if (w.y < 0) return index_below(std::min(std::hypot(tangent(w.x), tangent(w.y)), farthest));
  const double off_axis = std::hypot(w.x, w.y), tau = deg_from_rad(std::atan2(std::abs(w.x), w.y));
  const double sigma = deg_from_rad(std::atan2(off_axis, std::max(w.z, 0.0)));
  return std::min(index_above(off_axis > 0 ? tau : 0, sigma), largest);
}

std::vector<SeenLuminaire> seen_luminaires(const PreparedScene& scene, const Observer& observer,
                                           const Vec3d& up, uint64_t seed, int samples) {
  const Eye eye(scene, observer, up);
  std::vector<SeenLuminaire> seen;
  for (const auto& [name, parts] : luminaire_parts(scene)) {
    size_t pieces = 0;
    for (const LightPieces& part : parts) pieces += part.size();
    const int side = samples_of(pieces / std::max<size_t>(parts.size(), 1), samples);
    for (const LightPieces& part : parts) {
      SeenLuminaire l;
      l.name = name;
      if (see(scene, eye, part, side, seed, l)) seen.push_back(std::move(l));
    }
  }
  std::stable_sort(seen.begin(), seen.end(), [](const SeenLuminaire& a, const SeenLuminaire& b) {
    return a.term.value > b.term.value;
  });
  return seen;
}

Glare glare_of(const Observer& observer, const Figure& indirect,
               std::vector<SeenLuminaire> luminaires) {
  Glare g;
  g.observer = observer;
  g.background = scaled(indirect, 1 / pi);
  Figure terms;
  for (const SeenLuminaire& l : luminaires) {
    terms = sum(terms, l.term);
    g.is_large = g.is_large || l.solid_angle > most_solid_angle;
  }
  g.luminaires = std::move(luminaires);
  g.is_defined = terms.value > 0 && g.background.value > 2 * g.background.error;
  if (!g.is_defined) return g;
  const double relative =
      std::hypot(terms.error / terms.value, g.background.error / g.background.value);
  g.ugr = {8 * std::log10(0.25 / g.background.value * terms.value), 8 / std::log(10.0) * relative};
  return g;
}

}  // namespace troffer
