#include "import/luminaire/luminaire_planes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace troffer {

void check_ascending(const std::vector<double>& angles, const PhotometricText& text,
                     const char* name) {
  for (size_t i = 1; i < angles.size(); ++i)
    if (!(angles[i] > angles[i - 1])) text.fail(fmt::format("{} do not ascend", name));
}

void check_monotonic(const std::vector<double>& angles, const PhotometricText& text,
                     const char* name) {
  if (angles.size() < 2 || angles[1] > angles[0]) return check_ascending(angles, text, name);
  for (size_t i = 1; i < angles.size(); ++i)
    if (!(angles[i] < angles[i - 1])) text.fail(fmt::format("{} do not ascend", name));
}

namespace {

// Implementation of unfold_planes().
class Unfolder {
 public:
  Unfolder(const Planes& planes, WarningLog& warnings, const std::string& name)
      : planes_(planes), warnings_(warnings), name_(name) {}

  LightWeb web() {
    const std::vector<double>& turns = planes_.horizontal_angles_deg;
    const double first = turns.front(), last = turns.back();
    if (turns.size() == 1) {
      add(0, 0);
      add(360, 0);
    } else if (first == 0 && last == 90) {
      add_all(0, +1);
      add_all(180, -1);
      add_all(180, +1);
      add_all(360, -1);
    } else if ((first == 0 && last == 180) || (first == 180 && last == 360)) {
      add_all(0, +1);
      add_all(360, -1);
    } else if ((first == 90 && last == 270) || (first == -90 && last == 90)) {
      add_all(0, +1);
      add_all(180, -1);  // 90 to -90
    } else {
      add_all(0, +1);
      if (last - first < 360) {
        if (first + 360 - last > 1.5 * (last - turns[turns.size() - 2]))
          warnings_.add(name_ +
                        ": planes do not cover the full circle; the first follows the last");
        add(first + 360, 0);
      }
    }
    return sorted();
  }

 private:
  struct Plane {
    double turn;
    size_t row;
  };
  void add(double turn, size_t row) { made_.push_back({turn, row}); }
  void add_all(double offset, double sign) {
    for (size_t i = 0; i < planes_.horizontal_angles_deg.size(); ++i)
      add(offset + sign * planes_.horizontal_angles_deg[i], i);
  }

  LightWeb sorted() {
    // Sort the planes within [0, 360) and remove duplicates; a plane at 360 follows below.
    for (Plane& p : made_) p.turn -= 360 * std::floor(p.turn / 360);
    std::stable_sort(made_.begin(), made_.end(),
                     [](const Plane& a, const Plane& b) { return a.turn < b.turn; });
    made_.erase(std::unique(made_.begin(), made_.end(),
                            [](const Plane& a, const Plane& b) {
                              return std::abs(a.turn - b.turn) < 1e-6;
                            }),
                made_.end());
    const size_t n = planes_.vertical_angles_deg.size();
    std::vector<double> turns;
    std::vector<const double*> rows;
    for (const Plane& p : made_) {
      turns.push_back(p.turn);
      rows.push_back(planes_.candela.data() + p.row * n);
    }
    LightWeb web;
    web.name = name_;
    for (const double h : planes_.vertical_angles_deg)
      web.vertical_angles_rad.push_back(float(rad_from_deg(h)));
    // The web's seam is at 0. If no plane lies there, interpolate between the neighbours.
    const double gap = turns.front() + 360 - turns.back();
    const double share = turns.front() > 0 ? (360 - turns.back()) / gap : 1;
    const auto add_row = [&](double turn, const double* a, const double* b, double t) {
      web.horizontal_angles_rad.push_back(float(rad_from_deg(turn)));
      for (size_t j = 0; j < n; ++j) web.intensities.push_back(float(a[j] + (b[j] - a[j]) * t));
    };
    if (turns.front() > 0) add_row(0, rows.back(), rows.front(), share);
    for (size_t i = 0; i < turns.size(); ++i) add_row(turns[i], rows[i], rows[i], 0);
    add_row(360, rows.back(), rows.front(), share);
    web.horizontal_angles_rad.back() = 2 * pi_f;
    return web;
  }

  const Planes& planes_;
  WarningLog& warnings_;
  std::string name_;
  std::vector<Plane> made_;
};

}  // namespace

LightWeb unfold_planes(const Planes& planes, const std::string& name, WarningLog& warnings) {
  return Unfolder(planes, warnings, name).web();
}

namespace {

// A table together with its mirror image: angles, and the row or column of the original for each.
struct Mirrored {
  std::vector<double> angles;
  std::vector<size_t> from;
};

Mirrored mirrored(const std::vector<double>& angles) {
  Mirrored m;
  if (angles.front() == 0)
    for (size_t i = angles.size() - 1; i > 0; --i) {
      m.angles.push_back(-angles[i]);
      m.from.push_back(i);
    }
  for (size_t i = 0; i < angles.size(); ++i) {
    m.angles.push_back(angles[i]);
    m.from.push_back(i);
  }
  return m;
}

// Returns a web of rotational symmetry from one plane through the beam: the mean of both sides if
// the plane has two.
LightWeb round_beam(const Planes& planes, const std::string& name) {
  std::vector<double> heights, candela;
  const std::vector<double>& v = planes.vertical_angles_deg;
  const auto value_at = [&](double angle) {  // linear; -1 outside the table
    const auto above = std::lower_bound(v.begin(), v.end(), angle - 1e-9);
    if (above == v.end() || (above == v.begin() && *above > angle + 1e-9)) return -1.0;
    const auto i = size_t(above - v.begin());
    if (i == 0) return planes.candela[0];
    const double t = (angle - v[i - 1]) / (v[i] - v[i - 1]);
    return std::lerp(planes.candela[i - 1], planes.candela[i], t);
  };
  for (const double angle : v) heights.push_back(std::abs(angle));
  heights.push_back(0);
  std::sort(heights.begin(), heights.end());
  heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
  for (const double angle : heights) {
    const double a = value_at(angle), b = value_at(-angle);
    candela.push_back(a < 0 ? std::max(b, 0.0) : b < 0 ? a : (a + b) / 2);
  }
  LightWeb web;
  web.name = name;
  for (const double h : heights) web.vertical_angles_rad.push_back(float(rad_from_deg(h)));
  web.horizontal_angles_rad = {0, 2 * pi_f};
  for (int turn = 0; turn < 2; ++turn)
    for (const double c : candela) web.intensities.push_back(float(c));
  return web;
}

}  // namespace

LightWeb unfold_beam(const Planes& planes, WebPole pole, const std::string& name,
                     WarningLog& warnings) {
  if (planes.horizontal_angles_deg.size() == 1) return round_beam(planes, name);
  if (planes.vertical_angles_deg.front() == 0)
    warnings.add(name +
                 ": vertical angles begin at 0; the half below the beam mirrors the half above");
  const Mirrored v = mirrored(planes.vertical_angles_deg),
                 h = mirrored(planes.horizontal_angles_deg);
  // One of the two tables runs to the pole, the other around it.
  const bool is_up = pole == WebPole::up;
  const Mirrored &to_pole = is_up ? v : h, &round = is_up ? h : v;
  const size_t n = planes.vertical_angles_deg.size();
  LightWeb web;
  web.name = name;
  web.pole = pole;
  for (auto a = to_pole.angles.rbegin(); a != to_pole.angles.rend(); ++a)
    web.vertical_angles_rad.push_back(float(rad_from_deg(90 - *a)));
  for (size_t i = 0; i < round.angles.size(); ++i) {
    web.horizontal_angles_rad.push_back(float(rad_from_deg(round.angles[i])));
    for (auto from = to_pole.from.rbegin(); from != to_pole.from.rend(); ++from) {
      const size_t turn = is_up ? round.from[i] : *from, height = is_up ? *from : round.from[i];
      web.intensities.push_back(float(planes.candela[turn * n + height]));
    }
  }
  return web;
}

}  // namespace troffer
