#include "light/web.h"

#include <algorithm>
#include <cmath>

#include "base/simd.h"
#include "base/units.h"
#include "light/arctangent.h"

namespace troffer {

namespace {

// lower bound of projected area, relative to the largest face
constexpr float least_area_share = 0.01f;
// rounding of atan2() at the first and last angle of a web, radians
constexpr float angle_slack = 1e-5f;

// Returns i with angles[i] <= x <= angles[i + 1]. t: position of x between them.
size_t step_of(const std::vector<float>& angles, float x, float& t) {
  const auto above = std::upper_bound(angles.begin() + 1, angles.end() - 1, x);
  const auto i = size_t(above - angles.begin()) - 1;
  const float step = angles[i + 1] - angles[i];
  t = step > 0 ? std::clamp((x - angles[i]) / step, 0.0f, 1.0f) : 0.0f;
  return i;
}

}  // namespace

float intensity(const LightWeb& web, const Vec3& w) {
  const auto axes = axes_of(web.pole);
  const Vec3 v{dot(w, axes[0]), dot(w, axes[1]), dot(w, axes[2])};
  const float height = std::atan2(std::sqrt(v.x * v.x + v.y * v.y), v.z);
  if (height < web.vertical_angles_rad.front() - angle_slack ||
      height > web.vertical_angles_rad.back() + angle_slack)
    return 0;
  float turn = std::atan2(v.y, v.x);
  if (turn < web.horizontal_angles_rad.front() - angle_slack) turn += 2 * pi_f;
  if (turn > web.horizontal_angles_rad.back() + angle_slack) return 0;
  float s = 0, t = 0;
  const size_t i = step_of(web.horizontal_angles_rad, turn, s),
               j = step_of(web.vertical_angles_rad, height, t);
  const size_t n = web.vertical_angles_rad.size();
  const float* at = web.intensities.data() + i * n + j;
  return lerp(lerp(at[0], at[1], t), lerp(at[n], at[n + 1], t), s);
}

double flux(const LightWeb& web) {
  const size_t n = web.vertical_angles_rad.size();
  double sum = 0;
  for (size_t j = 0; j + 1 < n; ++j) {
    const double a = double(web.vertical_angles_rad[j]), b = double(web.vertical_angles_rad[j + 1]);
    if (!(b > a)) continue;
    // Integral of sin over [a, b], and of sin times a ramp from 0 to 1 over [a, b].
    const double all = std::cos(a) - std::cos(b);
    const double rising = (std::sin(b) - std::sin(a)) / (b - a) - std::cos(b);
    for (size_t i = 0; i + 1 < web.horizontal_angles_rad.size(); ++i) {
      const float* at = web.intensities.data() + i * n + j;
      const double turn =
          double(web.horizontal_angles_rad[i + 1]) - double(web.horizontal_angles_rad[i]);
      const double low = (double(at[0]) + double(at[n])) / 2;
      const double high = (double(at[1]) + double(at[n + 1])) / 2;
      sum += turn * (low * all + (high - low) * rising);
    }
  }
  return sum;
}

float largest_intensity(const LightWeb& web) {
  return *std::max_element(web.intensities.begin(), web.intensities.end());
}

float projected_area(const LightWeb& web, const Vec3& w) {
  if (web.faces.empty()) return web.cross_section;
  float sum = 0, largest = 0;
  for (const Vec3& face : web.faces) {
    sum += std::max(0.0f, dot(face, w));
    largest = std::max(largest, length_squared(face));
  }
  return std::max(sum, least_area_share * std::sqrt(largest));
}

namespace {

// Computes the angles at which light leaves the points for the receiver. Turns begin at -pi.
TROFFER_MULTIVERSION
void angles_of(const Vec3& first, const Vec3& second, const Vec3& pole, size_t n,
               const float* __restrict x, const float* __restrict y, const float* __restrict z,
               float* __restrict height, float* __restrict turn) {
  for (size_t i = 0; i < n; ++i) {
    const float a = -(x[i] * first.x + y[i] * first.y + z[i] * first.z);
    const float b = -(x[i] * second.x + y[i] * second.y + z[i] * second.z);
    const float c = -(x[i] * pole.x + y[i] * pole.y + z[i] * pole.z);
    height[i] = upper_angle(std::sqrt(a * a + b * b), c);
    const float angle = upper_angle(std::abs(b), a);
    turn[i] = b < 0 ? -angle : angle;
  }
}

// Adds the visible projected area of a face.
TROFFER_MULTIVERSION
void add_seen(const Vec3& face, size_t n, const float* __restrict x, const float* __restrict y,
              const float* __restrict z, float* __restrict area) {
  for (size_t i = 0; i < n; ++i) {
    const float seen = -(x[i] * face.x + y[i] * face.y + z[i] * face.z);
    area[i] += seen > 0 ? seen / std::sqrt(x[i] * x[i] + y[i] * y[i] + z[i] * z[i]) : 0.0f;
  }
}

// Moves turns into the web's range, which may begin after -pi and continue beyond pi. Marks
// directions outside the web by height = -1.
TROFFER_MULTIVERSION
void keep_within(const LightWeb& web, size_t n, float* __restrict height, float* __restrict turn) {
  const float least_turn = web.horizontal_angles_rad.front() - angle_slack,
              most_turn = web.horizontal_angles_rad.back() + angle_slack,
              least = web.vertical_angles_rad.front() - angle_slack,
              most = web.vertical_angles_rad.back() + angle_slack;
  for (size_t i = 0; i < n; ++i) {
    turn[i] += turn[i] < least_turn ? 2 * pi_f : 0.0f;
    const bool is_within = (height[i] >= least) & (height[i] <= most) & (turn[i] <= most_turn);
    height[i] = is_within ? height[i] : -1.0f;
  }
}

// Interpolates bilinearly between four values; 0 where the height is negative.
TROFFER_MULTIVERSION
void interpolate(const float* __restrict values, int32_t per_turn, float least_area, size_t n,
                 const int32_t* __restrict turn, const int32_t* __restrict height,
                 const float* __restrict s, const float* __restrict t,
                 const float* __restrict angle, const float* __restrict area,
                 float* __restrict out) {
  for (size_t i = 0; i < n; ++i) {
    const int32_t at = turn[i] * per_turn + height[i];
    const float a = lerp(values[at], values[at + 1], t[i]);
    const float b = lerp(values[at + per_turn], values[at + per_turn + 1], t[i]);
    const float value = lerp(a, b, s[i]) / std::max(area[i], least_area);
    out[i] = angle[i] < 0 ? 0.0f : value;
  }
}

TROFFER_ALWAYS_INLINE int32_t bucket_of(float angle, float first, float per_radian, float last) {
  // NaN maps to the first bucket, because comparisons with it are false.
  return int32_t(std::min(std::max(0.0f, (angle - first) * per_radian), last));
}

// Finds the interval of an angle: start at the first interval of its bucket, then advance by at
// most most_within. Angles beyond the ends get the first or last interval.
struct Buckets {
  const float* angles;
  int32_t last_step, most_within;
  float per_radian, last;
  const int32_t* before;
};
TROFFER_MULTIVERSION
void find_steps(const Buckets& b, size_t n, const float* __restrict x, int32_t* __restrict step) {
  const float first = b.angles[0];
  for (size_t i = 0; i < n; ++i) step[i] = b.before[bucket_of(x[i], first, b.per_radian, b.last)];
  for (int32_t k = 0; k < b.most_within; ++k)
    for (size_t i = 0; i < n; ++i)
      step[i] += (step[i] < b.last_step) & (x[i] >= b.angles[step[i] + 1]) ? 1 : 0;
}
TROFFER_MULTIVERSION
void find_shares(const float* __restrict angles, size_t n, const float* __restrict x,
                 const int32_t* __restrict step, float* __restrict share) {
  for (size_t i = 0; i < n; ++i) {
    const float from = angles[step[i]];
    share[i] = std::min(std::max(0.0f, (x[i] - from) / (angles[step[i] + 1] - from)), 1.0f);
  }
}

}  // namespace

WebLookup::Steps::Steps(const std::vector<float>& a) : angles(a) {
  // Buckets are as narrow as the narrowest interval, so that no bucket contains two angles, unless
  // that makes too many buckets.
  constexpr float most_buckets = 4096;
  const float all = std::max(a.back() - a.front(), 1e-9f);
  float narrowest = all;
  for (size_t i = 1; i < a.size(); ++i)
    if (a[i] > a[i - 1]) narrowest = std::min(narrowest, a[i] - a[i - 1]);
  const float buckets = std::min(std::ceil(all / narrowest) + 1, most_buckets);
  buckets_per_radian = buckets / all;
  before.assign(size_t(buckets) + 1, 0);
  std::vector<int32_t> within(before.size(), 0);
  for (size_t i = 1; i + 1 < a.size(); ++i)
    ++within[size_t(bucket_of(a[i], a[0], buckets_per_radian, buckets))];
  for (size_t k = 1; k < before.size(); ++k) before[k] = before[k - 1] + within[k - 1];
  most_within = *std::max_element(within.begin(), within.end());
}

void WebLookup::Steps::find(size_t n, const float* x, int32_t* step, float* share) const {
  find_steps({angles.data(), int32_t(angles.size()) - 2, most_within, buckets_per_radian,
              float(before.size() - 1), before.data()},
             n, x, step);
  find_shares(angles.data(), n, x, step, share);
}

WebLookup::WebLookup(const LightWeb& web)
    : web_(web), heights_(web.vertical_angles_rad), turns_(web.horizontal_angles_rad) {}

void WebLookup::radiance_many(const std::array<Vec3, 3>& axes, size_t n, const float* x,
                              const float* y, const float* z, WebLanes& lanes, float* out) const {
  const auto world = [&](const Vec3& v) { return axes[0] * v.x + axes[1] * v.y + axes[2] * v.z; };
  WebLanes& l = lanes;
  for (auto* a : {&l.height, &l.turn, &l.height_share, &l.turn_share}) a->resize(n);
  for (auto* a : {&l.height_step, &l.turn_step}) a->resize(n);
  l.area.assign(n, web_.cross_section);
  const auto own = axes_of(web_.pole);
  angles_of(world(own[0]), world(own[1]), world(own[2]), n, x, y, z, l.height.data(),
            l.turn.data());
  float least = 0;
  for (const Vec3& face : web_.faces) {
    add_seen(world(face), n, x, y, z, l.area.data());
    least = std::max(least, least_area_share * length(face));
  }
  keep_within(web_, n, l.height.data(), l.turn.data());
  heights_.find(n, l.height.data(), l.height_step.data(), l.height_share.data());
  turns_.find(n, l.turn.data(), l.turn_step.data(), l.turn_share.data());
  interpolate(web_.intensities.data(), int32_t(web_.vertical_angles_rad.size()), least, n,
              l.turn_step.data(), l.height_step.data(), l.turn_share.data(), l.height_share.data(),
              l.height.data(), l.area.data(), out);
}

WebSamples::WebSamples(const LightWeb& web) {
  const auto axes = axes_of(web.pole);
  // Each cell of the web is divided into parts of at most 3 degrees.
  const auto most = float(rad_from_deg(3.0));
  const auto parts_of = [&](float from, float to) { return int((to - from) / most) + 1; };
  for (size_t j = 0; j + 1 < web.vertical_angles_rad.size(); ++j) {
    const float h0 = web.vertical_angles_rad[j], h1 = web.vertical_angles_rad[j + 1];
    const int rows = parts_of(h0, h1);
    for (int row = 0; row < rows; ++row) {
      const float a = lerp(h0, h1, float(row) / float(rows)),
                  b = lerp(h0, h1, float(row + 1) / float(rows));
      const float middle = 0.5f * (a + b), zone = std::cos(a) - std::cos(b);
      const float z = std::cos(middle), r = std::sin(middle);
      for (size_t i = 0; i + 1 < web.horizontal_angles_rad.size(); ++i) {
        const float t0 = web.horizontal_angles_rad[i], step = web.horizontal_angles_rad[i + 1] - t0;
        const int columns = parts_of(0, step);
        for (int column = 0; column < columns; ++column) {
          const float turn = t0 + step * (float(column) + 0.5f) / float(columns);
          const Vec3 w =
              axes[0] * (r * std::cos(turn)) + axes[1] * (r * std::sin(turn)) + axes[2] * z;
          const float weight = radiance(web, w) * zone * step / float(columns);
          if (!(weight > 0)) continue;
          directions_.push_back(w);
          weights_.push_back(weight);
        }
      }
    }
  }
}

double WebSamples::exitance(const Vec3& n) const {
  double sum = 0;
  for (size_t i = 0; i < directions_.size(); ++i)
    sum += double(std::max(0.0f, dot(n, directions_[i])) * weights_[i]);
  return sum;
}

}  // namespace troffer
