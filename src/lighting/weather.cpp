#include "lighting/weather.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/sun_position.h"
#include "base/time_text.h"
#include "import/file.h"
#include "lighting/csv_table.h"
#include "lighting/option_text.h"

namespace troffer {

namespace {

constexpr uint64_t max_file_bytes = uint64_t(64) << 20;
// Columns of a row [1].
constexpr size_t month = 1, day = 2, hour = 3, minute = 4, global = 13, direct = 14, diffuse = 15;
constexpr double missing = 9999;
// Upper limit in W/m². It exceeds the sun's irradiance outside the atmosphere (1415 W/m² in
// January), because reflection at cloud edges adds to it.
constexpr double most_irradiance = 2000;
// W/m². Instruments read slightly below zero at night; lower values, such as -999, mean a missing
// value.
constexpr double least_measured = -50;

double number(const std::vector<std::string>& fields, size_t i, double least, double most,
              const std::string& path, int line) {
  char* end = nullptr;
  const double v = i < fields.size() ? std::strtod(fields[i].c_str(), &end) : double(NAN);
  if (end == nullptr || end == fields[i].c_str() || *end != '\0' || !(v >= least && v <= most))
    throw InputError(path, line, 1,
                     "field " + std::to_string(i + 1) + ": a number between " +
                         std::to_string(int(least)) + " and " + std::to_string(int(most)) +
                         " expected");
  return v;
}

// Empty fields, values from `missing` on and values far below 0 count as missing.
double irradiance(const std::vector<std::string>& fields, size_t i, const std::string& path,
                  int line) {
  const double v = fields[i].empty() ? missing : number(fields, i, -1e9, 1e9, path, line);
  if (v >= missing || v < least_measured)
    throw InputError(path, line, 1, "the irradiances of this hour are missing");
  if (v > most_irradiance)
    throw InputError(path, line, 1,
                     fmt::format("field {}: {:.6g} W/m2 are more than the sun sends", i + 1, v));
  return std::max(v, 0.0);
}

struct Date {
  int month = 0, day = 0, hour = 0, minute = 0;  // 24:00 is the end of the day
};

Date parse_date(const std::string& text) {
  TimeText t(text, "--date", "06-21T11:30, in the file's standard time");
  const int first = t.number("the month", 4, 1, 9999);
  if (first > 99) t.fail("give no year: the file's rows have their own");
  if (first > 12) t.fail("the month " + std::to_string(first) + " does not lie between 1 and 12");
  Date d;
  d.month = first;
  t.expect('-', "the day");
  constexpr int leap_year = 2024;
  d.day = t.number("the day", 2, 1, days_of_month(leap_year, d.month));
  t.expect_time();
  const TimeOfDay time = t.time_of_day(false);
  d.hour = time.hour;
  d.minute = time.minute;
  if (!t.is_at_end()) t.fail("'" + std::string(t.rest()) + "' must not follow the minute");
  return d;
}

// Row of the hour that contains the time; 24:00 belongs to the day's last row.
int row_hour(const Date& d) {
  return std::min(d.hour + 1, 24);
}
int row_minute(const Date& d) {
  return d.hour == 24 ? 59 : d.minute;
}

// Converts a Julian day to day and time in the Gregorian calendar.
Date date_of(double julian_day_at) {
  // Searching for the day handles leap years.
  const double noon_based = julian_day_at + 0.5, days = std::floor(noon_based);
  Date d;
  const double minutes = std::floor((noon_based - days) * 1440 + 1e-4);
  d.hour = std::min(int(minutes / 60), 23);
  d.minute = int(minutes) % 60;
  const int year = int(std::floor((days - 1721425.5) / 365.2425)) + 1;
  for (int y = year - 1; y <= year + 1; ++y)
    for (int m = 1; m <= 12; ++m) {
      const double first = julian_day(y, m, 1, 0) + 0.5;
      const double next = (m < 12 ? julian_day(y, m + 1, 1, 0) : julian_day(y + 1, 1, 1, 0)) + 0.5;
      if (days < first || days >= next) continue;
      d.month = m;
      d.day = int(days - first) + 1;
      return d;
    }
  return d;
}

// Reads the hour that wanted(zone_hours) returns, in the file's standard time.
template <class Wanted>
Weather read_hour(const std::string& path, const Wanted& wanted_in) {
  Date wanted;
  const std::string text = read_text_file(path, max_file_bytes);
  std::string_view rest = text;
  if (rest.starts_with("\xef\xbb\xbf")) rest.remove_prefix(3);  // byte order mark
  Weather weather;
  double zone_hours = 0, rows_an_hour = 1;
  bool has_data = false;
  for (int line = 1; !rest.empty(); ++line) {
    const size_t end = std::min(rest.find_first_of("\r\n"), rest.size());
    const auto fields = fields_of_row(rest.substr(0, end), ',');
    rest.remove_prefix(std::min(rest.size(), end + (rest.substr(end, 2) == "\r\n" ? 2 : 1)));
    if (line == 1) {
      if (fields[0] != "LOCATION") throw InputError(path, 1, 1, "does not begin with LOCATION");
      weather.latitude_deg = number(fields, 6, -90, 90, path, line);
      weather.longitude_deg = number(fields, 7, -180, 180, path, line);
      zone_hours = number(fields, 8, -14, 14, path, line);
      wanted = wanted_in(zone_hours);
    }
    if (!has_data) {
      has_data = fields[0].starts_with("DATA PERIODS");
      if (has_data && fields.size() > 2) rows_an_hour = number(fields, 2, 1, 60, path, line);
      continue;
    }
    if (fields.size() <= diffuse) continue;
    // Hour 1 is the hour that ends at 01:00.
    if (int(number(fields, month, 1, 12, path, line)) != wanted.month ||
        int(number(fields, day, 1, 31, path, line)) != wanted.day ||
        int(number(fields, hour, 1, 24, path, line)) != row_hour(wanted))
      continue;
    // With several rows per hour, each ends at its minute; the last at 60 or 0.
    if (rows_an_hour > 1) {
      const double ends_at = number(fields, minute, 0, 60, path, line);
      if (ends_at > 0 && ends_at <= row_minute(wanted)) continue;
    }
    const auto whole = parse_number(fields[global]);
    weather.global_horizontal = whole && *whole > 0 && *whole < missing ? *whole : 0;
    weather.direct_normal = irradiance(fields, direct, path, line);
    weather.diffuse_horizontal = irradiance(fields, diffuse, path, line);
    const auto year = int(number(fields, 0, 1900, 2200, path, line));
    weather.julian_day_ut =
        julian_day(year, wanted.month, wanted.day, wanted.hour + wanted.minute / 60.0 - zone_hours);
    return weather;
  }
  throw InputError(path, 0, 0,
                   fmt::format("has no row for {:02}-{:02}T{:02}:{:02}", wanted.month, wanted.day,
                               wanted.hour, wanted.minute));
}

}  // namespace

Weather read_weather(const std::string& path, const std::string& date) {
  const Date wanted = parse_date(date);
  return read_hour(path, [&](double) { return wanted; });
}

Weather read_weather(const std::string& path, double julian_day_ut) {
  Weather weather =
      read_hour(path, [&](double zone_hours) { return date_of(julian_day_ut + zone_hours / 24); });
  weather.julian_day_ut = julian_day_ut;
  return weather;
}

}  // namespace troffer
