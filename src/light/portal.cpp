#include "light/portal.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"

namespace troffer {

namespace {

// Lower bound of the density, relative to its mean. Light may lie between the directions evaluated.
constexpr double least_density = 0.01;

// Returns the last i of [first, last] with f(i) <= target; f must not decrease.
template <class F>
int last_below(int first, int last, double target, const F& f) {
  while (first < last) {
    const int middle = first + (last - first + 1) / 2;
    if (f(middle) <= target)
      first = middle;
    else
      last = middle - 1;
  }
  return first;
}

// Steradians per area of the unit square of both angles, in direction (x, y, 1).
double steradians(double x, double y) {
  const double square = 1 + x * x + y * y;
  return sqr(pi) * (1 + x * x) * (1 + y * y) / (square * std::sqrt(square));
}

double tangent_of(double place) {
  return std::tan(pi * (place - 0.5));
}

}  // namespace

Portal::Portal(std::span<const Vec3> corners, int n,
               const std::function<float(const Vec3&)>& luminance)
    : corner_(corners[0]), n_(n), sums_(sqr(size_t(n) + 1)) {
  const Vec3d along_x = Vec3d(corners[3]) - corner_, along_y = Vec3d(corners[1]) - corner_;
  size_x_ = length(along_x);
  size_y_ = length(along_y);
  x_ = along_x / size_x_;
  z_ = normalize(cross(x_, along_y));
  y_ = cross(z_, x_);
  const size_t stride = size_t(n) + 1;
  double total = 0;
  std::vector<double> cells(sqr(size_t(n)));
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      double& cell = cells[size_t(j) * size_t(n) + size_t(i)];
      for (const double s : {0.25, 0.75})
        for (const double t : {0.25, 0.75}) {
          const double x = tangent_of((i + s) / n), y = tangent_of((j + t) / n);
          cell +=
              0.25 * steradians(x, y) * double(luminance(Vec3(normalize(x_ * x + y_ * y + z_))));
        }
      total += cell;
    }
  const double least = total > 0 ? least_density * total / sqr(double(n)) : 1;
  for (size_t j = 0; j < size_t(n); ++j) {
    double row = 0;
    for (size_t i = 0; i < size_t(n); ++i) {
      row += cells[j * size_t(n) + i] + least;
      sums_[(j + 1) * stride + i + 1] = sums_[j * stride + i + 1] + row;
    }
  }
}

bool Portal::shows(const Vec3& x, const Vec3& wi) const {
  const Vec3d w = own(Vec3d(wi)), from = own(Vec3d(x) - corner_);
  if (!(w.z > 0) || !(from.z < 0)) return false;
  const double a = from.x * w.z - w.x * from.z, b = from.y * w.z - w.y * from.z;
  return a >= 0 && a <= size_x_ * w.z && b >= 0 && b <= size_y_ * w.z;
}

// Each condition of shows() is affine in the place and linear in the direction. So what holds at
// all corners holds between them.
Portal::View Portal::view_within(double margin, const Box& receivers,
                                 const Parallelogram& far) const {
  constexpr double angle = 1e-5;  // above rounding and the error of "far away" (sky_patches.h)
  constexpr size_t conditions = 6;
  std::array<bool, conditions> always{}, never{};
  always.fill(true);
  never.fill(true);
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 4; ++j) {
      const Vec3d at(Vec3{(i & 1) != 0 ? receivers.upper.x : receivers.lower.x,
                          (i & 2) != 0 ? receivers.upper.y : receivers.lower.y,
                          (i & 4) != 0 ? receivers.upper.z : receivers.lower.z});
      const Vec3d to = far.origin + far.u * double(j & 1) + far.v * double(j >> 1);
      const Vec3d w = own(normalize(to - at)), from = own(at - corner_);
      const double a = from.x * w.z - w.x * from.z, b = from.y * w.z - w.y * from.z;
      const double values[conditions] = {w.z,
                                         -from.z,
                                         a + margin * w.z,
                                         (size_x_ + margin) * w.z - a,
                                         b + margin * w.z,
                                         (size_y_ + margin) * w.z - b};
      const double metres = size_x_ + size_y_ + margin + length(at - corner_);
      for (size_t k = 0; k < conditions; ++k) {
        const double slack = angle * (k == 0 ? 1 : metres);
        always[k] = always[k] && values[k] > slack;
        never[k] = never[k] && values[k] < -slack;
      }
    }
  if (std::find(never.begin(), never.end(), true) != never.end()) return View::none;
  return std::find(always.begin(), always.end(), false) == always.end() ? View::all : View::some;
}

std::array<Quad, 4> Portal::frame(double reach) const {
  std::array<Vec3, 4> inner, outer;
  for (size_t i = 0; i < 4; ++i) {
    const double x = i == 1 || i == 2 ? 1 : 0, y = i >= 2 ? 1 : 0;
    const Vec3d side = x_ * (2 * x - 1) + y_ * (2 * y - 1);
    const Vec3d at = corner_ + x_ * (x * size_x_) + y_ * (y * size_y_);
    inner[i] = Vec3(at);
    outer[i] = Vec3(at + side * reach);
  }
  std::array<Quad, 4> quads;
  for (size_t i = 0; i < 4; ++i) {
    const size_t next = (i + 1) % 4;
    quads[i] = {inner[i], outer[i], outer[next], inner[next]};
  }
  return quads;
}

bool Portal::range_from(const Vec3& x, Range& r) const {
  const Vec3d from = own(Vec3d(x) - corner_);
  if (!(from.z < 0)) return false;
  const auto place = [&](double side) { return n_ * (0.5 + std::atan2(side, -from.z) / pi); };
  r = {place(-from.x), place(size_x_ - from.x), place(-from.y), place(size_y_ - from.y)};
  return r.x1 > r.x0 && r.y1 > r.y0;
}

double Portal::sum(double x, double y) const {
  const int i = std::clamp(int(x), 0, n_ - 1), j = std::clamp(int(y), 0, n_ - 1);
  const double* at = sums_.data() + size_t(j) * (size_t(n_) + 1) + size_t(i);
  const double* above = at + n_ + 1;
  const double s = x - i, t = y - j;
  return (at[0] * (1 - s) + at[1] * s) * (1 - t) + (above[0] * (1 - s) + above[1] * s) * t;
}

double Portal::density(double x, double y) const {
  const int i = std::clamp(int(x), 0, n_ - 1), j = std::clamp(int(y), 0, n_ - 1);
  return (sum(i + 1, j + 1) - sum(i, j + 1)) - (sum(i + 1, j) - sum(i, j));
}

double Portal::squares_per_steradian(double x, double y) const {
  return sqr(double(n_)) / steradians(x, y);
}

bool Portal::sample(const Vec3& x, const Vec2& u, Vec3& wi, float& pdf) const {
  Range r{};
  if (!range_from(x, r)) return false;
  const double all = sum_to(r, r.x1);
  if (!(all > 0)) return false;
  // Returns the position in [from, to] at which sum_before reaches the target; linear within cells.
  // Used for the column and then along it.
  const auto invert = [&](double from, double to, double target, const auto& sum_before) {
    const int first = int(from);
    const int last = std::clamp(int(std::ceil(to)) - 1, first, n_ - 1);
    const int i = last_below(first, last, target,
                             [&](int k) { return k <= from ? 0 : sum_before(double(k)); });
    const double a = std::max(double(i), from), b = std::min(double(i + 1), to);
    const double before = sum_before(a), within = sum_before(b) - before;
    const double t = within > 0 ? std::clamp((target - before) / within, 0.0, 1.0) : 0.5;
    return a + (b - a) * t;
  };
  const double at_x =
      invert(r.x0, r.x1, double(u.x) * all, [&](double to) { return sum_to(r, to); });
  const double column = std::min(std::floor(at_x), double(n_ - 1));
  const auto along = [&](double to) {
    return (sum(column + 1, to) - sum(column, to)) - (sum(column + 1, r.y0) - sum(column, r.y0));
  };
  const double at_y = invert(r.y0, r.y1, double(u.y) * along(r.y1), along);
  const double a = tangent_of(at_x / n_), b = tangent_of(at_y / n_);
  wi = Vec3(normalize(x_ * a + y_ * b + z_));
  pdf = float(density(at_x, at_y) / all * squares_per_steradian(a, b));
  return pdf > 0 && std::isfinite(pdf);
}

float Portal::pdf(const Vec3& x, const Vec3& wi) const {
  Range r{};
  const Vec3d w = own(Vec3d(wi));
  if (!shows(x, wi) || !range_from(x, r)) return 0;
  const double all = sum_to(r, r.x1);
  if (!(all > 0)) return 0;
  const auto place = [&](double along) { return n_ * (0.5 + std::atan2(along, w.z) / pi); };
  const auto pdf =
      float(density(place(w.x), place(w.y)) / all * squares_per_steradian(w.x / w.z, w.y / w.z));
  return std::isfinite(pdf) ? pdf : 0;
}

}  // namespace troffer
