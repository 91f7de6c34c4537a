#include "report/grid_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/false_colour.h"
#include "report/html_text.h"
#include "report/isolines.h"
#include "report/svg.h"

namespace troffer {

namespace {

constexpr double left = 34, top = 8, right = 8, bottom = 32;  // margins, px
constexpr double value_size = 9.5, label_size = 10.5;         // px: 7 and 8 points on paper
constexpr double digit = 0.56;  // width of a digit, relative to the text size

struct Frame2 {
  double scale = 1, width = 0, height = 0;  // px per metre; size of the surface, px
  double x(double m) const { return left + m * scale; }
  double y(double m) const { return top + height - m * scale; }
};

Frame2 frame_of(const AssessedSurface& s, double width) {
  Frame2 f;
  const double room = width - left - right;
  f.scale = std::min(room / s.width, 0.55 * width / s.height);
  f.width = s.width * f.scale;
  f.height = s.height * f.scale;
  return f;
}

// Formats a value with enough digits to differ from neighbouring marks.
std::string mark_text(double v) {
  return std::abs(v) >= 1000 ? fmt::format("{:.0f}", v) : fmt::format("{:.3g}", v);
}

struct Box2 {
  double x0, y0, x1, y1;
  bool meets(const Box2& o) const { return x0 < o.x1 && o.x0 < x1 && y0 < o.y1 && o.y0 < y1; }
};

Box2 text_box(double x, double y, size_t letters, double size) {
  const double half = 0.5 * digit * size * double(letters) + 2;
  return {x - half, y - 0.5 * size - 1, x + half, y + 0.5 * size + 1};
}

bool is_free(const Box2& box, const std::vector<Box2>& taken) {
  return std::none_of(taken.begin(), taken.end(), [&](const Box2& t) { return t.meets(box); });
}

// Isolux levels: round values inside the range of a plot.
std::vector<double> levels_of(double least, double largest) {
  constexpr size_t most = 6;
  if (!(largest > least)) return {};
  std::vector<double> levels = round_values(std::max(least, largest * 1e-3), largest, most, false);
  std::erase_if(levels, [&](double v) { return v <= least || v >= largest; });
  return levels;
}

class Plot {
 public:
  Plot(const AssessedSurface& s, const SurfaceGrid& g, const std::vector<Figure>& values,
       const PlotScale& scale, double width)
      : surface_(s), grid_(g), values_(values), scale_(scale), frame_(frame_of(s, width)) {}

  std::string svg(const std::string& unit) {
    const std::string lines = isolux();  // labels take their places first; values fill the rest
    return svg_element(left + frame_.width + right, top + frame_.height + bottom,
                       surface_.name + ", " + unit, cells() + lines + numbers() + axes());
  }

 private:
  Vec2d place(const Vec2d& cell) const {
    return {frame_.x(grid_.first.x + grid_.cell.x * cell.x),
            frame_.y(grid_.first.y + grid_.cell.y * cell.y)};
  }

  std::string cells() const {
    const double w = grid_.cell.x * frame_.scale, h = grid_.cell.y * frame_.scale;
    std::string out = "<g shape-rendering=\"crispEdges\">";
    for (size_t i = 0; i < grid_.points.size(); ++i) {
      const Vec2d at = place({double(grid_.points[i].column), double(grid_.points[i].row + 1)});
      out += fmt::format(
          "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\"/>", at.x,
          at.y, w, h, hex_colour(false_colour(scale_.share(values_[i].value))));
    }
    return out + "</g>";
  }

  std::string isolux() {
    ValueGrid grid{grid_.shape.columns, grid_.shape.rows, {}};
    grid.values.assign(size_t(grid.columns) * size_t(grid.rows),
                       std::numeric_limits<double>::quiet_NaN());
    PlotScale own;
    widen(own, values_);
    for (size_t i = 0; i < grid_.points.size(); ++i)
      grid.values[size_t(grid_.points[i].row) * size_t(grid.columns) +
                  size_t(grid_.points[i].column)] = values_[i].value;
    std::string drawn, labels;
    for (const double level : levels_of(own.least, own.largest))
      for (const Line& line : isolines(grid, level)) {
        std::string points;
        for (const Vec2d& p : line) {
          const Vec2d at = place(p);
          points += fmt::format("{}{:.1f},{:.1f}", points.empty() ? "" : " ", at.x, at.y);
        }
        drawn += "<polyline points=\"" + points + "\"/>";
        labels += label(line, mark_text(level));
      }
    return "<g fill=\"none\" stroke=\"#fff\" stroke-width=\"2.6\" stroke-opacity=\".6\">" + drawn +
           "</g><g fill=\"none\" stroke=\"#111\" stroke-width=\"1\">" + drawn + "</g>" +
           fmt::format("<g font-size=\"{}\" font-weight=\"bold\">", label_size) + labels + "</g>";
  }

  // Places a label in a white box, at the point of the line that has room for it and is nearest to
  // the line's middle.
  std::string label(const Line& line, const std::string& text) {
    if (line.size() < 3) return {};
    const double half = 0.5 * digit * label_size * double(text.size()) + 3;
    for (size_t k = 0; k < line.size(); ++k) {
      const size_t step = (k + 1) / 2, middle = line.size() / 2;
      if (k % 2 == 1 ? step > middle : middle + step >= line.size()) continue;
      const Vec2d at = place(line[k % 2 == 1 ? middle - step : middle + step]);
      const Box2 box = text_box(at.x, at.y, text.size(), label_size);
      const bool is_in = box.x0 > left && box.x1 < left + frame_.width && box.y0 > top &&
                         box.y1 < top + frame_.height;
      if (!is_in || !is_free(box, taken_)) continue;
      taken_.push_back(box);
      return fmt::format(
                 "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" rx=\"2\" "
                 "fill=\"#fff\" fill-opacity=\".92\"/>",
                 at.x - half, at.y - 0.6 * label_size, 2 * half, 1.2 * label_size) +
             svg_text(at.x, at.y + 0.36 * label_size, "middle", text);
    }
    return {};
  }

  // Prints the values of a regular subset of points, as dense as the text allows.
  std::string numbers() const {
    size_t letters = 1;
    for (const Figure& f : values_) letters = std::max(letters, number(f.value).size());
    const double w = grid_.cell.x * frame_.scale, h = grid_.cell.y * frame_.scale;
    const int columns =
        std::max(1, int(std::ceil((digit * double(letters) + 0.6) * value_size / w)));
    const int rows = std::max(1, int(std::ceil(1.25 * value_size / h)));
    std::string out = fmt::format("<g font-size=\"{}\">", value_size);
    for (size_t i = 0; i < grid_.points.size(); ++i) {
      const GridPoint& p = grid_.points[i];
      if (p.column % columns != columns / 2 || p.row % rows != rows / 2) continue;
      const std::string text = number(values_[i].value);
      const Vec2d at = place({p.column + 0.5, p.row + 0.5});
      if (!is_free(text_box(at.x, at.y, text.size(), value_size), taken_)) continue;
      const Rgb8 colour = false_colour(scale_.share(values_[i].value));
      out += svg_text(at.x, at.y + 0.36 * value_size, "middle", text,
                      is_dark(colour) ? "fill=\"#fff\"" : "fill=\"#111\"");
    }
    return out + "</g>";
  }

  static std::string number(double v) {
    return std::abs(v) >= 20 ? fmt::format("{:.0f}", v) : short_number(v);
  }

  // Round values in metres for an axis, at most `most` and 0.
  static std::vector<double> ticks(double size) {
    constexpr size_t most = 8;
    std::vector<double> t{0};
    for (const double v : round_values(size * 1e-6, size, most, false))
      if (v > 0) t.push_back(v);
    return t;
  }

  std::string axes() const {
    std::string out = "<g stroke=\"#333\" stroke-width=\"1\" fill=\"none\">";
    for (const auto& e : surface_.rim)
      out += svg_line(frame_.x(e[0].x), frame_.y(e[0].y), frame_.x(e[1].x), frame_.y(e[1].y));
    std::string texts;
    for (const double v : ticks(surface_.width)) {
      out += svg_line(frame_.x(v), frame_.y(0), frame_.x(v), frame_.y(0) + 4);
      texts += svg_text(frame_.x(v), frame_.y(0) + 14, "middle", fmt::format("{:.4g}", v));
    }
    for (const double v : ticks(surface_.height)) {
      out += svg_line(frame_.x(0), frame_.y(v), frame_.x(0) - 4, frame_.y(v));
      texts += svg_text(frame_.x(0) - 6, frame_.y(v) + 3.5, "end", fmt::format("{:.4g}", v));
    }
    texts += svg_text(left + frame_.width / 2, frame_.y(0) + 27, "middle", "x, m");
    texts += fmt::format(
        "<text text-anchor=\"middle\" transform=\"translate(10 {:.1f}) rotate(-90)\">y, m</text>",
        top + frame_.height / 2);
    return out + fmt::format("</g><g font-size=\"{}\" fill=\"#333\">", value_size) + texts + "</g>";
  }

  const AssessedSurface& surface_;
  const SurfaceGrid& grid_;
  const std::vector<Figure>& values_;
  const PlotScale& scale_;
  Frame2 frame_;
  std::vector<Box2> taken_;  // boxes of labels
};

// Draws a bar of the colour scale with marks under it.
template <class Share>
std::string bar(double width, const std::vector<double>& marks, const Share& share,
                const std::string& unit) {
  constexpr int steps = 64;
  constexpr double height = 12, end = 48, begin = 14;
  const double length = width - begin - end;
  std::string out = "<g shape-rendering=\"crispEdges\">";
  for (int i = 0; i < steps; ++i)
    out += fmt::format("<rect x=\"{:.2f}\" y=\"2\" width=\"{:.2f}\" height=\"{}\" fill=\"{}\"/>",
                       begin + length * i / steps, length / steps + 0.4, height,
                       hex_colour(false_colour((i + 0.5) / steps)));
  out += fmt::format("</g><g font-size=\"{}\" fill=\"#333\" stroke-width=\"1\">", label_size);
  for (const double v : marks) {
    const double x = begin + length * share(v);
    out += "<g stroke=\"#333\">" + svg_line(x, height + 2, x, height + 6) + "</g>" +
           svg_text(x, height + 17, "middle", mark_text(v));
  }
  out += svg_text(begin + length + 8, height, "start", unit) + "</g>";
  return svg_element(width, height + 22, "scale, " + unit, out);
}

}  // namespace

void widen(PlotScale& scale, const std::vector<Figure>& values) {
  for (const Figure& f : values) {
    const bool is_first = scale.least == 0 && scale.largest == 0;
    scale.least = is_first ? f.value : std::min(scale.least, f.value);
    scale.largest = std::max(scale.largest, f.value);
  }
}

std::string grid_plot(const AssessedSurface& s, const SurfaceGrid& g,
                      const std::vector<Figure>& values, const std::string& unit,
                      const PlotScale& scale, double width) {
  return Plot(s, g, values, scale, width).svg(unit);
}

std::string scale_legend(const PlotScale& scale, const std::string& unit, double width) {
  std::vector<double> marks;
  if (scale.largest > scale.least)
    marks = round_values(std::max(scale.least, scale.largest * 1e-6), scale.largest, 10, false);
  else
    marks = {scale.least};
  return bar(
      width, marks, [&](double v) { return scale.share(v); }, unit);
}

std::string factor_legend(double least, double largest, const std::string& unit, double width) {
  return bar(
      width, round_values(least, largest, 12, true),
      [&](double v) { return std::log(v / least) / std::log(largest / least); }, unit);
}

}  // namespace troffer
