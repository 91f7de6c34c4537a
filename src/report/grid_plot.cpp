#include "report/grid_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/false_colour.h"
#include "report/html_text.h"
#include "report/isolines.h"

namespace troffer {

namespace {

constexpr double left = 52, top = 12, right = 96, bottom = 46;  // margins, px
constexpr double most_width = 560, most_height = 400;

struct Frame2 {
  double scale = 1, width = 0, height = 0;  // px per metre; of the surface, px
  double x(double m) const { return left + m * scale; }
  double y(double m) const { return top + height - m * scale; }
};

Frame2 frame_of(const AssessedSurface& s) {
  Frame2 f;
  f.scale = std::min(most_width / s.width, most_height / s.height);
  f.width = s.width * f.scale;
  f.height = s.height * f.scale;
  return f;
}

// Of a mark: as few digits as tell it.
std::string mark_text(double v) {
  return std::abs(v) >= 1000 ? fmt::format("{:.0f}", v) : fmt::format("{:.3g}", v);
}

struct Range {
  double least, largest;
  double share(double v) const { return largest > least ? (v - least) / (largest - least) : 0.5; }
};

Range range_of(const std::vector<Figure>& values) {
  Range r{std::numeric_limits<double>::max(), 0};
  for (const Figure& f : values) r = {std::min(r.least, f.value), std::max(r.largest, f.value)};
  return r;
}

std::string cells(const SurfaceGrid& g, const std::vector<Figure>& values, const Frame2& f,
                  const Range& range) {
  const double w = g.cell.x * f.scale, h = g.cell.y * f.scale;
  const bool has_text = w >= 24 && h >= 11;
  std::string shapes, texts;
  for (size_t i = 0; i < g.points.size(); ++i) {
    const GridPoint& p = g.points[i];
    const Rgb8 c = false_colour(range.share(values[i].value));
    const double x = f.x(g.first.x + g.cell.x * p.column);
    const double y = f.y(g.first.y + g.cell.y * (p.row + 1));
    shapes += fmt::format(
        "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\"/>", x, y, w,
        h, hex_colour(c));
    if (has_text)
      texts +=
          fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" fill=\"{}\">{}</text>", x + w / 2,
                      y + h / 2 + 3, is_dark(c) ? "#fff" : "#111", short_number(values[i].value));
  }
  return "<g shape-rendering=\"crispEdges\">" + shapes +
         "</g><g font-size=\"8.5\" text-anchor=\"middle\" fill-opacity=\".8\">" + texts + "</g>";
}

// Levels of isolux lines: round values well within the range.
std::vector<double> levels_of(const Range& range) {
  if (!(range.largest > range.least)) return {};
  std::vector<double> levels =
      round_values(std::max(range.least, range.largest * 1e-3), range.largest, 7, false);
  std::erase_if(levels, [&](double v) { return v <= range.least || v >= range.largest; });
  return levels;
}

std::string lines(const SurfaceGrid& g, const std::vector<Figure>& values, const Frame2& f,
                  const Range& range) {
  ValueGrid grid{g.shape.columns, g.shape.rows, {}};
  grid.values.assign(size_t(grid.columns) * size_t(grid.rows),
                     std::numeric_limits<double>::quiet_NaN());
  for (size_t i = 0; i < g.points.size(); ++i)
    grid.values[size_t(g.points[i].row) * size_t(grid.columns) + size_t(g.points[i].column)] =
        values[i].value;
  const auto place = [&](const Vec2d& p) {
    return fmt::format("{:.1f},{:.1f}", f.x(g.first.x + g.cell.x * p.x),
                       f.y(g.first.y + g.cell.y * p.y));
  };
  std::string drawn, labels;
  for (const double level : levels_of(range))
    for (const Line& line : isolines(grid, level)) {
      std::string points;
      for (const Vec2d& p : line) points += (points.empty() ? "" : " ") + place(p);
      drawn += "<polyline points=\"" + points + "\"/>";
      if (line.size() < 4) continue;
      const Vec2d& at = line[line.size() / 2];
      labels +=
          fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", f.x(g.first.x + g.cell.x * at.x),
                      f.y(g.first.y + g.cell.y * at.y) + 3.5, mark_text(level));
    }
  return "<g fill=\"none\" stroke=\"#fff\" stroke-width=\"3\" stroke-opacity=\".55\">" + drawn +
         "</g><g fill=\"none\" stroke=\"#111\" stroke-width=\"1.1\">" + drawn +
         "</g><g font-size=\"11\" font-weight=\"bold\" text-anchor=\"middle\" stroke=\"#fff\" "
         "stroke-width=\"3\" paint-order=\"stroke\">" +
         labels + "</g>";
}

// Every round number of metres, so that some eight fit.
std::vector<double> ticks(double size) {
  std::vector<double> t{0};
  for (const double v : round_values(size * 1e-6, size, 8, false))
    if (v > 0) t.push_back(v);
  return t;
}

std::string axes(const AssessedSurface& s, const Frame2& f) {
  std::string out = "<g stroke=\"#444\" stroke-width=\"1\" fill=\"none\">";
  for (const auto& e : s.rim)
    out += fmt::format("<path d=\"M{:.1f},{:.1f}L{:.1f},{:.1f}\"/>", f.x(e[0].x), f.y(e[0].y),
                       f.x(e[1].x), f.y(e[1].y));
  std::string marks, texts;
  for (const double v : ticks(s.width)) {
    marks += fmt::format("<path d=\"M{0:.1f},{1:.1f}v5\"/>", f.x(v), f.y(0));
    texts += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{:.4g}</text>",
                         f.x(v), f.y(0) + 17, v);
  }
  for (const double v : ticks(s.height)) {
    marks += fmt::format("<path d=\"M{0:.1f},{1:.1f}h-5\"/>", f.x(0), f.y(v));
    texts += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{:.4g}</text>",
                         f.x(0) - 8, f.y(v) + 4, v);
  }
  const double x = left + f.width / 2, y = top + f.height / 2;
  texts += fmt::format(
      "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">x, m</text><text "
      "text-anchor=\"middle\" "
      "transform=\"translate(14 {:.1f}) rotate(-90)\">y, m</text>",
      x, f.y(0) + 36, y);
  return out + marks + "</g><g font-size=\"11\">" + texts + "</g>";
}

// A bar of `height` px at x, its marks by `share` of their values.
template <class Share>
std::string bar(double x, double height, const std::vector<double>& marks, const Share& share,
                const std::string& unit) {
  constexpr int steps = 48;
  std::string out = "<g shape-rendering=\"crispEdges\">";
  for (int i = 0; i < steps; ++i)
    out +=
        fmt::format("<rect x=\"{:.1f}\" y=\"{:.2f}\" width=\"14\" height=\"{:.2f}\" fill=\"{}\"/>",
                    x, top + height * (1 - double(i + 1) / steps), height / steps + 0.3,
                    hex_colour(false_colour((i + 0.5) / steps)));
  out += "</g><g font-size=\"11\">";
  for (const double v : marks) {
    const double y = top + height * (1 - share(v));
    out += fmt::format(
        "<path d=\"M{0:.1f},{1:.1f}h4\" stroke=\"#444\"/><text x=\"{2:.1f}\" "
        "y=\"{3:.1f}\">{4}</text>",
        x + 14, y, x + 21, y + 4, mark_text(v));
  }
  return out + fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text></g>", x, top + height + 17,
                           html_text(unit));
}

std::string svg(double width, double height, const std::string& title, const std::string& inner) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
      "width=\"{0:.0f}\" height=\"{1:.0f}\" font-family=\"sans-serif\"><title>{2}</title>{3}</svg>",
      width, height, html_text(title), inner);
}

}  // namespace

std::string grid_plot(const AssessedSurface& s, const SurfaceGrid& g,
                      const std::vector<Figure>& values, const std::string& unit) {
  const Frame2 f = frame_of(s);
  const Range range = range_of(values);
  std::vector<double> marks{range.least};
  for (const double v : levels_of(range)) marks.push_back(v);
  marks.push_back(range.largest);
  if (!(range.largest > range.least)) marks.resize(1);
  // Marks that lie on each other are left out, but for the ends.
  for (size_t i = 1; i + 1 < marks.size();)
    if (range.share(marks[i]) < 0.1 || range.share(marks[i]) > 0.9)
      marks.erase(marks.begin() + std::ptrdiff_t(i));
    else
      ++i;
  const double height = std::max(f.height, 90.0);
  return svg(
      left + f.width + right, top + height + bottom, s.name,
      cells(g, values, f, range) + lines(g, values, f, range) + axes(s, f) +
          bar(
              left + f.width + 22, height, marks, [&](double v) { return range.share(v); }, unit));
}

std::string factor_legend(double least, double largest, const std::string& unit) {
  constexpr double height = 220;
  return svg(right, top + height + 24, unit,
             bar(
                 4, height, round_values(least, largest, 12, true),
                 [&](double v) { return std::log(v / least) / std::log(largest / least); }, unit));
}

}  // namespace troffer
