// Options for skies, suns and environment images; scenes without light or camera.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "base/units.h"
#include "image/read_image.h"
#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_daylight_command {

namespace {

const char* const plain_obj =
    "v -5 -5 0\nv 5 -5 0\nv 5 5 0\nv -5 5 0\nf 1 2 3 4\n"
    "v -.5 -.5 .1\nv .5 -.5 .1\nv .5 .5 .1\nv -.5 .5 .1\nf 5 6 7 8\n";
const char* const one_point = "x,y,z,nx,ny,nz\n2,2,0,0,0,1\n";

// Measures at the single point.
Measured measure(const Folder& folder, std::vector<std::string> options) {
  std::vector<std::string> words{"measure", folder.write("plain.obj", plain_obj), "--points",
                                 folder.write("p.csv", one_point)};
  words.insert(words.end(), options.begin(), options.end());
  const Finished f = run_program(folder, words);
  CAPTURE(f.err);
  REQUIRE(f.status == 0);
  return measured(f).at(0);
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a sun beside an image of the surroundings brings no sky and no ground of its own") {
  const Folder folder;
  std::string image = "PF\n4 2\n-1.0\n";
  const float one = 1;
  for (int i = 0; i < 4 * 2 * 3; ++i) image.append(reinterpret_cast<const char*>(&one), 4);
  const std::string file = folder.write("even.pfm", image);
  const double even = pi * luminous_efficacy;
  for (const auto& [options, lx] :
       {std::pair<std::vector<std::string>, double>{{"--environment", file}, even},
        {{"--environment", file, "--sun", "200,30,50000"}, even + 25'000},
        {{"--environment", file, "--sun", "200,30,50000", "--sky", "clear,9000"},
         even + 25'000 + 9000}}) {
    const Measured m = measure(folder, options);
    CHECK(std::abs(m.lx - lx) < 2e-3 * lx + 5 * m.error);
  }
}

TEST_CASE("skies and suns give an open plane the requested illuminance") {
  const Folder folder;
  struct Case {
    std::vector<std::string> options;
    double lx;
  };
  const Case cases[] = {
      {{"--sky", "even"}, 10'000},
      {{"--sky", "even,500"}, 500},
      {{"--sky", "overcast"}, 10'000},
      {{"--sky", "cie:4,7000", "--sun", "90,40"}, 7000},
      {{"--sky", "clear,9000", "--sun", "200,30,50000"}, 9000 + 25'000},
      {{"--sky", "none", "--sun", "200,30,50000"}, 25'000},
      // Noon of an equinox at the equator: the sun near the zenith, by the documented formula.
      {{"--at", "0,0,2026-03-20T12:08Z"},
       800 + 15'500 + 127'500 / std::pow(0.99599, 2) * std::exp(-0.21)},
  };
  for (const Case& c : cases) {
    std::vector<std::string> options = c.options;
    options.insert(options.end(), {"--spp", "4096", "--indirect", "none"});
    const Measured m = measure(folder, options);
    CAPTURE(c.lx);
    CHECK(std::abs(m.lx - c.lx) < 1e-3 * c.lx + 5 * m.error);
    CHECK(m.error < 0.01 * c.lx);
  }
}

// A sky without diffuse light, as in an hour of a weather file, emits nothing itself. The ground
// below it still reflects the sun, by its reflectance of 0.2: 0.2 × 40 000 lx × sin 30°.
TEST_CASE("the ground reflects the sun also below a sky that is dark") {
  const Folder folder;
  const std::string scene = folder.write("plate.obj", plain_obj);
  const std::string points = folder.write("p.csv", "x,y,z,nx,ny,nz\n9,9,1,0,0,-1\n");
  for (const char* method : {"certified", "path", "fixed"}) {
    const Finished f = run_program(
        folder, {"measure", scene, "--points", points, "--sky", "even,0", "--sun", "200,30,40000",
                 "--indirect", "none", "--up", "0,0,1", "--method", method, "--spp", "4096"});
    CAPTURE(f.err);
    CAPTURE(method);
    REQUIRE(f.status == 0);
    const Measured m = measured(f).at(0);
    CHECK(std::abs(m.lx - 4000) < 5e-3 * 4000 + 5 * m.error);
  }
}

TEST_CASE("an image of the surroundings: scale, rotation, and what cannot be read") {
  const Folder folder;
  // Bright in the east: the middle of the image, at a height of 45 degrees.
  std::string pfm = "PF\n8 4\n-1\n";
  for (int y = 3; y >= 0; --y)
    for (int x = 0; x < 8; ++x) {
      const float v = y == 1 && (x == 3 || x == 4) ? 100.0f : 1.0f;
      for (int c = 0; c < 3; ++c) pfm.append(reinterpret_cast<const char*>(&v), sizeof v);
    }
  const std::string image = folder.write("sky.pfm", pfm);
  const auto lx = [&](const std::string& up_of, const std::string& scale, const char* rotation) {
    folder.write("p2.csv", "x,y,z,nx,ny,nz\n2,2,0," + up_of + "\n");
    std::vector<std::string> words{"--environment", image + scale, "--environment-rotation",
                                   rotation,        "--indirect",  "none"};
    return measure(folder, words).lx;
  };
  const double once = lx("0,0,1", "", "0");
  CHECK(lx("0,0,1", ",3", "0") == doctest::Approx(3 * once).epsilon(5e-3));
  CHECK(lx("0,0,1", "", "90") == doctest::Approx(once).epsilon(5e-3));

  const std::string scene = folder.write("plain.obj", plain_obj),
                    points = folder.write("p.csv", "x,y,z,nx,ny,nz\n2,2,3,1,0,0\n2,2,3,0,-1,0\n");
  const auto rows = [&](const char* rotation) {
    const Finished f = run_program(folder, {"measure", scene, "--points", points, "--environment",
                                            image, "--environment-rotation", rotation, "--method",
                                            "fixed", "--spp", "1024", "--quiet"});
    REQUIRE(f.status == 0);
    return f.out;
  };
  // A clockwise turn by 90 degrees moves east to south.
  const auto column = [](const std::string& out, int row) {
    std::istringstream lines(out);
    std::string line;
    for (int i = 0; i <= row; ++i) std::getline(lines, line);
    std::istringstream cells(line);
    std::string cell;
    for (int i = 0; i < 10; ++i) std::getline(cells, cell, ',');
    return std::stod(cell);
  };
  const std::string ahead = rows("0"), turned = rows("90");
  CHECK(column(ahead, 1) > 3 * column(ahead, 2));
  CHECK(column(turned, 2) == doctest::Approx(column(ahead, 1)).epsilon(0.02));
  CHECK(column(turned, 1) == doctest::Approx(column(ahead, 2)).epsilon(0.1));

  const Finished f =
      run_program(folder, {"measure", scene, "--points", points, "--environment", "missing.exr"});
  CHECK(f.status == 1);
  CHECK(f.error_lines().size() == 1);
}

TEST_CASE("senseless daylight options are reported") {
  const Folder folder;
  const std::string scene = folder.write("plain.obj", plain_obj),
                    points = folder.write("p.csv", one_point);
  const std::vector<std::vector<std::string>> bad = {
      {"--sky", "blue"},
      {"--sky", "cie:16"},
      {"--sky", "cie:1.5"},
      {"--sky", "overcast,-1"},
      {"--sky", "overcast,1,2"},
      {"--sky", "perez:3"},
      {"--sky", "perez:9,nan"},
      {"--sky", "clear"},
      {"--sky", "perez:800,100"},
      {"--sun", "10"},
      {"--sun", "10,95"},
      {"--sun", "10,20,30,40"},
      {"--sun", "a,b"},
      {"--at", "10,20"},
      {"--at", "100,20,2026-06-21T12:00Z"},
      {"--at", "10,20,noon"},
      {"--turbidity", "3"},
      {"--turbidity", "0.5", "--sun", "10,20"},
      {"--turbidity", "3", "--sky", "overcast"},
      {"--turbidity", "3", "--sky", "overcast", "--sun", "10,20"},
      {"--ground", "2"},
      {"--north", "nan"},
      {"--light-radius", "nan"},
      {"--sun", "0,30", "--turbidity", "nan"},
      {"--environment", "a,-2"},
      {"--up", "0,0,0"},
      {"--up", "w"},
      {"--sun", "1,2", "--at", "10,20,2026-06-21T12:00Z"},
  };
  for (const auto& options : bad) {
    std::vector<std::string> words{"measure", scene, "--points", points};
    words.insert(words.end(), options.begin(), options.end());
    const Finished f = run_program(folder, words);
    CAPTURE(options[1]);
    CHECK(f.status == 2);
    CHECK(f.error_lines().size() == 1);
  }
}

TEST_CASE("a scene without light and camera is lit, framed and exposed, and says so") {
  const Folder folder;
  const std::string scene = folder.write("plain.obj", plain_obj);
  const std::string png = folder.path("o.png");
  const std::vector<std::string> plain{"render", scene,   "-o", png,        "--size",
                                       "40x30",  "--spp", "4",  "--method", "fixed"};
  const Finished f = run_program(folder, plain);
  REQUIRE(f.status == 0);
  CHECK(contains(f.err, "no light"));
  CHECK(contains(f.err, "uniform sky"));
  CHECK(contains(f.err, "in front of it"));
  CHECK(contains(f.err, "exposed by"));
  double mean = 0;
  for (const Rgb& p : read_image(png).pixels) mean += double(luminance(p)) / (40 * 30);
  CHECK(mean > 0.05);
  CHECK(mean < 0.6);

  std::vector<std::string> dark = plain;
  dark.insert(dark.end(), {"--sky", "none"});
  const Finished none = run_program(folder, dark);
  CHECK(none.status == 0);
  CHECK(contains(none.err, "the picture is black"));
  for (const Rgb& p : read_image(png).pixels) REQUIRE(p.is_black());

  // after sunset
  std::vector<std::string> night = plain;
  night.insert(night.end(), {"--at", "48,16,2026-06-21T23:00Z"});
  CHECK(contains(run_program(folder, night).err, "below the horizon"));
}

TEST_CASE("warnings report a hidden sun and options without effect, but no missing light") {
  const Folder folder;
  const std::string scene = folder.write("plain.obj", plain_obj),
                    points = folder.write("p.csv", one_point);
  const auto warnings = [&](std::vector<std::string> options) {
    std::vector<std::string> words{"measure", scene, "--points", points, "--up", "z"};
    words.insert(words.end(), options.begin(), options.end());
    const Finished f = run_program(folder, words);
    CHECK(f.status == 0);
    std::string told;
    for (const std::string& line : f.error_lines())
      if (line.starts_with("warning:")) told += line + "\n";
    return told;
  };
  CHECK(warnings({"--sky", "clear", "--sun", "90,40", "--north", "30"}).empty());
  CHECK(contains(warnings({"--sky", "overcast", "--sun", "90,40"}), "hides the sun"));
  CHECK(contains(warnings({"--sky", "even", "--sun", "90,40"}), "hides the sun"));
  CHECK(warnings({"--sky", "even", "--sun", "90,40,1000"}).empty());
  CHECK(contains(warnings({"--sky", "even", "--environment-rotation", "9"}), "does nothing"));
  const std::string dark = warnings({"--sky", "none", "--north", "9", "--ground", ".5"});
  CHECK(contains(dark, "--north does nothing"));
  CHECK(contains(dark, "--ground does nothing"));
  CHECK(contains(dark, "there is no light"));
}

TEST_CASE("kj92 warns of the sky light that it misses through openings, and of nothing else") {
  const Folder folder;
  // A box with one open side, seen from inside.
  const std::string room = folder.write(
      "room.obj",
      "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\nv 0 0 2.5\nv 4 0 2.5\nv 4 3 2.5\nv 0 3 2.5\n"
      "f 1 2 3 4\nf 5 8 7 6\nf 1 5 6 2\nf 4 3 7 8\nf 1 4 8 5\n");
  const std::string points = folder.write("p.csv", "x,y,z,nx,ny,nz\n1,1,.8,0,0,1\n");
  const auto warns = [&](const std::vector<std::string>& options, const std::string& scene) {
    std::vector<std::string> words{"measure", scene, "--points", points, "--method", "kj92"};
    words.insert(words.end(), options.begin(), options.end());
    const Finished f = run_program(folder, words);
    CAPTURE(f.err);
    CHECK(f.status == 0);
    return contains(f.err, "openings");
  };
  CHECK(warns({"--sky", "overcast"}, room));
  CHECK_FALSE(warns({"--sky", "overcast"}, folder.write("plain.obj", plain_obj)));
}

TEST_CASE("turbid air dims the sun and brightens the sky") {
  const Folder folder;
  folder.write("plain.obj", plain_obj);
  folder.write("p.csv", one_point);
  const auto lx = [&](const char* turbidity, bool has_sky) {
    std::vector<std::string> options{"--sun", "120,40", "--turbidity", turbidity};
    if (!has_sky) options.insert(options.end(), {"--sky", "none"});
    return measure(folder, options).lx;
  };
  const double clear = lx("2", true), clear_sun = lx("2", false);
  const double turbid = lx("6", true), turbid_sun = lx("6", false);
  CHECK(turbid_sun < 0.7 * clear_sun);
  CHECK(turbid - turbid_sun > 1.5 * (clear - clear_sun));
  CHECK(turbid < clear);
  CHECK(clear > 50'000);
  CHECK(clear < 90'000);
}

TEST_CASE("weather files: line ends, byte order marks, rows of a quarter, instruments' errors") {
  const Folder folder;
  const auto file = [&](const std::string& end, const std::string& mark, const char* night) {
    std::string epw = mark + "LOCATION,Wien,-,AUT,none,110350,48.2,16.4,1.0,203.0" + end +
                      "DATA PERIODS,1,4,Data,Sunday,1/1,12/31" + end;
    for (int quarter = 0; quarter < 96; ++quarter)
      epw += "2005,6,21," + std::to_string(quarter / 4 + 1) + "," +
             std::to_string(quarter % 4 * 15 + 15) + ",?9,20,10,50,99000,900,1300,350,500," +
             std::to_string(quarter * 5) + "," + (quarter < 16 ? night : "150") + ",0,0" + end;
    return folder.write("q.epw", epw);
  };
  const auto by_hand = [&](const char* dni, const std::string& time) {
    return measure(folder, {"--sky", fmt::format("perez:{},150", dni), "--at",
                            "48.2,16.4,2005-06-21T" + time + "+01:00"})
        .lx;
  };
  const char* const bom = "\xef\xbb\xbf";
  for (const auto& [end, mark] :
       std::vector<std::pair<std::string, std::string>>{{"\n", ""}, {"\r\n", bom}, {"\r", ""}}) {
    const std::string path = file(end, mark, "-2");
    const auto lx = [&](const std::string& time) {
      return measure(folder, {"--weather", path, "--date", "06-21T" + time}).lx;
    };
    CHECK(lx("11:14") == doctest::Approx(by_hand("220", "11:14")).epsilon(1e-6));
    CHECK(lx("11:15") == doctest::Approx(by_hand("225", "11:15")).epsilon(1e-6));
    CHECK(lx("11:59") == doctest::Approx(by_hand("235", "11:59")).epsilon(1e-6));
    CHECK(lx("02:00") == 0);
  }
  const auto status = [&](const char* night) {
    return run_program(folder,
                       {"measure", folder.path("plain.obj"), "--points", folder.path("p.csv"),
                        "--weather", file("\n", "", night), "--date", "06-21T02:00"})
        .status;
  };
  CHECK(status("-2") == 0);
  CHECK(status("-999") == 1);
  CHECK(status("12x") == 1);
}

TEST_CASE("at dusk a sky has the requested brightness, wherever the sun is") {
  const Folder folder;
  CHECK(measure(folder, {"--sky", "overcast,80", "--sun", "270,-3"}).lx ==
        doctest::Approx(measure(folder, {"--sky", "overcast,80"}).lx));
  CHECK(measure(folder, {"--sky", "overcast,80"}).lx > 60);
  CHECK(measure(folder, {"--sky", "overcast", "--sun", "270,-3"}).lx == 0);
  CHECK(measure(folder, {"--sky", "clear,80", "--sun", "270,-3"}).lx == 0);
  const Finished f = run_program(folder, {"measure", folder.path("plain.obj"), "--points",
                                          folder.path("p.csv"), "--sun", "270,0"});
  CHECK(contains(f.err, "the sun is 0.00 degrees"));
}

TEST_CASE("an hour of a weather file gives the Perez sky and the sun of that place and time") {
  const Folder folder;
  std::string epw =
      "LOCATION,Wien,-,AUT,none,110350,48.2,16.4,1.0,203.0\n"
      "COMMENTS 1,none\nDATA PERIODS,1,1,Data,Sunday,1/1,12/31\n";
  for (int hour = 1; hour <= 24; ++hour) {
    const bool is_day = hour > 5 && hour < 20;
    epw += "2005,6,21," + std::to_string(hour) + ",60,?9,20,10,50,99000,900,1300,350,500," +
           (hour == 13 ? "9999"
            : is_day   ? "600"
                       : "0") +
           "," + (is_day ? "150" : "0") + ",0,0\n";
  }
  const std::string file = folder.write("w.epw", epw);
  const Measured by_file = measure(folder, {"--weather", file, "--date", "06-21T11:30"});
  const Measured by_hand =
      measure(folder, {"--sky", "perez:600,150", "--at", "48.2,16.4,2005-06-21T11:30+01:00"});
  CHECK(by_file.lx == doctest::Approx(by_hand.lx).epsilon(1e-6));
  CHECK(by_file.lx > 50'000);
  const auto status = [&](const std::vector<std::string>& options) {
    std::vector<std::string> words{"measure", folder.path("plain.obj"), "--points",
                                   folder.path("p.csv")};
    words.insert(words.end(), options.begin(), options.end());
    return run_program(folder, words).status;
  };
  // A moment in any time zone yields the file's hour and the place's sun.
  const Measured by_moment =
      measure(folder, {"--weather", file, "--at", "48.2,16.4,2005-06-21T12:30+02:00"});
  CHECK(by_moment.lx == doctest::Approx(by_file.lx).epsilon(1e-6));
  CHECK(status({"--weather", file, "--at", "48.2,16.4,2024-06-20T23:30Z"}) == 0);
  CHECK(status({"--weather", file, "--at", "48.2,16.4,2024-06-21T11:30Z"}) == 1);  // missing
  CHECK(status({"--weather", file, "--at", "48.2,16.4,2024-06-22T11:30Z"}) == 1);
  CHECK(status({"--weather", file, "--at", "48.2,16.4,2024-06-21T09:30Z", "--date",
                "06-21T10:30"}) == 2);
  CHECK(status({"--weather", file, "--date", "06-21T02:00"}) == 0);  // night: dark, with a message
  CHECK(status({"--weather", file, "--date", "06-21T12:30"}) == 1);  // missing
  CHECK(status({"--weather", file, "--date", "07-21T12:30"}) == 1);
  CHECK(status({"--weather", file, "--date", "noon"}) == 2);
  CHECK(status({"--weather", file}) == 2);
  CHECK(status({"--date", "06-21T12:30"}) == 2);
  CHECK(status({"--weather", file, "--date", "06-21T11:30", "--sky", "clear"}) == 2);
  CHECK(status({"--weather", folder.write("no.epw", "hello\n"), "--date", "06-21T11:30"}) == 1);
}

}  // namespace test_daylight_command
