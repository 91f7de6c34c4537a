#include "annual/annual_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"
#include "image/encode.h"
#include "report/false_colour.h"
#include "report/grid_plot.h"
#include "report/html_text.h"
#include "report/page_style.h"
#include "report/plan_view.h"
#include "report/svg.h"

namespace troffer {

namespace {

double share_of(const ColourRange& range, double v) {
  return (v - range.least) / std::max(range.largest - range.least, 1e-30);
}

std::string legend(const ColourRange& range, const std::string& unit, double width) {
  return scale_legend({range.least, range.largest}, unit, width);
}

// Smallest distance between sensors, to size their squares: over neighbours in order.
double spacing_of(const std::vector<Vec2d>& points) {
  double least = std::numeric_limits<double>::infinity();
  const size_t n = points.size();
  for (size_t i = 0; i < n; ++i)
    for (size_t k = i + 1; k < std::min(n, i + 2); ++k) {
      const Vec2d d = points[k] - points[i];
      const double distance = std::sqrt(dot(d, d));
      if (distance > 1e-6) least = std::min(least, distance);
    }
  return std::isfinite(least) ? least : 1;
}

// A value of at most four digits: "412", "9999", "14k".
std::string plan_value(double v) {
  return v < 9999.5 ? fmt::format("{:.0f}", v) : fmt::format("{:.0f}k", v / 1000);
}

struct PlanFrame {
  double left = 0, top = 0, scale = 1, width = 0, height = 0;
  double x(const Vec2d& p) const { return (p.x - left) * scale; }
  double y(const Vec2d& p) const { return (top - p.y) * scale; }
};

constexpr double margin_of_compass = 36;  // px, to the right of a plan

PlanFrame frame_of(const std::vector<Vec2d>& points, double spacing, double width) {
  Vec2d low = points[0], high = points[0];
  for (const Vec2d& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const double across = high.x - low.x + spacing, along = high.y - low.y + spacing;
  PlanFrame f;
  f.left = low.x - spacing / 2;
  f.top = high.y + spacing / 2;
  f.scale = std::min((width - margin_of_compass) / across, width / along);
  f.width = across * f.scale + margin_of_compass;
  f.height = along * f.scale;
  return f;
}

std::string north_arrow(const Vec2d& north, double x, double y) {
  const double length = std::max(std::sqrt(dot(north, north)), 1e-9);
  const double dx = north.x / length * 12, dy = -north.y / length * 12;
  return fmt::format(
             "<g stroke=\"#1b1f24\" fill=\"none\"><circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" "
             "r=\"2\"/>{2}</g>",
             x, y, svg_line(x - dx, y - dy, x + dx, y + dy)) +
         svg_text(x + 1.4 * dx, y + 1.4 * dy + 4, "middle", "N", "font-size=\"10\"");
}

}  // namespace

std::string grid_plan(const AnnualReport& report, const AnnualGrid& grid,
                      std::span<const double> values, const std::string& unit,
                      const ColourRange& range, double width) {
  const PlanAxes axes = plan_axes(report.compass.up);
  std::vector<Vec2d> points;
  for (size_t s = grid.first; s < grid.first + grid.count; ++s)
    points.push_back(axes.of(report.points[s].position));
  const double spacing = spacing_of(points);
  const PlanFrame f = frame_of(points, spacing, width);
  const double side = spacing * f.scale;
  const bool shows_values = side >= 17;
  std::string inner;
  for (size_t i = 0; i < points.size(); ++i) {
    const Rgb8 colour = false_colour(share_of(range, values[i]));
    inner += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
        "fill=\"{}\"/>",
        f.x(points[i]) - side / 2, f.y(points[i]) - side / 2, side, side, hex_colour(colour));
    if (shows_values)
      inner += svg_text(f.x(points[i]), f.y(points[i]) + 3, "middle", plan_value(values[i]),
                        fmt::format("font-size=\"{:.1f}\" fill=\"{}\"", std::min(10.0, side / 2.6),
                                    is_dark(colour) ? "#fff" : "#000"));
  }
  const Vec3d north = report.compass.north;
  inner += north_arrow(axes.of(north), f.width - margin_of_compass / 2, 22);
  return svg_element(f.width, f.height, grid.name, inner) + legend(range, unit, width);
}

namespace {

// Colour of a level of protection from glare (glare_level()).
const char* level_colour(const std::string& level) {
  if (level == "high") return "#2f7d3b";
  if (level == "medium") return "#8a7a00";
  return level == "minimum" ? "#b8580a" : "#b3261e";
}

std::string eye_mark(const EyeYear& eye, const Vec2d& ahead, double x, double y, size_t number) {
  constexpr double radius = 9, reach = 26;
  const std::string colour = level_colour(glare_level(eye));
  const double dx = ahead.x * reach, dy = -ahead.y * reach;
  return fmt::format("<g stroke=\"{}\" stroke-width=\"3\">{}</g>", colour,
                     svg_line(x, y, x + dx, y + dy)) +
         fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\"/>", x, y, radius,
                     colour) +
         svg_text(x, y + 4, "middle", fmt::format("{}", number),
                  "font-size=\"11\" font-weight=\"bold\" fill=\"#fff\"");
}

}  // namespace

std::string eyes_plan(const AnnualReport& report, double width) {
  const PlanAxes axes = plan_axes(report.compass.up);
  std::vector<Vec2d> sensors, all;
  for (const AnnualGrid& g : report.grids)
    for (size_t s = g.first; s < g.first + g.count; ++s)
      sensors.push_back(axes.of(report.points[s].position));
  all = sensors;
  for (const EyeYear& e : report.extras.eyes) all.push_back(axes.of(e.eye.position));
  const double spacing = spacing_of(sensors);
  const PlanFrame f = frame_of(all, spacing, width);
  const double side = 0.9 * spacing * f.scale;
  std::string inner;
  for (const Vec2d& p : sensors)
    inner += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"#e4e7eb\"/>",
        f.x(p) - side / 2, f.y(p) - side / 2, side, side);
  size_t number = 0;
  for (const EyeYear& e : report.extras.eyes) {
    const Vec2d p = axes.of(e.eye.position);
    inner += eye_mark(e, axes.of(Vec3d(e.eye.normal)), f.x(p), f.y(p), ++number);
  }
  inner += north_arrow(axes.of(report.compass.north), f.width - margin_of_compass / 2, 22);
  return svg_element(f.width, f.height, "Eyes in the plan", inner);
}

std::string day_hour_map(const AnnualReport& report, std::span<const float> values,
                         const std::string& unit, const ColourRange& range,
                         const std::string& title) {
  const int rows = 24 * report.year.steps_per_hour;
  const int days = report.year.has_leap_day ? 366 : 365;
  // Night is dark grey.
  std::vector<uint8_t> texels(size_t(days) * size_t(rows) * 3, 40);
  for (size_t h = 0; h < values.size(); ++h) {
    const WeatherStep& s = report.year.steps[report.result.skies.steps[h]];
    const int day = int(s.hour_of_year / 24);
    const int row = rows - 1 - int(s.hour * report.year.steps_per_hour);
    if (day < 0 || day >= days || row < 0 || row >= rows) continue;
    const Rgb8 c = false_colour(share_of(range, double(values[h])));
    std::copy(c.begin(), c.end(), &texels[(size_t(row) * size_t(days) + size_t(day)) * 3]);
  }
  constexpr double left = 34, height = 150, base = 20;
  const double width = full_width - left;
  std::string inner = fmt::format(
      "<image x=\"{}\" y=\"4\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" "
      "style=\"image-rendering:pixelated\" href=\"data:image/png;base64,{}\"/>",
      left, width, height, base64(encode_png_texels(days, rows, 3, texels)));
  const std::string small = "font-size=\"10\"";
  for (int hour = 0; hour <= 24; hour += 6)
    inner += svg_text(left - 4, 4 + height * (1 - hour / 24.0) + 3.5, "end",
                      fmt::format("{} h", hour), small);
  constexpr std::array months{"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                              "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  for (size_t m = 0; m < months.size(); ++m)
    inner += svg_text(left + width * (double(m) + 0.5) / 12, 4 + height + 14, "middle", months[m],
                      small);
  return svg_element(full_width, height + base + 4, title, inner) + legend(range, unit, full_width);
}

namespace {

// Position of the sun on a disc: the zenith in the middle, the horizon at the rim, north at the
// top, east to the right.
Vec2d on_disc(const SunPosition& sun, double radius) {
  const double r = radius * (1 - sun.altitude_deg / 90), azimuth = rad_from_deg(sun.azimuth_deg);
  return {radius + r * std::sin(azimuth), radius - r * std::cos(azimuth)};
}

SunPosition sun_on(const WeatherYear& year, int month, double hour) {
  constexpr int any_year = 2015;
  return sun_position(year.latitude_deg, year.longitude_deg,
                      julian_day(any_year, month, 21, hour - year.zone_hours));
}

}  // namespace

std::string sun_paths(const WeatherYear& year, double side) {
  constexpr double margin = 16;
  const double radius = side / 2 - margin;
  std::string rings, paths, marks;
  for (const int altitude : {0, 30, 60})
    rings += fmt::format("<circle cx=\"{0:.1f}\" cy=\"{0:.1f}\" r=\"{1:.1f}\"/>", radius,
                         radius * (1 - altitude / 90.0));
  for (const int month : {6, 5, 4, 3, 2, 1, 12}) {
    std::string line;
    for (double hour = 0; hour <= 24; hour += 0.125) {
      const SunPosition sun = sun_on(year, month, hour);
      if (!(sun.altitude_deg > 0)) {
        line += line.empty() || line.back() == ' ' ? "" : " ";
        continue;
      }
      const Vec2d p = on_disc(sun, radius);
      line +=
          fmt::format("{}{:.1f},{:.1f}", line.empty() || line.back() == ' ' ? "M" : "L", p.x, p.y);
      const bool is_whole = std::abs(hour - std::round(hour)) < 1e-9;
      if (!is_whole) continue;
      marks += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"1.8\"/>", p.x, p.y);
      if (month == 6 && int(hour) % 3 == 0)
        marks += svg_text(p.x, p.y - 4, "middle", fmt::format("{:.0f} h", hour), "font-size=\"9\"");
    }
    paths += fmt::format("<path d=\"{}\"/>", line);
  }
  std::string compass;
  const std::string small = "font-size=\"11\"";
  compass += svg_text(radius, -4, "middle", "N", small);
  compass += svg_text(radius, 2 * radius + 12, "middle", "S", small);
  compass += svg_text(2 * radius + 4, radius + 4, "start", "E", small);
  compass += svg_text(-4, radius + 4, "end", "W", small);
  return svg_element(
      side, side, "Paths of the sun",
      fmt::format("<g transform=\"translate({0},{0})\"><g fill=\"none\" stroke=\"#b9c0c8\">{1}</g>"
                  "<g fill=\"none\" stroke=\"#c26a00\" stroke-width=\"1.3\">{2}</g>"
                  "<g fill=\"#c26a00\">{3}</g>{4}</g>",
                  margin, rings, paths, marks, compass));
}

}  // namespace troffer
