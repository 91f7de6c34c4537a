#include "import/luminaire/luminaire_angles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace troffer {

namespace {

constexpr double reported_shift_deg = 0.1;  // degrees; smaller shifts are rounding
constexpr double max_gap_deg = 5;           // degrees; a common step of photometric tables
constexpr double min_gap_deg = 1e-3;        // degrees; closer angles are equal in single precision
// Largest gap in steps: tables that list the middles of zones begin half a step from the pole. The
// excess is for rounding.
constexpr double zone_gap = 0.505;
constexpr double lit_share =
    0.01;  // share of the largest intensity; a darker edge needs no warning

double snapped(double angle, double neighbour) {
  const double nearest = 90 * std::round(angle / 90), off = std::abs(angle - nearest);
  const double step = std::abs(neighbour - angle);
  return off < angle_slack_deg && off < 0.49 * step ? nearest : angle;
}

void prepend_height(Planes& planes, double height) {
  const size_t n = planes.vertical_angles_deg.size();
  std::vector<double> candela;
  for (size_t i = 0; i < planes.horizontal_angles_deg.size(); ++i) {
    candela.push_back(planes.candela[i * n]);
    candela.insert(candela.end(), planes.candela.begin() + std::ptrdiff_t(i * n),
                   planes.candela.begin() + std::ptrdiff_t((i + 1) * n));
  }
  planes.vertical_angles_deg.insert(planes.vertical_angles_deg.begin(), height);
  planes.candela = std::move(candela);
}

void append_height(Planes& planes, double height) {
  const size_t n = planes.vertical_angles_deg.size();
  std::vector<double> candela;
  for (size_t i = 0; i < planes.horizontal_angles_deg.size(); ++i) {
    candela.insert(candela.end(), planes.candela.begin() + std::ptrdiff_t(i * n),
                   planes.candela.begin() + std::ptrdiff_t((i + 1) * n));
    candela.push_back(planes.candela[(i + 1) * n - 1]);
  }
  planes.vertical_angles_deg.push_back(height);
  planes.candela = std::move(candela);
}

// True if any plane exceeds lit_share of the largest intensity at that vertical angle.
bool is_lit_at(const Planes& planes, size_t height) {
  const double most = *std::max_element(planes.candela.begin(), planes.candela.end());
  const size_t n = planes.vertical_angles_deg.size();
  for (size_t i = 0; i < planes.horizontal_angles_deg.size(); ++i)
    if (planes.candela[i * n + height] > lit_share * most) return true;
  return false;
}

// True if the angles begin above 0, but close enough to be extended to 0.
bool is_near_zero(const std::vector<double>& angles) {
  const double first = angles.front(), step = angles.size() > 1 ? angles[1] - first : 0;
  return first > min_gap_deg && first <= std::max(max_gap_deg, zone_gap * step);
}

}  // namespace

void snap_ends(std::vector<double>& angles, const char* what, const std::string& name,
               WarningLog& warnings) {
  const size_t n = angles.size();
  if (n < 2) return;
  const double first = snapped(angles[0], angles[1]);
  const double last = snapped(angles[n - 1], angles[n - 2]);
  for (const auto& [from, to] : {std::pair{angles[0], first}, {angles[n - 1], last}})
    if (std::abs(from - to) > reported_shift_deg)
      warnings.add(
          fmt::format("{}: {} of {:.6g} degrees are read as {:.6g}", name, what, from, to));
  angles[0] = first;
  angles[n - 1] = last;
}

void extend_to_poles(Planes& planes, const std::string& name, WarningLog& warnings) {
  const std::vector<double>& heights = planes.vertical_angles_deg;
  const double first = heights.front(), from = first < 90 ? 0 : 90;
  const double step = heights[1] - first;
  if (first - from > min_gap_deg) {
    if (first - from <= std::max(max_gap_deg, zone_gap * step)) {
      warnings.add(
          fmt::format("{}: vertical angles begin at {:.6g} degrees; the first intensities are used "
                      "down to {:.6g}",
                      name, first, from));
      prepend_height(planes, from);
    } else if (is_lit_at(planes, 0)) {
      warnings.add(fmt::format(
          "{}: vertical angles begin at {:.6g} degrees; there is no light below", name, first));
    }
  }
  const double last = heights.back(), to = last <= 90 ? 90 : 180;
  if (!(to - last > min_gap_deg)) return;
  if (to - last <= zone_gap * (last - heights[heights.size() - 2])) {
    warnings.add(fmt::format(
        "{}: vertical angles end at {:.6g} degrees; the last intensities are used up to {:.6g}",
        name, last, to));
    append_height(planes, to);
  } else if (is_lit_at(planes, heights.size() - 1)) {
    warnings.add(fmt::format("{}: vertical angles end at {:.6g} degrees; there is no light beyond",
                             name, last));
  }
}

void extend_to_beam_axis(Planes& planes, const std::string& name, WarningLog& warnings) {
  const auto tell = [&](const char* what, double first) {
    warnings.add(fmt::format(
        "{}: {} angles begin at {:.6g} degrees; the first intensities are used down to 0", name,
        what, first));
  };
  if (is_near_zero(planes.vertical_angles_deg)) {
    tell("vertical", planes.vertical_angles_deg.front());
    prepend_height(planes, 0);
  }
  if (planes.horizontal_angles_deg.size() > 1 && is_near_zero(planes.horizontal_angles_deg)) {
    tell("horizontal", planes.horizontal_angles_deg.front());
    const size_t n = planes.vertical_angles_deg.size();
    const std::vector<double> row(planes.candela.begin(),
                                  planes.candela.begin() + std::ptrdiff_t(n));
    planes.horizontal_angles_deg.insert(planes.horizontal_angles_deg.begin(), 0);
    planes.candela.insert(planes.candela.begin(), row.begin(), row.end());
  }
}

}  // namespace troffer
