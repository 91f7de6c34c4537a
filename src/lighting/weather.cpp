#include "lighting/weather.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/sun_position.h"
#include "import/file.h"
#include "lighting/csv_table.h"

namespace troffer {

namespace {

constexpr uint64_t max_file_bytes = uint64_t(64) << 20;
// Columns of a row [1].
constexpr size_t month = 1, day = 2, hour = 3, minute = 4, direct = 14, diffuse = 15;
constexpr double missing = 9999;
// Instruments' own error at night, in W/m²; what is less stands for nothing measured, as -999 does.
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

// Nothing, and numbers from `missing` on or far below 0, stand for what nobody measured.
double irradiance(const std::vector<std::string>& fields, size_t i, const std::string& path,
                  int line) {
  const double v = fields[i].empty() ? missing : number(fields, i, -1e9, 1e9, path, line);
  if (v >= missing || v < least_measured)
    throw InputError(path, line, 1, "the irradiances of this hour are missing");
  return std::max(v, 0.0);
}

struct Date {
  int month = 0, day = 0, hour = 0, minute = 0;
};

Date parse_date(const std::string& text) {
  Date d;
  int used = 0;
  const bool is_read = std::sscanf(text.c_str(), "%2d-%2dT%2d:%2d%n", &d.month, &d.day, &d.hour,
                                   &d.minute, &used) == 4;
  if (!is_read || size_t(used) != text.size() || d.month < 1 || d.month > 12 || d.day < 1 ||
      d.day > 31 || d.hour < 0 || d.hour > 23 || d.minute < 0 || d.minute > 59)
    throw UsageError("--date: cannot read '" + text + "' as MM-DDTHH:MM");
  return d;
}

// Hours after midnight of the moment's day become day and time; of the Gregorian calendar.
Date date_of(double julian_day_at) {
  // Days of a leap year and a common one are told apart by looking for the day.
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

// wanted(zone_hours): the date in the file's standard time.
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
    // Hour 1 ends at 01:00.
    if (int(number(fields, month, 1, 12, path, line)) != wanted.month ||
        int(number(fields, day, 1, 31, path, line)) != wanted.day ||
        int(number(fields, hour, 1, 24, path, line)) != wanted.hour + 1)
      continue;
    // Of several rows an hour each ends at its minute, the last at 60 or 0.
    if (rows_an_hour > 1) {
      const double ends_at = number(fields, minute, 0, 60, path, line);
      if (ends_at > 0 && ends_at <= wanted.minute) continue;
    }
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
