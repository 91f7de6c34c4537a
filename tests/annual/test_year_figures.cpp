// Annual figures of short years whose values can be counted by hand.
#include "annual/year_figures.h"

#include <doctest/doctest.h>

#include <array>
#include <vector>

using namespace troffer;

namespace {

double at(const SensorFigures& f, SensorFigure which) {
  return f[size_t(which)];
}

// Ten hours with the sun up, of which eight are occupied, and two occupied hours of night.
YearTimes short_year() {
  YearTimes t;
  t.is_occupied = {1, 1, 1, 1, 1, 1, 1, 1, 0, 0};
  t.occupied = 10;
  t.is_daylight = {0, 1, 1, 1, 1, 1, 1, 0, 0, 0};
  t.daylight = 6;
  t.mornings = {2, 4};
  t.afternoons = {6};
  return t;
}

const std::vector<float> total{50, 100, 150, 299, 300, 3000, 3001, 6000, 9000, 10};
const std::vector<float> sun{0, 0, 0, 0, 0, 1000, 1001, 5000, 8000, 0};

}  // namespace

// Definitions as honeybee-radiance-postprocess has them (metrics.py): da counts from the threshold
// on, udi from 100 to 3000 lx inclusive, and hours of night below 100 lx.
TEST_CASE("figures of a sensor count hours") {
  const SensorFigures f = figures_of({total, total, sun}, short_year(), 1, {300});
  CHECK(at(f, SensorFigure::da) == doctest::Approx(40));  // 300, 3000, 3001, 6000
  const double partial = (50 + 100 + 150 + 299) / 300.0;
  CHECK(at(f, SensorFigure::cda) == doctest::Approx(10 * (4 + partial)));
  CHECK(at(f, SensorFigure::udi_fell_short) == doctest::Approx(30));  // 50 lx and the night
  CHECK(at(f, SensorFigure::udi_supplementary) == doctest::Approx(30));
  CHECK(at(f, SensorFigure::udi_autonomous) == doctest::Approx(20));
  CHECK(at(f, SensorFigure::udi_exceeded) == doctest::Approx(20));
  CHECK(at(f, SensorFigure::mean_lx) ==
        doctest::Approx((50 + 100 + 150 + 299 + 300 + 3000 + 3001 + 6000) / 10.0));
  CHECK(at(f, SensorFigure::exposure_klxh) == doctest::Approx(21.910));
  CHECK(at(f, SensorFigure::sun_hours) == 2);  // above 1000 lx, occupied
  CHECK(at(f, SensorFigure::daylight_100) == doctest::Approx(100));
  CHECK(at(f, SensorFigure::daylight_300) == doctest::Approx(50));
  CHECK(at(f, SensorFigure::daylight_750) == doctest::Approx(100 * 2 / 6.0));
  CHECK(at(f, SensorFigure::morning_lx) == doctest::Approx(225));
  CHECK(at(f, SensorFigure::afternoon_lx) == doctest::Approx(3001));
}

TEST_CASE("quarters of an hour count as such") {
  const SensorFigures f = figures_of({total, total, sun}, short_year(), 4, {300});
  CHECK(at(f, SensorFigure::sun_hours) == doctest::Approx(0.5));
  CHECK(at(f, SensorFigure::exposure_klxh) == doctest::Approx(21.910 / 4));
  CHECK(at(f, SensorFigure::da) == doctest::Approx(40));
}

// Student's t for 95 %, over 1.96: 3.182 with three degrees of freedom, 12.706 with one.
TEST_CASE("the error is that of the mean of replicates, for intervals of 95 %") {
  const std::array values{1.0, 2.0, 3.0, 4.0};  // standard deviation √(5/3)
  const YearFigure f = with_spread(2.4, values);
  CHECK(f.value == 2.4);
  CHECK(f.error == doctest::Approx(std::sqrt(5.0 / 3) / 2 * 3.182 / 1.96).epsilon(0.004));
}

// LM-83 and EN 17037 assess sunlight and provision without movable shading.
TEST_CASE("blinds count for autonomy but not for sunlight, EN 17037 and LEED option 2") {
  const std::vector<float> shaded(10, 40.0f);
  const SensorFigures f = figures_of({shaded, total, sun}, short_year(), 1, {300});
  CHECK(at(f, SensorFigure::da) == 0);
  CHECK(at(f, SensorFigure::da_open) == doctest::Approx(40));
  CHECK(at(f, SensorFigure::udi_fell_short) == doctest::Approx(100));
  CHECK(at(f, SensorFigure::mean_lx) == doctest::Approx(32));
  CHECK(at(f, SensorFigure::exposure_klxh) == doctest::Approx(0.4));
  CHECK(at(f, SensorFigure::sun_hours) == 2);
  CHECK(at(f, SensorFigure::daylight_300) == doctest::Approx(50));
  CHECK(at(f, SensorFigure::morning_lx) == doctest::Approx(225));
}

TEST_CASE("figures of a grid are shares of its sensors") {
  FigureTable table(4, 2);
  for (size_t s = 0; s < 4; ++s)
    for (size_t set = 0; set < 3; ++set) {
      SensorFigures& f = table.at(s, set);
      f[size_t(SensorFigure::da)] = s == 0 ? 49.9 : 50;
      f[size_t(SensorFigure::sun_hours)] = s == 3 ? 250 : 249;
      f[size_t(SensorFigure::daylight_300)] = s < 2 ? 60 : 40;
      f[size_t(SensorFigure::morning_lx)] = 500;
      f[size_t(SensorFigure::afternoon_lx)] = s == 1 ? 3001 : 3000;
    }
  const GridResult r = grid_result(table, 0, 4, true);
  const auto value = [&](const std::string& key) {
    for (const GridFigure& f : r.figures)
      if (f.key == key) return f.figure.value;
    return -1.0;
  };
  CHECK(value("sda") == 75);
  CHECK(value("ase") == 25);
  CHECK(value("leed_option_2") == 75);
  const auto verdict = [&](const std::string& title) {
    for (const GridRequirement& q : r.requirements)
      if (q.title == title) return q.verdict;
    FAIL("no requirement " << title);
    return YearVerdict::undecided;
  };
  CHECK(verdict("LEED v4.1 option 1, 3 points: sDA") == YearVerdict::met);  // 75 of 75 %
  CHECK(verdict("LEED v4.1 option 1: ASE") == YearVerdict::not_met);
  CHECK(verdict("LEED v4.1 option 2, 3 points: 300 to 3000 lx at 9 and 15 h") ==
        YearVerdict::not_met);
  CHECK(verdict("EN 17037 minimum: 300 lx in half of the daylight hours") == YearVerdict::met);
  CHECK(level_reached(r, YearScheme::leed_option_1).sure == 3);
  CHECK(level_reached(r, YearScheme::leed_option_2).sure == 2);
  CHECK(level_reached(r, YearScheme::leed_ase).possible == 0);
}

TEST_CASE("a level needs all of its requirements, and undecided ones leave it open") {
  const auto level = [](const std::vector<std::pair<int, YearVerdict>>& verdicts) {
    GridResult r;
    for (const auto& [number, v] : verdicts)
      r.requirements.push_back({YearScheme::en_17037, number, "", "", {}, v});
    const ReachedLevel reached = level_reached(r, YearScheme::en_17037);
    return std::pair(reached.sure, reached.possible);
  };
  using enum YearVerdict;
  CHECK(level({{1, met}, {1, met}, {2, met}, {2, not_met}}) == std::pair(1, 1));
  CHECK(level({{1, met}, {1, undecided}}) == std::pair(0, 1));
  CHECK(level({{1, not_met}, {1, undecided}}) == std::pair(0, 0));
  CHECK(level({{1, met}, {2, undecided}, {3, not_met}}) == std::pair(1, 2));
  const YearFigure joint =
      joint_figure(std::vector<YearFigure>{{40, 1}, {80, 3}}, std::vector<size_t>{30, 10});
  CHECK(joint.value == doctest::Approx(50));
  CHECK(joint.error == doctest::Approx(1.5));
}

TEST_CASE("replicates that agree have no error") {
  const std::vector<double> same(8, 100.0 * 29 / 30);
  CHECK(with_spread(same[0], same).error == 0);
}

TEST_CASE("a requirement within the error of its limit is undecided") {
  FigureTable table(2, 2);
  for (size_t set = 0; set < 3; ++set)  // the replicates disagree about one of two sensors
    for (size_t s = 0; s < 2; ++s)
      table.at(s, set)[size_t(SensorFigure::da)] = s == 0 || set == 2 ? 60 : 40;
  const GridResult r = grid_result(table, 0, 2, false);
  CHECK(r.requirements[0].figure.value == 50);
  CHECK(r.requirements[0].figure.error ==
        doctest::Approx(25 * 12.706 / 1.96).epsilon(0.004));   // of 50 and 100 %
  CHECK(r.requirements[0].verdict == YearVerdict::undecided);  // at least 40 %
}
