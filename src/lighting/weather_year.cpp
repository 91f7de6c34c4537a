#include "lighting/weather_year.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string_view>

#include "base/error.h"
#include "base/time_text.h"
#include "base/units.h"
#include "import/file.h"
#include "lighting/csv_table.h"
#include "lighting/option_text.h"

namespace troffer {

namespace {

constexpr uint64_t most_bytes = uint64_t(256) << 20;
constexpr double missing_value = 9999;  // [1]
// W/m². As in weather.cpp: above what the sun sends, and below what instruments show at night.
constexpr double most_hourly_irradiance = 2000, least_hourly_irradiance = -50;
// Years of .wea files, which name none: without and with a leap day.
constexpr int plain_year = 2015, leap_year = 2016;

// Lines of a file, with their numbers.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : rest_(text) {
    if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);  // byte order mark
  }
  bool next(std::string_view& line) {
    if (rest_.empty()) return false;
    const size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(rest_.size(), end + (rest_.substr(end, 2) == "\r\n" ? 2 : 1)));
    ++number_;
    return true;
  }
  int number() const { return number_; }

 private:
  std::string_view rest_;
  int number_ = 0;
};

class YearReader {
 public:
  explicit YearReader(const std::string& path)
      : path_(path), text_(read_text_file(path, most_bytes)), lines_(text_) {}

  WeatherYear read() {
    const size_t dot = path_.find_last_of('.');
    std::string ending = dot == std::string::npos ? "" : path_.substr(dot + 1);
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    if (ending == "wea")
      read_wea();
    else
      read_epw();
    if (year_.steps.empty()) fail("holds no hours");
    for (const Row& r : rows_) year_.has_leap_day |= r.month == 2 && r.day == 29;
    fill_gaps();
    place_suns();
    return std::move(year_);
  }

 private:
  struct Row {
    int year, month, day;
    bool is_missing;
  };

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(path_, lines_.number(), 1, what);
  }
  double number(const std::string& text, const std::string& name, double least, double most) const {
    const auto v = parse_number(text);
    if (!v || *v < least || *v > most)
      fail(fmt::format("{}: a number between {} and {} expected", name, least, most));
    return *v;
  }
  // Returns an irradiance, and sets is_missing if there is none.
  double irradiance(const std::string& text, const std::string& name, bool& is_missing) const {
    const double v = text.empty() ? missing_value : number(text, name, -1e9, 1e9);
    if (v >= missing_value || v < least_hourly_irradiance) {
      is_missing = true;
      return 0;
    }
    if (v > most_hourly_irradiance)
      fail(fmt::format("{}: {:.6g} W/m2 are more than the sun sends", name, v));
    return std::max(v, 0.0);
  }
  void add(Row row, double hour, double direct, double diffuse) {
    const int leap = 2024;
    if (row.day > days_of_month(leap, row.month)) fail("the month has fewer days");
    rows_.push_back(row);
    WeatherStep& s = year_.steps.emplace_back();
    s.month = row.month;
    s.day = row.day;
    s.hour = hour;
    s.direct_normal = direct;
    s.diffuse_horizontal = diffuse;
  }

  void read_epw();
  void read_epw_row(const std::vector<std::string>& f);
  void read_wea();
  double read_wea_field(const char* name, double least, double most);
  void fill_gaps();
  void place_suns();

  std::string path_, text_;
  LineReader lines_;
  WeatherYear year_;
  std::vector<Row> rows_;
  int rows_of_hour_ = 0, last_hour_ = -1;  // EPW: rows so far of the hour being read
  bool is_direct_horizontal_ = false;      // .wea
};

void YearReader::read_epw() {
  std::string_view line;
  if (!lines_.next(line)) fail("is empty");
  const std::vector<std::string> head = fields_of_row(line, ',');
  if (head[0] != "LOCATION" || head.size() < 9)
    fail(
        "is no weather file: an EPW file begins with LOCATION, and the name of a .wea file ends "
        "in .wea");
  year_.place = head[1];
  year_.latitude_deg = number(head[6], "latitude", -90, 90);
  year_.longitude_deg = number(head[7], "longitude", -180, 180);
  year_.zone_hours = number(head[8], "time zone", -14, 14);
  bool has_data = false;
  while (lines_.next(line)) {
    const std::vector<std::string> fields = fields_of_row(line, ',');
    if (has_data && fields.size() > 15) read_epw_row(fields);
    if (has_data || !fields[0].starts_with("DATA PERIODS")) continue;
    has_data = true;
    if (fields.size() > 2) year_.steps_per_hour = int(number(fields[2], "records per hour", 1, 60));
  }
}

// Hour 1 is the hour that ends at 01:00 [1].
void YearReader::read_epw_row(const std::vector<std::string>& f) {
  Row row{int(number(f[0], "year", 1900, 2200)), int(number(f[1], "month", 1, 12)),
          int(number(f[2], "day", 1, 31)), false};
  const int hour = int(number(f[3], "hour", 1, 24));
  rows_of_hour_ = hour == last_hour_ ? rows_of_hour_ + 1 : 0;
  last_hour_ = hour;
  if (rows_of_hour_ >= year_.steps_per_hour) {
    if (year_.steps_per_hour > 1 || rows_of_hour_ > 1) fail("the hour has too many rows");
    rows_of_hour_ = 0;  // the same hour of another day
  }
  const double direct = irradiance(f[14], "field 15", row.is_missing);
  const double diffuse = irradiance(f[15], "field 16", row.is_missing);
  add(row, hour - 1 + (rows_of_hour_ + 0.5) / year_.steps_per_hour, direct, diffuse);
}

double YearReader::read_wea_field(const char* name, double least, double most) {
  std::string_view line;
  if (!lines_.next(line) || !line.starts_with(name))
    fail(fmt::format("\"{}\" expected, as in Radiance's weather files", name));
  std::string value(line.substr(std::string_view(name).size()));
  value.erase(0, value.find_first_not_of(" \t"));
  value.erase(value.find_last_not_of(" \t") + 1);
  return number(value, name, least, most);
}

void YearReader::read_wea() {
  std::string_view line;
  if (!lines_.next(line) || !line.starts_with("place "))
    fail("is no weather file: a .wea file begins with \"place\"");
  year_.place = std::string(line.substr(6));
  year_.latitude_deg = read_wea_field("latitude", -90, 90);
  year_.longitude_deg = -read_wea_field("longitude", -180, 180);  // degrees west [2]
  year_.zone_hours = -read_wea_field("time_zone", -210, 210) / 15;
  read_wea_field("site_elevation", -1000, 10000);
  const double units = read_wea_field("weather_data_file_units", 1, 3);
  if (units == 3) fail("illuminances (weather_data_file_units 3) are not supported");
  is_direct_horizontal_ = units == 2;
  while (lines_.next(line)) {
    std::istringstream words{std::string(line)};
    std::vector<std::string> f;
    for (std::string word; words >> word;) f.push_back(word);
    if (f.empty()) continue;
    if (f.size() < 5) fail("month, day, hour, direct and diffuse irradiance expected");
    Row row{plain_year, int(number(f[0], "month", 1, 12)), int(number(f[1], "day", 1, 31)), false};
    const double hour = number(f[2], "hour", 0, 24);
    const double direct = irradiance(f[3], "direct irradiance", row.is_missing);
    add(row, std::min(hour, 23.9999), direct, irradiance(f[4], "diffuse", row.is_missing));
  }
  // The shortest distance between steps of a day gives the time step.
  double least = 1;
  for (size_t i = 1; i < year_.steps.size(); ++i) {
    const double gap = year_.steps[i].hour - year_.steps[i - 1].hour;
    if (gap > 1e-3) least = std::min(least, gap);
  }
  year_.steps_per_hour = int(std::lround(1 / least));
}

void YearReader::fill_gaps() {
  std::vector<WeatherStep>& steps = year_.steps;
  const auto n = std::ptrdiff_t(steps.size());
  const std::ptrdiff_t day = 24 * year_.steps_per_hour;
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    if (!rows_[size_t(i)].is_missing) continue;
    std::ptrdiff_t from = -1;
    for (std::ptrdiff_t d = day; d < n && from < 0; d += day)
      for (const std::ptrdiff_t k : {i - d, i + d})
        if (from < 0 && k >= 0 && k < n && !rows_[size_t(k)].is_missing) from = k;
    if (from < 0) throw InputError(path_, 0, 0, "has irradiances for too few hours");
    steps[size_t(i)].direct_normal = steps[size_t(from)].direct_normal;
    steps[size_t(i)].diffuse_horizontal = steps[size_t(from)].diffuse_horizontal;
    ++year_.filled;
  }
}

void YearReader::place_suns() {
  for (size_t i = 0; i < year_.steps.size(); ++i) {
    WeatherStep& s = year_.steps[i];
    const int wea_year = year_.has_leap_day ? leap_year : plain_year;
    const int year = rows_[i].year == plain_year ? wea_year : rows_[i].year;
    s.sun = sun_position(year_.latitude_deg, year_.longitude_deg,
                         julian_day(year, s.month, s.day, s.hour - year_.zone_hours));
    const int of_months = year_.has_leap_day ? leap_year : plain_year;
    s.hour_of_year =
        24 * (julian_day(of_months, s.month, s.day, 0) - julian_day(of_months, 1, 1, 0)) + s.hour;
    const double sine = std::sin(rad_from_deg(s.sun.altitude_deg));
    // The divisor is that of a sun 2 degrees high at least: rows near sunset would blow up.
    if (is_direct_horizontal_) s.direct_normal /= std::max(sine, 0.035);
  }
}

}  // namespace

WeatherYear read_weather_year(const std::string& path) {
  return YearReader(path).read();
}

}  // namespace troffer
