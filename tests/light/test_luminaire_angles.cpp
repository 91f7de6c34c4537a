// Angles in photometric files: end angles changed by rounding, tables without a pole, and the
// LM-63-2019 file generation type.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "import/luminaire/luminaire.h"
#include "import/temp_folder.h"
#include "light/web.h"

using namespace troffer;

namespace {

struct Read {
  Luminaire luminaire;
  size_t warnings = 0;
};

Read read(const std::string& text, const std::string& name = "a.ies") {
  const TempFolder folder;
  WarningLog warnings;
  Read r;
  r.luminaire = read_luminaire(folder.write(name, text), warnings);
  r.warnings = warnings.entries().size();
  return r;
}

// An IES file with three heights and one plane per value. Each plane has 5 cd at the nadir, `value`
// in the middle and 0 at the end.
std::string quarter(const std::string& heights, const std::string& turns,
                    const std::vector<int>& values, int type = 1) {
  std::string text =
      fmt::format("IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 {} {} 2 0 0 0\n1 1 10\n{}\n{}\n",
                  values.size(), type, heights, turns);
  for (const int v : values) text += fmt::format("5 {} 0\n", v);
  return text;
}

// Intensity in the C plane turn_deg, at height_deg from the nadir (type C).
double candela(const Luminaire& l, double turn_deg, double height_deg) {
  const double t = rad_from_deg(turn_deg), h = rad_from_deg(height_deg);
  return double(intensity(
      l.web, Vec3(Vec3d{std::sin(h) * std::cos(t), std::sin(h) * std::sin(t), std::cos(h)})));
}

std::string even_ies(const std::string& edition, const std::string& generation) {
  return edition + "\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 " + generation + " 10\n0 90\n0\n100 100\n";
}

}  // namespace

// ANSI/IES LM-63-19: the number between ballast factor and watts is the file generation type.
TEST_CASE("LM-63-2019: the file generation type is a code; in older editions a factor") {
  for (const char* edition : {"IES:LM-63-2019", "IESNA:LM-63-2019", "IES:LM-63-19",
                              "ies:lm-63-2019", "\nIES:LM-63-2019", "\xef\xbb\xbfIES:LM-63-2019"})
    for (const char* code :
         {"1.00000", "1.00001", "1.00010", "1.00100", "1.01000", "1.10000", "1.11100", "1"}) {
      CAPTURE(edition);
      CAPTURE(code);
      const Read r = read(even_ies(edition, code));
      CHECK(candela(r.luminaire, 0, 30) == doctest::Approx(100));
      CHECK(flux(r.luminaire.web) == doctest::Approx(200 * pi).epsilon(1e-5));
      CHECK(r.warnings == 0);
    }
  // Not a code of the standard: it is no factor either, and causes a warning.
  const Read odd = read(even_ies("IES:LM-63-2019", "0.9"));
  CHECK(candela(odd.luminaire, 0, 30) == doctest::Approx(100));
  CHECK(odd.warnings == 1);
  // The ballast-lamp photometric factor of 1986 and 1991; reserved in 1995 and 2002.
  for (const auto& [edition, warnings] : {std::pair<const char*, size_t>{"IESNA91", 0},
                                          {"", 0},
                                          {"IESNA:LM-63-1995", 1},
                                          {"IESNA:LM-63-2002", 1}}) {
    CAPTURE(edition);
    const Read r = read(even_ies(edition, "0.9"));
    CHECK(candela(r.luminaire, 0, 30) == doctest::Approx(90));
    CHECK(r.warnings == warnings);
  }
}

TEST_CASE("absolute photometry is distinguished from lamps without lumens") {
  CHECK(read(even_ies("IESNA:LM-63-2002", "1")).luminaire.is_absolute);
  std::string relative = even_ies("IESNA:LM-63-2002", "1");
  relative.replace(relative.find("1 -1"), 4, "1 800");
  CHECK_FALSE(read(relative).luminaire.is_absolute);
}

TEST_CASE("type C: planes that end near 90 or 180 keep the symmetry") {
  for (const char* turns : {"0 45 90", "0 45 89.99", "0 45 90.01", "0.01 45 90", "0 45 89.5",
                            "-0.01 45 90", "90 45 0", "89.99 45 0.01"}) {
    CAPTURE(turns);
    const bool descends = turns[0] != '0' && turns[0] != '-';
    const Read r = read(quarter("0 45 90", turns,
                                descends ? std::vector<int>{20, 15, 10} : std::vector{10, 15, 20}));
    for (const auto& [turn, value] :
         {std::pair{0, 10}, {90, 20}, {180, 10}, {270, 20}, {135, 15}, {315, 15}})
      CHECK(candela(r.luminaire, turn, 45) == doctest::Approx(value).epsilon(1e-3));
  }
  for (const char* turns : {"0 90 180", "0 90 179.99", "0 90 180.01", "0.01 90 180", "180 270 360",
                            "180.01 270 359.99", "180 270 360.01"}) {
    CAPTURE(turns);
    const Read r = read(quarter("0 45 90", turns, {10, 15, 20}));
    const bool is_upper = turns[1] == '8';
    CHECK(candela(r.luminaire, is_upper ? 180 : 0, 45) == doctest::Approx(10).epsilon(1e-3));
    CHECK(candela(r.luminaire, is_upper ? 0 : 180, 45) == doctest::Approx(20).epsilon(1e-3));
    CHECK(candela(r.luminaire, 90, 45) == doctest::Approx(15).epsilon(1e-3));
    CHECK(candela(r.luminaire, 270, 45) == doctest::Approx(15).epsilon(1e-3));
    CHECK(r.warnings == 0);
  }
  for (const char* turns : {"-90 0 90", "-89.99 0 90.01"}) {
    const Read r = read(quarter("0 45 90", turns, {10, 15, 20}));
    CHECK(candela(r.luminaire, 270, 45) == doctest::Approx(10).epsilon(1e-3));
    CHECK(candela(r.luminaire, 180, 45) == doctest::Approx(15).epsilon(1e-3));
  }
  // Planes of a full turn.
  const Read round = read(quarter("0 45 90", "0.01 90 180 270 360.01", {10, 15, 20, 25, 10}));
  CHECK(candela(round.luminaire, 270, 45) == doctest::Approx(25).epsilon(1e-3));
  CHECK(round.warnings == 0);
}

TEST_CASE("planes in steps below two degrees are not taken for a nearby end") {
  // 90 planes, one per degree: the last is at 89, so no plane closes the quarter.
  std::string turns;
  std::vector<int> values;
  for (int i = 0; i < 90; ++i) {
    turns += fmt::format("{} ", i);
    values.push_back(10 + i);
  }
  const Read r = read(quarter("0 45 90", turns, values));
  CHECK(candela(r.luminaire, 89, 45) == doctest::Approx(99).epsilon(1e-3));
  CHECK(r.warnings == 1);  // planes do not close a turn
  // 360 planes close a full turn.
  turns.clear();
  values.clear();
  for (int i = 0; i < 360; ++i) {
    turns += fmt::format("{}\n", i);
    values.push_back(10 + i);
  }
  const Read all = read(quarter("0 45 90", turns, values));
  CHECK(candela(all.luminaire, 359, 45) == doctest::Approx(369).epsilon(1e-3));
  CHECK(all.warnings == 0);
}

TEST_CASE("vertical angles that begin near the nadir are extended to it") {
  const auto at_nadir = [](const std::string& heights, size_t& warnings) {
    const Read r = read("IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 10\n" + heights +
                        "\n0\n100 100 100\n");
    warnings = r.warnings;
    return candela(r.luminaire, 0, 0);
  };
  size_t warnings = 0;
  for (const char* heights : {"0 45 90", "0.01 45 90", "0.1 45 90", "-0.01 45 90"}) {
    CAPTURE(heights);
    CHECK(at_nadir(heights, warnings) == doctest::Approx(100));
    CHECK(warnings == 0);
  }
  for (const char* heights : {"1 45 90", "2.5 45 90", "5 45 90", "7.5 22.5 90"}) {
    CAPTURE(heights);
    CHECK(at_nadir(heights, warnings) == doctest::Approx(100));
    CHECK(warnings == 1);
  }
  // A gap that the table's steps do not explain stays dark and causes a warning.
  CHECK(at_nadir("30 45 90", warnings) == 0);
  CHECK(warnings == 1);
  // Distributions above the horizontal have no nadir.
  CHECK(at_nadir("90 135 180", warnings) == 0);
  CHECK(warnings == 0);
  CHECK(at_nadir("90.01 135 179.99", warnings) == 0);
  CHECK(warnings == 0);
}

TEST_CASE("a table at zone centres has the flux of its zones") {
  // A uniform hemisphere of 100 cd: 200 pi lm.
  std::string heights, values;
  for (int i = 0; i < 18; ++i) {
    heights += fmt::format("{} ", 2.5 + 5 * i);
    values += "100 ";
  }
  const Read r = read("IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 18 1 1 2 0 0 0\n1 1 10\n" + heights +
                      "\n0\n" + values + "\n");
  CHECK(flux(r.luminaire.web) == doctest::Approx(200 * pi).epsilon(1e-5));
  CHECK(r.warnings == 2);  // one for each end
  CHECK(candela(r.luminaire, 0, 91) == 0);
}

TEST_CASE("types A and B: angles that begin near 0 apply to both sides") {
  for (const int type : {2, 3}) {
    CAPTURE(type);
    const auto web_of = [&](const std::string& heights, const std::string& turns) {
      return read(quarter(heights, turns, {10, 15, 20}, type)).luminaire.web;
    };
    const double lumens = flux(web_of("0 45 90", "0 45 90"));
    CHECK(lumens > 10);
    for (const char* heights : {"0.01 45 90", "0 45 89.99", "0 45 90.01", "-0.01 45 90"})
      CHECK(flux(web_of(heights, "0 45 90")) == doctest::Approx(lumens).epsilon(1e-3));
    for (const char* turns : {"0.01 45 90", "0 45 89.99", "0 45 90.01"})
      CHECK(flux(web_of("0 45 90", turns)) == doctest::Approx(lumens).epsilon(1e-3));
    // Angles begin at 2.5: the gap up to there takes the first value.
    CHECK(flux(web_of("2.5 45 90", "0 45 90")) == doctest::Approx(lumens).epsilon(0.1));
    CHECK(flux(web_of("0 45 90", "2.5 45 90")) == doctest::Approx(lumens).epsilon(0.1));
  }
}

TEST_CASE("EULUMDAT: symmetry and nadir with slightly wrong angles") {
  const auto ldt = [](int symmetry, const std::vector<double>& turns, const std::string& heights,
                      const std::vector<std::string>& values) {
    std::string text = fmt::format(
        "maker\n1\n{}\n{}\n90\n2\n90\nreport\nname\nnumber\nfile\ndate\n", symmetry, turns.size());
    text += "0\n0\n0\n0\n0\n0\n0\n0\n0\n100\n100\n1\n0\n1\n1\nLED\n1000\n4000\n80\n20\n";
    for (int i = 0; i < 10; ++i) text += "0.5\n";
    for (const double t : turns) text += fmt::format("{}\n", t);
    text += heights;
    for (const std::string& v : values) text += v + "\n";
    return read(text, "a.ldt");
  };
  for (const auto& turns :
       {std::vector<double>{0, 90, 180, 270}, {0, 89.99, 180, 270}, {0.01, 90.01, 180, 270}}) {
    const Read r = ldt(4, turns, "0\n90\n", {"10", "0", "20", "0"});
    for (const auto& [turn, value] : {std::pair{0, 10}, {90, 20}, {180, 10}, {270, 20}})
      CHECK(candela(r.luminaire, turn, 0.001) == doctest::Approx(value).epsilon(1e-3));
  }
  const Read half = ldt(2, {0, 90, 179.99, 270}, "0\n90\n", {"10", "0", "20", "0", "30", "0"});
  CHECK(candela(half.luminaire, 270, 0.001) == doctest::Approx(20).epsilon(1e-3));
  CHECK(candela(half.luminaire, 180, 0.001) == doctest::Approx(30).epsilon(1e-3));
  for (const char* heights : {"0.01\n90\n", "2.5\n89.99\n", "0\n90.01\n"}) {
    const Read r = ldt(1, {0, 90, 180, 270}, heights, {"10", "10"});
    CAPTURE(heights);
    CHECK(flux(r.luminaire.web) == doctest::Approx(20 * pi).epsilon(1e-3));
  }
}

TEST_CASE("angles beyond what rounding explains are refused") {
  for (const char* turns : {"0 45 362", "0 45 90.0 ", "-185 0 90"}) {
    CAPTURE(turns);
    const std::string text = quarter("0 45 90", turns, {10, 15, 20});
    if (std::string(turns) == "0 45 90.0 ")
      CHECK_NOTHROW(read(text));
    else
      CHECK_THROWS_AS(read(text), InputError);
  }
  CHECK_THROWS_AS(read(quarter("0 45 182", "0 45 90", {10, 15, 20})), InputError);
  CHECK_THROWS_AS(read(quarter("-2 45 90", "0 45 90", {10, 15, 20})), InputError);
  // Within a degree of the end, but farther than half a step.
  CHECK_THROWS_AS(read(quarter("0 179.9 180.8", "0 45 90", {10, 15, 20})), InputError);
}
