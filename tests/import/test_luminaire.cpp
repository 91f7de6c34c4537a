// Tests of photometric files: their content, tolerated errors, and ten thousand mutations.
#include "import/luminaire/luminaire.h"

#include <doctest/doctest.h>

#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "import/luminaire/attach_luminaire.h"
#include "support/beam_ies.h"
#include "temp_folder.h"

using namespace troffer;
using namespace troffer::test;

namespace test_luminaire {

namespace {

// Returns a diffuse disc of 1000 cd, which is 1000 pi lm.
std::string cosine_ies(const std::string& head = "IESNA:LM-63-2002\n") {
  std::string text = head +
                     "[TEST] none\n[LUMINAIRE] even disc\nTILT=NONE\n1 4000 1 19 1 1 2 0.6 "
                     "1.2 0\n1 1 40\n";
  for (int i = 0; i <= 18; ++i) text += std::to_string(5 * i) + " ";
  text += "\n0\n";
  for (int i = 0; i <= 18; ++i)
    text += std::to_string(1000 * std::cos(rad_from_deg(5.0 * i))) + (i % 7 == 6 ? "\n" : " ");
  return text + "\n";
}

// Returns planes by C angle with two gamma angles each: 100 + C at the nadir, 0 at 90 degrees.
std::string planes_ies(const std::vector<int>& turns) {
  std::string text =
      "IESNA91\nTILT=NONE\n1 -1 1 2 " + std::to_string(turns.size()) + " 1 1 1 1 0 1 1 10\n0 90\n";
  for (const int t : turns) text += std::to_string(t) + ",";
  text += "\n";
  for (const int t : turns) text += std::to_string(100 + t) + " 0\n";
  return text;
}

std::string ldt(int symmetry, int planes, const std::vector<std::string>& values,
                const std::string& lumens = "2000") {
  std::string text = "maker\n1\n" + std::to_string(symmetry) + "\n" + std::to_string(planes) +
                     "\n" + std::to_string(360 / planes) +
                     "\n2\n90\nreport\nname of it\nnumber\nfile\n"
                     "date\n600\n600\n80\n550\n500\n0\n0\n0\n0\n100\n80,5\n1\n0\n1\n1\nLED\n" +
                     lumens + "\n4000\n80\n20\n";
  for (int i = 0; i < 10; ++i) text += "0.5\n";
  for (int i = 0; i < planes; ++i) text += std::to_string(i * 360 / planes) + "\n";
  text += "0\n90\n";
  for (const std::string& v : values) text += v + "\n";
  return text;
}

Luminaire read(const std::string& text, const std::string& name = "a.ies") {
  const TempFolder folder;
  WarningLog warnings;
  return read_luminaire(folder.write(name, text), warnings);
}

// Returns the intensity at the nadir in the plane at `turn_deg`.
double nadir(const Luminaire& l, double turn_deg) {
  for (size_t i = 0; i < l.web.horizontal_angles_rad.size(); ++i)
    if (std::abs(double(l.web.horizontal_angles_rad[i]) - rad_from_deg(turn_deg)) < 1e-4)
      return double(l.web.intensities[i * l.web.vertical_angles_rad.size()]);
  return -1;
}

bool is_whole(const LightWeb& web) {
  if (web.vertical_angles_rad.size() < 2 || web.horizontal_angles_rad.size() < 2) return false;
  if (web.pole == WebPole::nadir &&
      (web.horizontal_angles_rad.front() != 0 || web.horizontal_angles_rad.back() != 2 * pi_f))
    return false;
  for (size_t i = 1; i < web.horizontal_angles_rad.size(); ++i)
    if (!(web.horizontal_angles_rad[i] > web.horizontal_angles_rad[i - 1])) return false;
  for (size_t i = 1; i < web.vertical_angles_rad.size(); ++i)
    if (!(web.vertical_angles_rad[i] > web.vertical_angles_rad[i - 1])) return false;
  for (const float v : web.intensities)
    if (!(v >= 0) || !std::isfinite(v)) return false;
  return web.intensities.size() ==
         web.vertical_angles_rad.size() * web.horizontal_angles_rad.size();
}

}  // namespace

TEST_CASE("LM-63: the contents of files of any edition") {
  for (const char* head : {"IESNA:LM-63-2002\n", "IESNA91\n", "IES:LM-63-2019\r\n", ""}) {
    const Luminaire l = read(cosine_ies(head));
    CHECK(l.description == "even disc");
    CHECK(l.lamp_lumens == 4000);
    CHECK(l.watts == 40);
    CHECK(l.opening.size.x == doctest::Approx(1.2));
    CHECK(l.opening.size.y == doctest::Approx(0.6));
    CHECK_FALSE(l.opening.is_round[0]);
    CHECK(is_whole(l.web));
    CHECK(l.web.vertical_angles_rad.size() == 19);
    CHECK(double(l.web.intensities[12]) == doctest::Approx(500));
  }
}

TEST_CASE("LM-63: the edition decides the meaning of a negative dimension") {
  for (const auto& [head, is_old] : {std::pair{"IESNA:LM-63-1995", true},
                                     {"IESNA91", true},
                                     {"IESNA:LM-63-1986", true},
                                     {"", true},
                                     {"IESNA:LM-63-2002", false},
                                     {"IESNA:LM-63-02 ", false},
                                     {"IES:LM-63-2019", false},
                                     {"IES:LM-63-19", false}}) {
    const Luminaire l =
        read(std::string(head) + "\nTILT=NONE\n1 -1 1 2 1 1 2 -.3 .6 -.2\n1 1 9\n0 90\n0\n5 5\n");
    CAPTURE(head);
    CHECK(l.opening.is_round[0] == is_old);  // an ellipsoid, or a horizontal cylinder
    CHECK(l.opening.is_round[1]);
  }
}

TEST_CASE("LM-63: surplus intensities cause a warning") {
  const TempFolder folder;
  const auto warnings_of = [&](const std::string& text) {
    WarningLog warnings;
    read_luminaire(folder.write("more.ies", text), warnings);
    return warnings.entries().size();
  };
  const size_t usual = warnings_of(cosine_ies());
  CHECK(warnings_of(cosine_ies() + "\n[END] of 2 pages\n") == usual);
  for (const char* more : {" 7", "\n7 8.5\n"}) {
    std::string text = cosine_ies();
    while (text.back() == '\n') text.pop_back();
    CHECK(warnings_of(text + more) == usual + 1);
  }
}

TEST_CASE("planes omitted by symmetry are added") {
  const Luminaire quarter = read(planes_ies({0, 30, 90}));
  for (const auto& [turn, value] : {std::pair{0, 100},
                                    {30, 130},
                                    {90, 190},
                                    {150, 130},
                                    {180, 100},
                                    {210, 130},
                                    {270, 190},
                                    {330, 130},
                                    {360, 100}})
    CHECK(nadir(quarter, turn) == value);
  const Luminaire half = read(planes_ies({0, 45, 180}));
  CHECK(nadir(half, 45) == 145);
  CHECK(nadir(half, 315) == 145);
  CHECK(nadir(half, 360) == 100);
  const Luminaire other = read(planes_ies({90, 120, 270}));
  CHECK(nadir(other, 120) == 220);
  CHECK(nadir(other, 60) == 220);
  CHECK(nadir(other, 270) == 370);
  const Luminaire all = read(planes_ies({0, 90, 180, 270, 360}));
  CHECK(nadir(all, 270) == 370);
  const Luminaire open = read(planes_ies({0, 90, 180, 270}));
  CHECK(nadir(open, 360) == 100);
  for (const Luminaire* l : {&quarter, &half, &other, &all, &open}) CHECK(is_whole(l->web));

  const TempFolder folder;
  for (const auto& [turns, is_open] : {std::pair{std::vector<int>{0, 90, 180, 270}, false},
                                       {{10, 100, 190, 280}, false},
                                       {{0, 30, 60}, true}}) {
    WarningLog warnings;
    read_luminaire(folder.write("a.ies", planes_ies(turns)), warnings);
    CHECK(warnings.entries().empty() != is_open);
  }
}

TEST_CASE("EULUMDAT: symmetries, lumens, decimal commas") {
  Luminaire l = read(ldt(1, 4, {"250,5", "0"}), "a.LDT");
  CHECK(l.description == "name of it");
  CHECK(l.opening.size.y == doctest::Approx(0.55));  // along C90
  CHECK(l.opening.size.x == doctest::Approx(0.5));
  CHECK(nadir(l, 0) == 501);
  l = read(ldt(0, 4, {"1", "0", "2", "0", "3", "0", "4", "0"}), "a.ldt");
  CHECK(nadir(l, 90) == 4);
  CHECK(nadir(l, 270) == 8);
  l = read(ldt(2, 4, {"1", "0", "2", "0", "3", "0"}), "a.ldt");
  CHECK(nadir(l, 270) == 4);
  l = read(ldt(3, 4, {"1", "0", "2", "0", "3", "0"}), "a.ldt");  // C270, C0, C90
  CHECK(nadir(l, 270) == 2);
  CHECK(nadir(l, 0) == 4);
  CHECK(nadir(l, 180) == 4);
  CHECK(nadir(l, 90) == 6);
  l = read(ldt(4, 4, {"1", "0", "2", "0"}), "a.ldt");
  CHECK(nadir(l, 180) == 2);
  CHECK(nadir(l, 270) == 4);
  CHECK(is_whole(l.web));
}

TEST_CASE("factors of tilted lamps: in the file, beside it, nowhere") {
  const std::string factors = "1\n3\n0 45 90\n.9 .8 .6\n";
  const TempFolder folder;
  folder.write("lamp.tlt", factors);
  WarningLog warnings;
  for (const std::string& tilt : {"INCLUDE\n" + factors, std::string("lamp.tlt\n")}) {
    const Luminaire l = read_luminaire(
        folder.write("a.ies", "TILT=" + tilt + "1 -1 1 2 1 1 2 0 0 0\n1 1 9\n0 90\n0\n5 5\n"),
        warnings);
    CHECK(tilt_factor(l, 0) == doctest::Approx(.9));
    CHECK(tilt_factor(l, 60) == doctest::Approx(.8 - .2 / 3));
    CHECK(tilt_factor(l, 180) == doctest::Approx(.6));
    Scene s;
    const int32_t web = add_web(s, l);
    add_luminaire(s, "one", l, web, Rgb{1}, {{}, {1, 0, -1}, {0, 1, 0}, {0, 0, -1}});
    CHECK(double(s.lights[0].radiance.g) == doctest::Approx(.8));
  }
  CHECK(warnings.entries().empty());
  for (const char* name : {"gone.tlt", "../lamp.tlt"}) {
    WarningLog one;
    const Luminaire l =
        read_luminaire(folder.write("a.ies", "TILT=" + std::string(name) +
                                                 "\n1 -1 1 2 1 1 2 0 0 0\n1 1 9\n0 90\n0\n5 5\n"),
                       one);
    CHECK(tilt_factor(l, 0) == 1);
    CHECK(one.entries().size() == 1);
  }
}

TEST_CASE("photometric files that cannot be used are errors with a place") {
  const TempFolder folder;
  WarningLog warnings;
  const auto line_of = [&](const std::string& text, const std::string& name) {
    try {
      read_luminaire(folder.write(name, text), warnings);
    } catch (const InputError& error) {
      return error.line();
    }
    return -1;
  };
  CHECK(line_of("", "a.ies") >= 1);
  CHECK(line_of("hello\nworld\n", "a.ies") == 2);
  CHECK(line_of("TILT=NONE\n1 1 1 2 1 4 1 1 1 1 1 1 1\n0 90\n0\n1 1\n", "a.ies") == 2);
  CHECK(line_of("TILT=NONE\n1 1 1 2 1 2 1 1 1 1 1 1 1\n0 120\n0\n1 1\n", "a.ies") == 3);
  CHECK(line_of("TILT=INCLUDE\n1\n2\n90 0\n1 1\n", "a.ies") == 5);
  CHECK(line_of("TILT=NONE\n1 1 1 2 1 1 1 1 1 1 1 1 1\n0 90\n0\n0 0\n", "a.ies") == 5);
  CHECK(line_of("TILT=NONE\n1 1 1 2 1 1 1 1 1 1 1 1 1\n90 90\n0\n1 0\n", "a.ies") == 3);
  CHECK(line_of("TILT=NONE\n1 1 1 99999 99999 1 1 1 1 1 1 1 1\n0 90\n", "a.ies") == 2);
  CHECK(line_of("TILT=NONE\n1 1 1 2 1 1 1 1 1 1 1 1 1\n0 90\n0\n1 x\n", "a.ies") == 5);
  CHECK(line_of(ldt(1, 4, {"1"}), "a.ldt") > 40);
  CHECK(line_of(ldt(1, 4, {"1", "0"}, "0"), "a.ldt") > 40);
  CHECK_THROWS_AS(read_luminaire("/nonexistent/a.ies", warnings), InputError);
}

TEST_CASE("three thousand mutated files load completely or fail as expected") {
  const TempFolder folder;
  const std::string originals[] = {cosine_ies(),
                                   planes_ies({0, 30, 90}),
                                   planes_ies({0, 90, 180, 270, 360}),
                                   beam_ies(2, {-90, -45, 0, 45, 90}, {-90, 0, 90}),
                                   beam_ies(3, {0, 45, 90}, {0}),
                                   cosine_ies("TILT=INCLUDE\n1\n3\n0 45 90\n1 .9 .8\n"),
                                   ldt(0, 4, {"1", "0", "2", "0", "3", "0", "4", "0"}),
                                   ldt(3, 4, {"1", "0", "2", "0", "3", "0"})};
  const char alphabet[] = "0123456789.,-+eE \n\t=xTILT\xff\0[]";
  Random random(77);
  const auto below = [&](size_t n) { return size_t(random.next_u32()) % n; };
  int loaded = 0, refused = 0;
  for (int i = 0; i < 3000; ++i) {
    const size_t which = below(std::size(originals));
    std::string text = originals[which];
    for (size_t edits = 1 + below(6); edits > 0 && !text.empty(); --edits) {
      const size_t at = below(text.size());
      const char c = alphabet[below(sizeof(alphabet) - 1)];
      const size_t kind = below(5);
      if (kind == 0) text[at] = c;
      if (kind == 1) text.insert(at, 1, c);
      if (kind == 2) text.erase(at, 1 + below(5));
      if (kind == 3) text.resize(at);
      if (kind == 4) text.insert(at, text.substr(below(text.size()), below(40)));
    }
    WarningLog warnings;
    try {
      const Luminaire l =
          read_luminaire(folder.write(which < 6 ? "m.ies" : "m.ldt", text), warnings);
      REQUIRE(is_whole(l.web));
      ++loaded;
    } catch (const InputError&) {
      ++refused;
    }
  }
  CHECK(loaded > 150);
  CHECK(refused > 150);
}

TEST_CASE("a luminaire replaces a point or a flat mesh and nothing else") {
  const Luminaire l = read(cosine_ies());
  Scene s;
  s.materials.emplace_back();
  Mesh m;
  m.name = "panel";
  m.positions = {{0, 0, 3}, {0, 1, 3}, {2, 1, 3}, {2, 0, 3}};
  m.triangles = {{0, 1, 2}, {0, 2, 3}};
  s.meshes.push_back(m);
  m.name = "roof";
  m.positions[0].z = 5;
  s.meshes.push_back(m);
  Light point;
  point.name = "bulb";
  point.kind = LightKind::point;
  s.lights.push_back(point);
  attach_luminaire(s, "bulb", l, Rgb{2}, {0, 0, -1});
  CHECK(s.lights[0].web == 0);
  CHECK(s.lights[0].axes[2] == Vec3{0, 0, -1});
  attach_luminaire(s, "panel", l, Rgb{2}, {0, 0, -1});
  REQUIRE(s.lights.size() == 2);
  const Light& e = s.lights[1];
  CHECK(e.web == 1);
  CHECK(e.kind == LightKind::polygon);
  CHECK(e.radiance == Rgb{2});
  REQUIRE(s.webs[1].faces.size() == 1);
  CHECK(s.webs[1].faces[0] == Vec3{0, 0, 2});  // m²
  CHECK(e.axes[2] == Vec3{0, 0, -1});
  CHECK_FALSE(e.is_two_sided);
  CHECK_THROWS_AS(attach_luminaire(s, "roof", l, Rgb{1}, {0, 0, -1}), UsageError);
  CHECK_THROWS_AS(attach_luminaire(s, "nobody", l, Rgb{1}, {0, 0, -1}), UsageError);
}

TEST_CASE(
    "an opening has two sides if there is light upwards, not if the file only has angles upwards") {
  for (const auto& [intensities, is_two_sided] : {std::pair{"500 500 0 0 0", false},
                                                  {"500 500 0 0 0.1", false},
                                                  {"500 500 0 100 0", true},
                                                  {"0 0 0 0 500", true}}) {
    const Luminaire l = read(std::string("TILT=NONE\n1 -1 1 5 1 1 2 1 1 0\n1 1 9\n") +
                             "0 45 90 135 180\n0\n" + intensities + "\n");
    Scene s;
    Mesh panel;
    panel.name = "panel";
    panel.positions = {{0, 0, 2}, {0, 1, 2}, {1, 1, 2}, {1, 0, 2}};
    panel.triangles = {{0, 1, 2}, {0, 2, 3}};
    s.materials.resize(1);
    s.meshes.push_back(panel);
    attach_luminaire(s, "panel", l, Rgb{1}, {0, 0, -1});
    REQUIRE(s.lights.size() == 1);
    CAPTURE(intensities);
    CHECK(s.lights[0].is_two_sided == is_two_sided);
  }
}

}  // namespace test_luminaire
