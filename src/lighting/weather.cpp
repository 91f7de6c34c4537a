#include "lighting/weather.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "daylight/sun_position.h"
#include "import/file.h"
#include "lighting/csv_table.h"

namespace troffer {

namespace {

constexpr uint64_t max_file_bytes = uint64_t(64) << 20;
// Columns of a row [1].
constexpr size_t month = 1, day = 2, hour = 3, direct = 14, diffuse = 15;
constexpr double missing = 9999;

double number(const std::vector<std::string>& fields, size_t i, double least, double most,
              const std::string& path, int line) {
  char* end = nullptr;
  const double v = i < fields.size() ? std::strtod(fields[i].c_str(), &end) : double(NAN);
  if (end == nullptr || end == fields[i].c_str() || !(v >= least && v <= most))
    throw InputError(path, line, 1,
                     "field " + std::to_string(i + 1) + ": a number between " +
                         std::to_string(int(least)) + " and " + std::to_string(int(most)) +
                         " expected");
  return v;
}

// Nothing, and numbers from `missing` on, stand for what nobody measured.
double irradiance(const std::vector<std::string>& fields, size_t i, const std::string& path,
                  int line) {
  const double v = fields[i].empty() ? missing : number(fields, i, 0, 1e9, path, line);
  if (v >= missing) throw InputError(path, line, 1, "the irradiances of this hour are missing");
  return v;
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
  Weather weather;
  double zone_hours = 0;
  bool has_data = false;
  for (int line = 1; !rest.empty(); ++line) {
    const size_t end = rest.find('\n');
    std::string_view row = rest.substr(0, end);
    if (row.ends_with('\r')) row.remove_suffix(1);
    const auto fields = fields_of_row(row, ',');
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (line == 1) {
      if (fields[0] != "LOCATION") throw InputError(path, 1, 1, "does not begin with LOCATION");
      weather.latitude_deg = number(fields, 6, -90, 90, path, line);
      weather.longitude_deg = number(fields, 7, -180, 180, path, line);
      zone_hours = number(fields, 8, -14, 14, path, line);
      wanted = wanted_in(zone_hours);
    }
    if (!has_data) {
      has_data = fields[0].starts_with("DATA PERIODS");
      continue;
    }
    if (fields.size() <= diffuse) continue;
    // Hour 1 ends at 01:00.
    if (int(number(fields, month, 1, 12, path, line)) != wanted.month ||
        int(number(fields, day, 1, 31, path, line)) != wanted.day ||
        int(number(fields, hour, 1, 24, path, line)) != wanted.hour + 1)
      continue;
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
