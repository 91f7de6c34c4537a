// Photometric files in the variants that makers write. All editions, types, symmetries, units,
// layouts and line ends of LM-63 and EULUMDAT describe one distribution here, and must be read as
// that.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/random.h"
#include "base/units.h"
#include "import/luminaire/luminaire.h"
#include "import/temp_folder.h"
#include "light/web.h"

using namespace troffer;

namespace {

// The C planes that a file may omit by symmetry.
enum class Symmetry { none, round, about_c0, about_c90, both };
constexpr Symmetry symmetries[] = {Symmetry::none, Symmetry::round, Symmetry::about_c0,
                                   Symmetry::about_c90, Symmetry::both};

// Intensity in cd at angles of type C.
double candela(Symmetry s, double c_deg, double gamma_deg) {
  const double c = rad_from_deg(c_deg), g = rad_from_deg(gamma_deg);
  const double uneven = s == Symmetry::round       ? 0
                        : s == Symmetry::about_c0  ? .3 * std::cos(c)
                        : s == Symmetry::about_c90 ? .3 * std::sin(c)
                        : s == Symmetry::both      ? .2 * std::cos(2 * c)
                                                   : .3 * std::cos(c) + .2 * std::sin(c);
  return 1000 * (1.1 + std::cos(g)) * (1 + uneven * std::sin(g));
}

std::vector<double> steps(double first, double last, double step) {
  std::vector<double> v;
  for (int i = 0; first + i * step <= last; ++i) v.push_back(first + i * step);
  return v;
}

// Planes, every 15 degrees, that a file of this symmetry contains.
std::vector<double> planes_of(Symmetry s) {
  switch (s) {
    case Symmetry::round:
      return {0};
    case Symmetry::about_c0:
      return steps(0, 180, 15);
    case Symmetry::about_c90:
      return steps(90, 270, 15);
    case Symmetry::both:
      return steps(0, 90, 15);
    case Symmetry::none:
      break;
  }
  return steps(0, 360, 15);
}

const std::vector<double> heights = steps(0, 180, 10);

// Checks the intensity at all nodes of the full distribution, and its flux.
void check(const Luminaire& l, Symmetry s) {
  for (double c = 0; c < 360; c += 15)
    for (const double g : heights) {
      const double r = std::sin(rad_from_deg(g)), z = std::cos(rad_from_deg(g));
      const Vec3 w(Vec3d{r * std::cos(rad_from_deg(c)), r * std::sin(rad_from_deg(c)), z});
      CAPTURE(c);
      CAPTURE(g);
      CHECK(double(intensity(l.web, w)) == doctest::Approx(candela(s, c, g)).epsilon(1e-4));
    }
  // The non-uniform part integrates to zero over a turn.
  CHECK(flux(l.web) == doctest::Approx(4 * pi * 1100).epsilon(1e-2));
}

// Number layout of one program's output.
struct Layout {
  const char* separator;
  size_t per_line;
  const char* line_end;
  const char* format;

  std::string numbers(const std::vector<double>& v) const {
    std::string out;
    for (size_t i = 0; i < v.size(); ++i) {
      out += fmt::format(fmt::runtime(format), v[i]);
      out += (i + 1) % per_line == 0 || i + 1 == v.size() ? line_end : separator;
    }
    return out;
  }
};
constexpr Layout layouts[] = {
    {" ", 1000, "\n", "{:.7g}"},  {" ", 10, "\r\n", "{:.4f}"},    {",", 8, "\n", "{:.7g}"},
    {", ", 12, "\r\n", "{:.3f}"}, {"\t", 1, "\r", "{:.6e}"},      {"   ", 7, "\r\r\n", "{:10.4f}"},
    {" ", 1000, "\n", "{:+.7g}"}, {" ,  ", 5, "\n \n", "{:.5E}"}, {" ", 18, " \x1a\n", "{:.7g} "}};

struct Edition {
  const char *head, *tilt;
};
constexpr Edition editions[] = {
    {"", "TILT=NONE"},
    {"IESNA91\n[TEST] 12\n", "TILT=NONE"},
    {"IESNA:LM-63-1995\n[TEST] 12\n[MORE] two 2\n", "TILT = NONE "},
    {"IESNA:LM-63-2002\n[TESTLAB] TILTED lamps\n", "tilt=none"},
    {"IES:LM-63-2019\n[TEST]\n[FILEGENINFO] 1\n", "TILT=INCLUDE\n1\n3\n0 45 90\n1 .95 .9"},
    {"any text\nof a maker", "TILT=Include\n2\n0"},
    {"\xef\xbb\xbfIESNA:LM-63-2002", "TILT=NONE"}};

// An LM-63 file of type C. unit: 1 for feet, 2 for metres.
std::string ies(Symmetry s, const Edition& edition, const Layout& layout, int unit, bool descends) {
  const std::vector<double> planes = planes_of(s);
  std::vector<double> gammas = heights, candelas;
  if (descends) gammas.assign(heights.rbegin(), heights.rend());
  const double metre = unit == 1 ? 1 / .3048 : 1;
  // Factors multiply: 2 × .8 × 1.25 until 1991. Later editions reserve the third number, or use it
  // as a code in 2019: 2 × 1.
  const std::string_view head = edition.head;
  const bool is_coded = head.find("2019") != head.npos;
  const bool is_reserved =
      is_coded || head.find("1995") != head.npos || head.find("2002") != head.npos;
  std::string text = std::string(edition.head) + "\n" + edition.tilt + "\n";
  text += layout.numbers({2, 6911.5, 2, double(gammas.size()), double(planes.size()), 1,
                          double(unit), .6 * metre, 1.2 * metre, 0});
  text += layout.numbers({is_reserved ? 1 : .8, is_coded ? 1.1 : is_reserved ? 1 : 1.25, 99.5});
  text += layout.numbers(gammas) + layout.numbers(planes);
  for (const double c : planes) {
    std::vector<double> row;
    for (const double g : gammas) row.push_back(candela(s, c, g) / 2);
    text += layout.numbers(row);
  }
  return text;
}

// An EULUMDAT file; it always lists the planes of a full turn. Isym follows from the symmetry.
std::string ldt(Symmetry s, const char* line_end, bool has_commas, const char* after) {
  constexpr int count = 24;
  const int isym = s == Symmetry::none        ? 0
                   : s == Symmetry::round     ? 1
                   : s == Symmetry::about_c0  ? 2
                   : s == Symmetry::about_c90 ? 3
                                              : 4;
  // Stockmar's format: data begin at C0, or at C270 for Isym 3.
  const int first = isym == 3 ? 18 : 0;
  const int there = isym == 0 ? 24 : isym == 1 ? 1 : isym == 4 ? 7 : 13;
  std::vector<std::string> lines{"Maker", "1"};
  const auto add = [&](double v) {
    std::string line = fmt::format("{:.6g}", v);
    if (has_commas)
      for (char& c : line)
        if (c == '.') c = ',';
    lines.push_back(line + after);
  };
  for (const double v : {double(isym), double(count), 15.0, double(heights.size()), 10.0}) add(v);
  for (const char* line : {"no 1", "name of it", "12", "a.ldt", "2020-02-30"})
    lines.emplace_back(line);
  for (const double v : {1200.0, 600.0, 80.0, 1150.0, 550.0, 0.0, 0.0, 0.0, 0.0, 50.0, 100.0, .5})
    add(v);
  for (const double v : {0.0, 2.0}) add(v);
  for (const double lumens : {4 * pi * 1100, 9000.0}) {
    add(2);
    lines.emplace_back("LED");
    add(lumens);
    lines.emplace_back("3000");
    lines.emplace_back("1B");
    add(90);
  }
  for (int i = 0; i < 10; ++i) add(.1 * i);
  for (int i = 0; i < count; ++i) add(15 * i);
  for (const double g : heights) add(g);
  for (int i = 0; i < there; ++i)
    for (const double g : heights) add(candela(s, 15 * (first + i), g) / (4 * pi * 1.1) / .5);
  std::string text;
  for (const std::string& line : lines) text += line + line_end;
  return text;
}

}  // namespace

TEST_CASE("LM-63 of type C: any edition, symmetry, unit, layout and direction of angles") {
  for (const Symmetry s : symmetries)
    for (const Edition& edition : editions)
      for (const Layout& layout : layouts)
        for (const int unit : {1, 2}) {
          const bool descends = unit == 1 && layout.per_line == 10;
          WarningLog warnings;
          CAPTURE(int(s));
          CAPTURE(edition.tilt);
          CAPTURE(layout.format);
          const Luminaire l =
              read_luminaire_text("a.ies", ies(s, edition, layout, unit, descends), warnings);
          CHECK(warnings.entries().size() == (descends ? 1 : 0));
          CHECK(l.lamp_lumens == doctest::Approx(13823).epsilon(1e-6));
          CHECK(l.opening.size.x == doctest::Approx(1.2).epsilon(1e-3));
          CHECK(l.opening.size.y == doctest::Approx(.6).epsilon(1e-3));
          check(l, s);
        }
}

TEST_CASE("LM-63 of type C: half-planes that begin elsewhere") {
  WarningLog warnings;
  const auto read = [&](Symmetry s, const std::vector<double>& planes) {
    std::string text = "TILT=NONE\n" + layouts[0].numbers({1, -1, 1, double(heights.size()),
                                                           double(planes.size()), 1, 2, 0, 0, 0});
    text += "1 1 9\n" + layouts[0].numbers(heights) + layouts[0].numbers(planes);
    for (const double c : planes)
      for (const double g : heights) text += fmt::format("{:.7g}\n", candela(s, c, g));
    return read_luminaire_text("a.ies", text, warnings);
  };
  check(read(Symmetry::about_c0, steps(180, 360, 15)), Symmetry::about_c0);
  check(read(Symmetry::about_c90, steps(-90, 90, 15)), Symmetry::about_c90);
  check(read(Symmetry::none, steps(-180, 180, 15)), Symmetry::none);
  check(read(Symmetry::none, steps(0, 345, 15)), Symmetry::none);
  check(read(Symmetry::none, steps(15, 360, 15)), Symmetry::none);
  CHECK(warnings.entries().empty());
}

TEST_CASE("LM-63: decimal commas, UTF-16, and factors of 0") {
  const TempFolder folder;
  const Layout plain = layouts[0];
  WarningLog warnings;
  std::string text = ies(Symmetry::both, editions[2], plain, 2, false);
  std::string wide = "\xff\xfe";
  for (const char c : text) wide += std::string{c, '\0'};
  check(read_luminaire(folder.write("wide.ies", wide), warnings), Symmetry::both);
  CHECK(warnings.entries().empty());
  for (size_t i = text.find("NONE"); i < text.size(); ++i)
    if (text[i] == '.') text[i] = ',';
  check(read_luminaire_text("a.ies", text, warnings), Symmetry::both);
  CHECK(warnings.entries().size() == 1);
  // The multiplier and both ballast factors.
  text = ies(Symmetry::round, editions[0], plain, 2, false);
  text.replace(text.find(" 2 19"), 2, " 0");
  text.replace(text.find("0.8 1.25"), 8, "0 0");
  const Luminaire l = read_luminaire_text("a.ies", text, warnings);
  CHECK(double(intensity(l.web, {0, 0, 1})) == doctest::Approx(1050));
  CHECK(warnings.entries().size() == 2);
}

TEST_CASE("EULUMDAT: all symmetries, line ends, commas and text after numbers") {
  const TempFolder folder;
  for (const Symmetry s : symmetries)
    for (const char* line_end : {"\n", "\r\n", "\r", " \r\n", "\r\r\n"})
      for (const bool has_commas : {false, true})
        for (const char* after : {"", "  mm", "\t; note"}) {
          CAPTURE(int(s));
          CAPTURE(line_end);
          CAPTURE(after);
          WarningLog warnings;
          const Luminaire l =
              read_luminaire(folder.write("a.ldt", ldt(s, line_end, has_commas, after)), warnings);
          CHECK(warnings.entries().size() == (has_commas ? 1 : 0));
          CHECK(l.description == "name of it");
          CHECK(l.output_ratio == 1);
          CHECK(l.watts == 90);
          CHECK(l.opening.size.y == doctest::Approx(1.15));
          check(l, s);
        }
}
