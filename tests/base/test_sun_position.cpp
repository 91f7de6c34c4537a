// The sun's position against published values.
#include "base/sun_position.h"

#include <doctest/doctest.h>

#include <cmath>

#include "base/error.h"

using namespace troffer;

TEST_CASE("Julian days") {
  // Meeus, Astronomical Algorithms, ch. 7.
  CHECK(julian_day(2000, 1, 1, 12) == 2451545.0);
  CHECK(julian_day(1999, 1, 1, 0) == 2451179.5);
  CHECK(julian_day(1987, 6, 19, 12) == 2446966.0);
  CHECK(julian_day(1988, 1, 27, 0) == 2447187.5);
  CHECK(julian_day(1900, 1, 1, 0) == 2415020.5);
}

TEST_CASE("the worked example of NREL's Solar Position Algorithm") {
  // Reda & Andreas, NREL/TP-560-34302 (2008), table A5.1: Golden, Colorado, 17 October 2003,
  // 12:30:30 at -7 h. Topocentric zenith 50.11162, azimuth 194.34024. Its air of 820 hPa and 11 °C
  // refracts 0.0040 less than a standard atmosphere.
  const SunPosition p =
      sun_position(39.742476, -105.1786, julian_day(2003, 10, 17, 12 + 30.5 / 60 + 7));
  CHECK(std::abs(p.altitude_deg - (90 - 50.11162)) < 0.01);
  CHECK(std::abs(p.azimuth_deg - 194.34024) < 0.01);
  CHECK(p.distance_au == doctest::Approx(0.9965422974).epsilon(2e-5));
}

TEST_CASE("Meeus' example of the sun's place, seen from the pole") {
  // Astronomical Algorithms, example 25.b: 13 October 1992, 0h TD (58.7 s ahead of UT then). The
  // apparent declination is -7.78389 by the complete theory. At the north pole, below the horizon,
  // the altitude equals the declination except for parallax.
  const SunPosition p = sun_position(90, 0, julian_day(1992, 10, 13, -58.7 / 3600));
  CHECK(std::abs(p.altitude_deg - (-7.78389)) < 0.01);
  CHECK(p.distance_au == doctest::Approx(0.99760775).epsilon(1e-4));
}

TEST_CASE("times as ISO 8601 writes them") {
  CHECK(parse_time("2026-06-21T12:00Z", "--at") == julian_day(2026, 6, 21, 12));
  CHECK(parse_time("2026-06-21T12:00+02:00", "--at") == julian_day(2026, 6, 21, 10));
  CHECK(parse_time("2026-06-21T12:00:30-05:30", "--at") ==
        doctest::Approx(julian_day(2026, 6, 21, 17.5 + 30 / 3600.0)));
  CHECK(parse_time("2024-02-29T24:00Z", "--at") == julian_day(2024, 3, 1, 0));
  for (const char* same : {"2026-06-21 12:00+02:00", "2026-06-21T12:00+0200", "2026-06-21T12:00+02",
                           "2026-06-21t12:00:00.0 +02:00", " 2026-06-21  12:00 +0200 ",
                           "2026-06-21T10:00 z", "2026-6-21T12:00+2", "2026-06-21T15:30+0530",
                           "2026-06-21T07:00\xe2\x88\x92"
                           "03:00"}) {
    CAPTURE(same);
    CHECK(parse_time(same, "--at") == doctest::Approx(julian_day(2026, 6, 21, 10)).epsilon(1e-12));
  }
  for (const char* bad :
       {"", "2026-06-21", "2026-06-21T12:00", "2026-13-21T12:00Z", "2026-06-21T12:00+",
        "2026-06-21T25:00Z", "2026-06-21T12:60Z", "1026-06-21T12:00Z", "2026-06-21T12:00Zx", "noon",
        "2026-02-29T12:00Z", "2100-02-29T12:00Z", "2026-06-21T24:01Z"}) {
    CAPTURE(bad);
    CHECK_THROWS_AS(parse_time(bad, "--at"), UsageError);
  }
}

TEST_CASE("the error for an unreadable time names the wrong part") {
  for (const auto& [text, part] :
       {std::pair<const char*, const char*>{"2026-13-21T12:00Z", "the month 13"},
        {"2026-06-31T12:00Z", "the day 31 does not lie between 1 and 30"},
        {"2026-02-29T12:00Z", "the day 29 does not lie between 1 and 28"},
        {"1776-07-04T12:00Z", "the year 1776"},
        {"2026-06-21", "the time of day is missing"},
        {"2026-06-21T12", "the minute is missing"},
        {"2026-06-21T12:60Z", "the minute 60"},
        {"2026-06-21T25:00Z", "the hour 25"},
        {"2026-06-21T24:30Z", "a day ends at 24:00"},
        {"2026-06-21T12:00", "the time zone is missing"},
        {"2026-06-21T12:00CET", "the time zone must be Z"},
        {"2026-06-21T12:00+15", "the time zone's hour 15"},
        {"2026-06-21T12:00Zulu", "'ulu' must not follow the time zone"},
        {"21.06.2026 12:00Z", "the year 21"},
        {"noon", "the year: a number expected"}}) {
    CAPTURE(text);
    try {
      parse_time(text, "--at");
      FAIL("was read");
    } catch (const UsageError& error) {
      const std::string message = error.what();
      CAPTURE(message);
      CHECK(message.starts_with("--at: "));
      CHECK(message.find(part) != message.npos);
    }
  }
}
