// Difficult hours of weather files: no diffuse light, missing codes, the end of a day, southern
// latitudes.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>

#include "base/units.h"
#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_weather_command {

namespace {

// EnergyPlus' data dictionary, "EnergyPlus Weather File": fields 14 to 16 of a row are global
// horizontal, direct normal and diffuse radiation, Wh/m².
std::string epw(const std::string& location, const std::string& month_day, int hour,
                const std::string& global_direct_diffuse, int year = 2005) {
  std::string text = "LOCATION," + location + "\nDATA PERIODS,1,1,Data,Sunday,1/1,12/31\n";
  for (int h = 1; h <= 24; ++h)
    text += fmt::format("{},{},{},60,?9,20,10,50,99000,900,1300,350,{},0,0\n", year, month_day, h,
                        h == hour ? global_direct_diffuse : "0,0,0");
  return text;
}

const char* const equator = "Quito,-,ECU,none,1,0,-78.5,-5,2850";
const char* const sydney = "Sydney,NSW,AUS,none,1,-33.9,151.2,10,5";

struct WeatherTest {
  Folder folder;
  std::string scene =
      folder.write("floor.obj", "v -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\nf 1 2 3 4\n");

  Finished run(const std::string& weather, const std::string& date, const std::string& normal,
               const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{
        "measure",    scene,  "--points",  folder.write("p.csv", "x,y,z,nx,ny,nz\n0,0,1," + normal),
        "--indirect", "none", "--up",      "0,0,1",
        "--ground",   "0",    "--weather", folder.write("w.epw", weather),
        "--date",     date};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(folder, words);
  }
  double lx(const std::string& weather, const std::string& date,
            const std::string& normal = "0,0,1") {
    const Finished f = run(weather, date, normal);
    CAPTURE(f.err);
    REQUIRE(f.status == 0);
    return measured(f)[0].lx;
  }
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != text.npos;
}

}  // namespace

TEST_CASE("an hour with only direct light has its sun") {
  WeatherTest t;
  const double alone = t.lx(epw(equator, "3,21", 13, "780,800,0"), "03-21T12:30");
  const double with_little = t.lx(epw(equator, "3,21", 13, "781,800,1"), "03-21T12:30");
  // A watt of beam has 90 to 110 lm by Perez' efficacies for clear skies; the sun is near the
  // zenith.
  CHECK(alone > 70'000);
  CHECK(alone < 90'000);
  CHECK(with_little == doctest::Approx(alone).epsilon(0.01));
  // Diffuse light alone has no sun: the same from all sides.
  const double north = t.lx(epw(equator, "3,21", 9, "90,0,90"), "03-21T08:30", "0,1,0");
  CHECK(north > 0);
  // The same values by --sky.
  const Finished f = run_program(
      t.folder, {"measure", t.scene, "--points", t.folder.path("p.csv"), "--sky", "perez:800,0",
                 "--sun", "0,60", "--indirect", "none", "--up", "0,0,1"});
  CHECK(f.status == 0);
  CHECK(run_program(t.folder, {"measure", t.scene, "--points", t.folder.path("p.csv"), "--sky",
                               "perez:0,0", "--sun", "0,60"})
            .status == 2);
}

TEST_CASE(
    "missing irradiances are an error; an hour with only global irradiance stays dark with a "
    "warning") {
  WeatherTest t;
  for (const char* fields : {"9999,9999,9999", "500,9999,100", "500,300,9999", "500,999999,100",
                             "500,,100", "500,99999,100", "500,300,-9999"}) {
    CAPTURE(fields);
    const Finished f = t.run(epw(equator, "3,21", 13, fields), "03-21T12:30", "0,0,1");
    CHECK(f.status == 1);
    CHECK(contains(f.err, "w.epw:15:1: the irradiances of this hour are missing"));
  }
  const Finished much = t.run(epw(equator, "3,21", 13, "500,5000,100"), "03-21T12:30", "0,0,1");
  CHECK(much.status == 1);
  CHECK(contains(much.err, "more than the sun sends"));
  const Finished dark = t.run(epw(equator, "3,21", 13, "500,0,0"), "03-21T12:30", "0,0,1");
  CHECK(dark.status == 0);
  CHECK(contains(dark.err, "500 W/m2 of global irradiance"));
  // The column of global radiation does not matter.
  CHECK(t.lx(epw(equator, "3,21", 13, "9999,800,100"), "03-21T12:30") ==
        doctest::Approx(t.lx(epw(equator, "3,21", 13, "880,800,100"), "03-21T12:30")));
}

TEST_CASE("the row of an hour ends at that hour, the last of a day at 24:00") {
  WeatherTest t;
  const std::string noon = epw(equator, "3,21", 13, "880,800,100");
  CHECK(t.lx(noon, "03-21T12:00") > 50'000);  // hour 13 is 12:00 to 13:00
  CHECK(t.lx(noon, "03-21T12:59") > 50'000);
  CHECK(t.lx(noon, "03-21T11:59") == 0);
  CHECK(t.lx(noon, "03-21T13:00") == 0);
  CHECK(t.lx(noon, "03-21 12:30") == t.lx(noon, "03-21T12:30"));
  CHECK(t.run(noon, "03-21T24:00", "0,0,1").status == 0);
  // Inside the polar circle the sun is up at the end of a day.
  const std::string tromso = epw("Tromso,-,NOR,none,1,69.7,18.9,1,5", "6,21", 24, "30,200,20");
  CHECK(t.lx(tromso, "06-21T24:00") > 1000);
  CHECK(t.lx(tromso, "06-21T24:00") == doctest::Approx(t.lx(tromso, "06-21T23:59")).epsilon(0.02));
}

TEST_CASE("in the southern hemisphere the sun stands in the north at noon") {
  WeatherTest t;
  const std::string june = epw(sydney, "6,21", 13, "500,800,0");
  CHECK(t.lx(june, "06-21T12:00", "0,1,0") > 40'000);  // +y is north
  CHECK(t.lx(june, "06-21T12:00", "0,-1,0") == 0);
  // The sun is 90 - 33.9 - 23.4 degrees above the horizon.
  CHECK(t.lx(june, "06-21T12:00", "0,0,1") / t.lx(june, "06-21T12:00", "0,1,0") ==
        doctest::Approx(std::tan(rad_from_deg(32.7))).epsilon(0.02));
  const std::string vienna = epw("Wien,-,AUT,none,1,48.2,16.4,1,203", "6,21", 13, "500,800,0");
  CHECK(t.lx(vienna, "06-21T12:00", "0,-1,0") > 20'000);
  CHECK(t.lx(vienna, "06-21T12:00", "0,1,0") == 0);
}

TEST_CASE("leap days are accepted for files that have them, whatever the year of the row") {
  WeatherTest t;
  const std::string leap = epw(equator, "2,29", 13, "880,800,100", 2004);
  CHECK(t.lx(leap, "02-29T12:30") > 50'000);
  CHECK(t.run(epw(equator, "2,28", 13, "880,800,100"), "02-29T12:30", "0,0,1").status == 1);
  for (const auto& [date, part] : {std::pair<const char*, const char*>{
                                       "02-30T12:30", "the day 30 does not lie between 1 and 29"},
                                   {"13-01T12:30", "the month 13"},
                                   {"06-21T12:60", "the minute 60"},
                                   {"06-21", "the time of day is missing"},
                                   {"2005-06-21T12:30", "give no year"},
                                   {"06-21T12:30+02:00", "'+02:00' must not follow the minute"},
                                   {"noon", "the month: a number expected"}}) {
    const Finished f = t.run(leap, date, "0,0,1");
    CAPTURE(date);
    CAPTURE(f.err);
    CHECK(f.status == 2);
    CHECK(contains(f.err, part));
    CHECK(f.error_lines().size() == 1);
  }
}

TEST_CASE("--at names the part that is wrong") {
  WeatherTest t;
  t.folder.write("p.csv", "x,y,z,nx,ny,nz\n0,0,1,0,0,1\n");
  const auto run = [&](const std::string& at) {
    return run_program(t.folder, {"measure", t.scene, "--points", t.folder.path("p.csv"), "--up",
                                  "0,0,1", "--at", at, "--spp", "16"});
  };
  for (const auto& [at, part] :
       {std::pair<const char*, const char*>{"100,20,2026-06-21T12:00Z", "the latitude 100"},
        {"10,400,2026-06-21T12:00Z", "the longitude 400"},
        {"48N,16,2026-06-21T12:00Z", "the latitude '48N' is not a number"},
        {"48,2,16,4,2026-06-21T12:00Z", "5 parts between commas"},
        {"48,16", "2 parts between commas"},
        {"48,16,2026-06-21T12:00", "the time zone is missing"}}) {
    const Finished f = run(at);
    CAPTURE(at);
    CAPTURE(f.err);
    CHECK(f.status == 2);
    CHECK(contains(f.err, "--at: "));
    CHECK(contains(f.err, part));
  }
  const double lx = measured(run("48.2,16.4,2026-06-21T12:00+02:00"))[0].lx;
  for (const char* same : {"48.2, 16.4, 2026-06-21 12:00 +0200", "48.2,16.4,2026-06-21T10:00Z",
                           "48.2,16.4,2026-06-21T12:00+02"})
    CHECK(measured(run(same))[0].lx == doctest::Approx(lx));
}

}  // namespace test_weather_command
