#include "report/plan_view.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace troffer {

namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// Takes a run of digits off the text, without leading zeros.
std::string_view take_number(std::string_view& text) {
  size_t n = 0;
  while (n < text.size() && is_digit(text[n])) ++n;
  std::string_view digits = text.substr(0, n);
  text.remove_prefix(n);
  while (digits.size() > 1 && digits[0] == '0') digits.remove_prefix(1);
  return digits;
}

}  // namespace

PlanAxes plan_axes(const Vec3d& up) {
  const Vec3d x = std::abs(up.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d right = normalize(x - up * dot(x, up));
  return {right, cross(up, right)};
}

Vec3d north_of(const Vec3d& up, double north_deg, bool is_mirrored) {
  const Vec3d start = std::abs(up.z) > 0.7 ? Vec3d{0, 1, 0} : Vec3d{0, 0, -1};
  const Vec3d ahead = normalize(start - up * dot(start, up));
  const Vec3d right = cross(ahead, up) * (is_mirrored ? -1 : 1);
  const double turn = rad_from_deg(north_deg);
  return ahead * std::cos(turn) + right * std::sin(turn);
}

void sort_by_rows(std::vector<AssessedSurface*>& surfaces, const Vec3d& up) {
  constexpr double row = 0.5;  // m
  const PlanAxes axes = plan_axes(up);
  const auto height = [&](const AssessedSurface* s) { return axes.of(middle_of(*s)).y; };
  const auto beside = [&](const AssessedSurface* s) { return axes.of(middle_of(*s)).x; };
  std::stable_sort(
      surfaces.begin(), surfaces.end(),
      [&](const AssessedSurface* a, const AssessedSurface* b) { return height(a) > height(b); });
  for (size_t i = 0; i < surfaces.size();) {
    size_t end = i + 1;
    while (end < surfaces.size() && height(surfaces[end]) > height(surfaces[end - 1]) - row) ++end;
    std::stable_sort(
        surfaces.begin() + std::ptrdiff_t(i), surfaces.begin() + std::ptrdiff_t(end),
        [&](const AssessedSurface* a, const AssessedSurface* b) { return beside(a) < beside(b); });
    i = end;
  }
}

bool natural_less(std::string_view a, std::string_view b) {
  const std::string_view whole_a = a, whole_b = b;
  while (!a.empty() && !b.empty()) {
    if (is_digit(a[0]) && is_digit(b[0])) {
      const std::string_view m = take_number(a), n = take_number(b);
      if (m.size() != n.size()) return m.size() < n.size();
      if (m != n) return m < n;
      continue;
    }
    if (a[0] != b[0]) return static_cast<unsigned char>(a[0]) < static_cast<unsigned char>(b[0]);
    a.remove_prefix(1);
    b.remove_prefix(1);
  }
  if (a.empty() != b.empty()) return a.empty();
  return whole_a < whole_b;  // equal but for leading zeros
}

}  // namespace troffer
