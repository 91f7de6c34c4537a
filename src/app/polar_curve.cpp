#include "app/polar_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "image/atomic_file.h"
#include "image/write_image.h"
#include "import/file.h"
#include "light/web.h"

namespace troffer {

namespace {

constexpr double side_length = 480, middle = side_length / 2, reach = 200;  // pixels
constexpr int rings = 4;

// Returns the scale's largest intensity: 1, 2, 2.5, 4, 5 or 8 times a power of ten, which `rings`
// divides evenly.
double scale_of(const LightWeb& web) {
  const auto largest = double(largest_intensity(web));
  const double power = std::pow(10, std::floor(std::log10(largest)));
  for (const double step : {1.0, 2.0, 2.5, 4.0, 5.0, 8.0})
    if (step * power >= largest) return step * power;
  return 10 * power;
}

// Returns the curve in the plane at `turn`, a full circle in steps of one degree.
std::vector<Vec2d> curve(const LightWeb& web, double turn, double scale) {
  std::vector<Vec2d> points;
  for (int i = 0; i <= 360; ++i) {
    const double angle = rad_from_deg(double(i));
    const double across = std::sin(angle), down = std::cos(angle);
    const Vec3 w(Vec3d{across * std::cos(turn), across * std::sin(turn), down});
    const double r = reach * double(intensity(web, w)) / scale;
    points.emplace_back(middle + r * across, middle + r * down);
  }
  return points;
}

struct Stroke {
  std::vector<Vec2d> points;
  Rgb colour;
  double width;
  bool is_dashed;
};

std::vector<Stroke> strokes_of(const LightWeb& web, double scale) {
  std::vector<Stroke> strokes;
  const Rgb grey(.75f, .75f, .75f);
  for (int ring = 1; ring <= rings; ++ring) {
    Stroke s{{}, grey, 1, false};
    for (int i = 0; i <= 120; ++i) {
      const double a = rad_from_deg(3.0 * i), r = reach * ring / rings;
      s.points.emplace_back(middle + r * std::sin(a), middle + r * std::cos(a));
    }
    strokes.push_back(std::move(s));
  }
  for (int spoke = 0; spoke < 12; ++spoke) {
    const double a = rad_from_deg(30.0 * spoke);
    strokes.push_back(
        {{{middle, middle}, {middle + reach * std::sin(a), middle + reach * std::cos(a)}},
         grey,
         1,
         false});
  }
  strokes.push_back({curve(web, pi / 2, scale), Rgb{.1f, .3f, .8f}, 2.5, true});
  strokes.push_back({curve(web, 0, scale), Rgb{.8f, .1f, .1f}, 2.5, false});
  return strokes;
}

std::string colour_of(const Rgb& c) {
  const auto byte = [](float v) { return int(std::lround(v * 255)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(c.r), byte(c.g), byte(c.b));
}

std::string svg_of(const std::vector<Stroke>& strokes, double scale) {
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{0}\">\n"
      "<rect width=\"{0}\" height=\"{0}\" fill=\"white\"/>\n",
      side_length);
  for (const Stroke& s : strokes) {
    text +=
        fmt::format("<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{} points=\"",
                    colour_of(s.colour), s.width, s.is_dashed ? " stroke-dasharray=\"8 5\"" : "");
    for (const Vec2d& p : s.points) text += fmt::format("{:.2f},{:.2f} ", p.x, p.y);
    text += "\"/>\n";
  }
  text += "<g font-family=\"sans-serif\" font-size=\"11\" fill=\"#444\">\n";
  for (int ring = 1; ring <= rings; ++ring)
    text += fmt::format("<text x=\"{}\" y=\"{}\">{:g}</text>\n", middle + 3,
                        middle - reach * ring / rings - 2, scale * ring / rings);
  for (int spoke = 1; spoke < 6; ++spoke) {
    const double a = rad_from_deg(30.0 * spoke);
    for (const double side : {1.0, -1.0})
      text += fmt::format("<text text-anchor=\"middle\" x=\"{:.1f}\" y=\"{:.1f}\">{}°</text>\n",
                          middle + side * (reach + 18) * std::sin(a),
                          middle + (reach + 18) * std::cos(a) + 4, 30 * spoke);
  }
  text += fmt::format(
      "<text x=\"8\" y=\"{0}\" fill=\"#cc1a1a\">C0–C180</text>\n"
      "<text x=\"{1}\" y=\"{0}\" fill=\"#1a4dcc\">C90–C270</text>\n"
      "<text x=\"8\" y=\"16\">cd</text>\n</g>\n</svg>\n",
      side_length - 8, side_length - 70);
  return text;
}

double distance_to(const Vec2d& p, const Vec2d& a, const Vec2d& b) {
  const double x = b.x - a.x, y = b.y - a.y, d2 = x * x + y * y;
  const double t = d2 > 0 ? std::clamp(((p.x - a.x) * x + (p.y - a.y) * y) / d2, 0.0, 1.0) : 0.0;
  return std::hypot(p.x - a.x - t * x, p.y - a.y - t * y);
}

// Blends a line's colour into every pixel by the covered share.
void draw(const Stroke& s, Image& image) {
  double passed = 0;
  for (size_t i = 1; i < s.points.size(); ++i) {
    const Vec2d &a = s.points[i - 1], &b = s.points[i];
    const double before = passed;
    passed += std::hypot(b.x - a.x, b.y - a.y);
    if (s.is_dashed && std::fmod(before, 13) > 8) continue;
    const auto low = [&](double u, double v) {
      return int(std::clamp(std::min(u, v) - s.width, 0.0, side_length - 1));
    };
    const auto high = [&](double u, double v) {
      return int(std::clamp(std::max(u, v) + s.width, 0.0, side_length - 1));
    };
    for (int y = low(a.y, b.y); y <= high(a.y, b.y); ++y)
      for (int x = low(a.x, b.x); x <= high(a.x, b.x); ++x) {
        const double d = distance_to({x + 0.5, y + 0.5}, a, b);
        const auto share = float(std::clamp(s.width / 2 + 0.5 - d, 0.0, 1.0));
        Rgb& pixel = image.at(x, y);
        const Rgb wanted = Rgb{1 - share} + s.colour * share;
        pixel = Rgb{std::min(pixel.r, wanted.r), std::min(pixel.g, wanted.g),
                    std::min(pixel.b, wanted.b)};
      }
  }
}

Image image_of(const std::vector<Stroke>& strokes) {
  constexpr auto n = int(side_length);
  Image image(n, n, Rgb{1});
  for (const Stroke& s : strokes) draw(s, image);
  for (Rgb& p : image.pixels)  // stroke colours are screen values: convert them to linear light
    p = Rgb{std::pow(p.r, 2.2f), std::pow(p.g, 2.2f), std::pow(p.b, 2.2f)};
  return image;
}

}  // namespace

void write_polar_curve(const std::string& path, const LightWeb& web) {
  const std::string ending = lower_case_ending(path);
  const double scale = scale_of(web);
  const std::vector<Stroke> strokes = strokes_of(web, scale);
  if (ending == "svg") {
    write_file(path, svg_of(strokes, scale));
  } else if (ending == "png") {
    WriteOptions options;
    options.display.tone_map = ToneMap::none;
    write_image(path, image_of(strokes), options);
  } else {
    throw UsageError("--polar: '" + path + "' is neither an .svg nor a .png");
  }
}

}  // namespace troffer
