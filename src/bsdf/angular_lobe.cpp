#include "bsdf/angular_lobe.h"

#include <algorithm>
#include <cmath>

#include "base/warp.h"

namespace troffer {

namespace {

// A diagonal value is a peak if it exceeds this factor times the mean around it, and passes at
// least this share of the light above it. Both are those of Radiance's aBSDF (m_bsdf.c,
// compute_through).
constexpr float least_contrast = 8, least_passed = 0.0005f;

size_t in_patch(const AngleMatrix& m, const Vec3& wi) {
  return m.in.patch_of({-wi.x, -wi.y, wi.z});
}

}  // namespace

float AngularLobe::Way::total(size_t o) const {
  if (matrix.is_empty()) return 0;
  const size_t n = matrix.in.size();
  return sums[o * (n + 1) + n];
}

// Light that passes straight on through patch o of the viewer arrives in the patch of `in` around
// the same angles.
void AngularLobe::take_peaks(Way& way) {
  AngleMatrix& m = way.matrix;
  std::vector<float> straight(m.out.size(), 0.0f);
  for (size_t o = 0; o < m.out.size(); ++o) {
    const size_t i = m.in.patch_of(m.out.direction(o, {0.5f, 0.5f}));
    double around = 0, size = 0;
    for (const size_t k : m.in.neighbours(i)) {
      const double w = m.in.projected_solid_angle(k);
      around += double(m.at(o, k)) * w;
      size += w;
    }
    const auto mean = float(size > 0 ? around / size : 0);
    float& peak = m.values[o * m.in.size() + i];
    const auto passed = float(double(peak - mean) * m.in.projected_solid_angle(i));
    if (!(peak > least_contrast * mean) || passed < least_passed) continue;
    straight[o] = passed;
    peak = mean;
  }
  if (std::any_of(straight.begin(), straight.end(), [](float s) { return s > 0; }))
    way.straight = std::move(straight);
}

AngularLobe::Way AngularLobe::make_way(const AngleMatrix& matrix) {
  Way way;
  way.matrix = matrix;
  return way;
}

AngularLobe::AngularLobe(const AngularBsdf& b, bool keeps_peak)
    : front_{make_way(b.front_reflection), make_way(b.to_front)},
      back_{make_way(b.back_reflection), make_way(b.to_back)} {
  for (Side* side : {&front_, &back_}) {
    if (keeps_peak && !side->transmission.matrix.is_empty()) take_peaks(side->transmission);
    has_straight_ |= !side->transmission.straight.empty();
    for (Way* way : {&side->reflection, &side->transmission}) {
      const AngleMatrix& m = way->matrix;
      for (size_t o = 0; !m.is_empty() && o < m.out.size(); ++o) {
        double sum = 0;
        way->sums.push_back(0);
        for (size_t i = 0; i < m.in.size(); ++i) {
          sum += double(m.at(o, i)) * m.in.projected_solid_angle(i);
          way->sums.push_back(float(sum));
        }
      }
    }
  }
}

float AngularLobe::value(const Vec3& wo, const Vec3& wi) const {
  const Side& side = side_of(wo);
  const AngleMatrix& m =
      (wo.z > 0) == (wi.z > 0) ? side.reflection.matrix : side.transmission.matrix;
  return m.is_empty() ? 0.0f : m.at(m.out.patch_of(wo), in_patch(m, wi));
}

float AngularLobe::straight(const Vec3& wo) const {
  const Way& way = side_of(wo).transmission;
  return way.straight.empty() ? 0.0f : way.straight[way.matrix.out.patch_of(wo)];
}

float AngularLobe::albedo(const Vec3& wo) const {
  const Side& side = side_of(wo);
  float sum = straight(wo);
  for (const Way* way : {&side.reflection, &side.transmission})
    if (!way->matrix.is_empty()) sum += way->total(way->matrix.out.patch_of(wo));
  return sum;
}

float AngularLobe::mean_albedo(bool is_front, float cosine) const {
  constexpr int azimuths = 48;  // least common multiple of the patches of WINDOW's inner rings
  const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
  float sum = 0;
  for (int k = 0; k < azimuths; ++k) {
    const float phi = 2 * pi_f * (float(k) + 0.5f) / float(azimuths);
    sum += albedo({sine * std::cos(phi), sine * std::sin(phi), is_front ? cosine : -cosine});
  }
  return sum / float(azimuths);
}

bool AngularLobe::sample(const Vec3& wo, float u_lobe, const Vec2& u, Vec3& wi,
                         bool& is_straight) const {
  const Side& side = side_of(wo);
  float x = u_lobe * albedo(wo);
  const float passed = straight(wo);
  is_straight = x < passed;
  if (is_straight) {
    wi = -wo;
    return true;
  }
  x -= passed;
  const Way* way = &side.transmission;
  if (!side.reflection.matrix.is_empty()) {
    const float reflected = side.reflection.total(side.reflection.matrix.out.patch_of(wo));
    if (x < reflected || side.transmission.matrix.is_empty())
      way = &side.reflection;
    else
      x -= reflected;
  }
  const AngleMatrix& m = way->matrix;
  if (m.is_empty()) return false;
  const size_t n = m.in.size();
  const float* sums = &way->sums[m.out.patch_of(wo) * (n + 1)];
  if (!(sums[n] > 0)) return false;
  // Rounding may leave x at the end of the sums: the last patch that scatters is taken then.
  x = std::min(x, sums[n] * one_minus_epsilon);
  const float* after = std::upper_bound(sums, sums + n + 1, x);
  const size_t patch = after == sums + n + 1
                           ? size_t(std::lower_bound(sums, sums + n, sums[n]) - sums) - 1
                           : size_t(after - sums) - 1;
  const Vec3 w = m.in.direction(patch, u);
  const bool is_at_viewer = way == &side.reflection;
  wi = {-w.x, -w.y, (wo.z > 0) == is_at_viewer ? w.z : -w.z};
  return wi.z != 0;
}

}  // namespace troffer
