// Weather files of a year: both formats, time steps, zones, leap days and missing values.
#include "lighting/weather_year.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "base/error.h"
#include "base/units.h"

using namespace troffer;

namespace {

// A file that lives as long as the object.
class TextFile {
 public:
  TextFile(const std::string& ending, const std::string& text)
      : path_((std::filesystem::temp_directory_path() /
               fmt::format("troffer-weather-{}{}", getpid(), ending))
                  .string()) {
    std::ofstream(path_) << text;
  }
  ~TextFile() { std::filesystem::remove(path_); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

std::string epw_head(double latitude, double longitude, double zone, int rows_per_hour) {
  std::string text =
      fmt::format("LOCATION,Here,-,XXX,SRC,0,{},{},{},100\n", latitude, longitude, zone);
  for (const char* line :
       {"DESIGN CONDITIONS,0", "TYPICAL/EXTREME PERIODS,0", "GROUND TEMPERATURES,0",
        "HOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0", "COMMENTS 1,", "COMMENTS 2,"})
    text += std::string(line) + "\n";
  return text + fmt::format("DATA PERIODS,1,{},Data,Sunday,1/1,12/31\n", rows_per_hour);
}

std::string epw_row(int month, int day, int hour, int minute, const std::string& direct,
                    const std::string& diffuse) {
  return fmt::format("2015,{},{},{},{},?,0,0,0,0,0,0,0,0,{},{},0,0\n", month, day, hour, minute,
                     direct, diffuse);
}

// Header of the .wea file that Radiance's test/gen uses, with another zone where asked.
std::string wea_head(double latitude, double longitude_west, double zone_west, int units) {
  return fmt::format(
      "place Somewhere\nlatitude {}\nlongitude {}\ntime_zone {}\nsite_elevation 12.0\n"
      "weather_data_file_units {}\n",
      latitude, longitude_west, zone_west, units);
}

}  // namespace

TEST_CASE("an EPW row holds the hour that ends at its number") {
  const TextFile file(".epw", epw_head(48, 16, 1, 1) + epw_row(6, 21, 12, 60, "800", "100") +
                                  epw_row(6, 21, 13, 60, "700", "110"));
  const WeatherYear year = read_weather_year(file.path());
  REQUIRE(year.steps.size() == 2);
  CHECK(year.steps[0].hour == doctest::Approx(11.5));
  CHECK(year.steps[1].direct_normal == 700);
  CHECK(year.steps[1].diffuse_horizontal == 110);
  CHECK(year.steps[0].hour_of_year == doctest::Approx(171 * 24 + 11.5));  // 21 June is day 172
  const SunPosition sun = sun_position(48, 16, julian_day(2015, 6, 21, 10.5));
  CHECK(year.steps[0].sun.altitude_deg == doctest::Approx(sun.altitude_deg));
}

TEST_CASE("rows of a quarter of an hour are centred in it") {
  std::string text = epw_head(0, 0, 0, 4);
  for (const int minute : {15, 30, 45, 60}) text += epw_row(1, 1, 10, minute, "1", "2");
  const TextFile file(".epw", text);
  const WeatherYear year = read_weather_year(file.path());
  REQUIRE(year.steps.size() == 4);
  CHECK(year.steps_per_hour == 4);
  CHECK(year.steps[0].hour == doctest::Approx(9.125));
  CHECK(year.steps[3].hour == doctest::Approx(9.875));
}

// Mountain View: 37.42 N, 122.05 W, zone 120 W, as in Radiance's test/gen/test.wea.
TEST_CASE("a .wea file counts longitudes and zones westward") {
  const TextFile file(".wea", wea_head(37.42, 122.05, 120, 1) + "3 21 11.500 627 236\n");
  const WeatherYear year = read_weather_year(file.path());
  REQUIRE(year.steps.size() == 1);
  CHECK(year.longitude_deg == doctest::Approx(-122.05));
  CHECK(year.zone_hours == doctest::Approx(-8));
  CHECK(year.steps[0].sun.altitude_deg ==
        doctest::Approx(sun_position(37.42, -122.05, julian_day(2015, 3, 21, 19.5)).altitude_deg));
}

TEST_CASE("the sun stands in the north at noon in the southern hemisphere") {
  const TextFile file(".wea", wea_head(-33.9, -151.2, -150, 1) + "12 21 12 900 100\n");
  const SunPosition sun = read_weather_year(file.path()).steps[0].sun;
  CHECK(std::min(sun.azimuth_deg, 360 - sun.azimuth_deg) < 30);
  // 90 - (33.9 - 23.44) degrees at true noon, which is within minutes
  CHECK(sun.altitude_deg == doctest::Approx(79.5).epsilon(0.01));
}

TEST_CASE("a leap day moves the hours after it") {
  const TextFile file(".wea", wea_head(0, 0, 0, 1) + "2 29 12 1 1\n3 1 12 1 1\n");
  const WeatherYear year = read_weather_year(file.path());
  CHECK(year.has_leap_day);
  CHECK(year.steps[1].hour_of_year == doctest::Approx(60 * 24 + 12));
}

TEST_CASE("missing hours get the irradiances of the nearest day at the same time") {
  std::string text = epw_head(0, 0, 0, 1);
  for (int day = 1; day <= 3; ++day)
    for (int hour = 1; hour <= 24; ++hour)
      text += epw_row(1, day, hour, 60,
                      day == 2 && hour == 12 ? "9999" : std::to_string(10 * day + hour), "5");
  const TextFile file(".epw", text);
  const WeatherYear year = read_weather_year(file.path());
  CHECK(year.filled == 1);
  CHECK(year.steps[24 + 11].direct_normal == 10 + 12);  // the day before comes first
}

TEST_CASE("direct irradiance on a horizontal plane is turned to the sun") {
  const TextFile file(".wea", wea_head(0, 0, 0, 2) + "3 21 9 300 100\n");
  const WeatherYear year = read_weather_year(file.path());
  const double sine = std::sin(rad_from_deg(year.steps[0].sun.altitude_deg));
  CHECK(year.steps[0].direct_normal == doctest::Approx(300 / sine));
}

TEST_CASE("files that are no weather are refused with their line") {
  const auto line_of = [](const std::string& ending, const std::string& text) {
    const TextFile file(ending, text);
    try {
      read_weather_year(file.path());
    } catch (const InputError& e) {
      return e.line();
    }
    return -1;
  };
  CHECK(line_of(".epw", "hello\n") == 1);
  CHECK(line_of(".wea", "hello\n") == 1);
  CHECK(line_of(".wea", wea_head(0, 0, 0, 3)) == 6);                     // illuminances
  CHECK(line_of(".wea", wea_head(0, 0, 0, 1) + "13 1 1 1 1\n") == 7);    // month 13
  CHECK(line_of(".wea", wea_head(0, 0, 0, 1) + "1 1 1 5000 1\n") == 7);  // more than the sun
  CHECK(line_of(".epw", epw_head(0, 0, 0, 1) + epw_row(1, 1, 1, 60, "x", "1")) == 9);
}
