#include "report/polar_plot.h"

#include <fmt/format.h>

#include <cmath>

#include "base/units.h"
#include "report/html_text.h"
#include "report/svg.h"

namespace troffer {

namespace {

constexpr int rings = 2;

// Rounds up to 1, 2, 4, 6 or 8 times a power of ten, which two rings divide into round numbers.
double scale_of(double largest) {
  const double power = std::pow(10.0, std::floor(std::log10(largest)));
  for (const double step : {1.0, 2.0, 4.0, 6.0, 8.0})
    if (step * power >= largest * (1 - 1e-6)) return step * power;
  return 10 * power;
}

}  // namespace

std::string polar_plot(const PolarCurve& curve, const std::string& title, double side) {
  const double largest = curve.largest();
  if (!(largest > 0)) return {};
  const double scale = scale_of(largest), middle = side / 2, reach = side / 2 - 14;
  std::string out = "<g fill=\"none\" stroke=\"#c4cad1\" stroke-width=\"1\">";
  for (int r = 1; r <= rings; ++r)
    out += fmt::format("<circle cx=\"{0:.1f}\" cy=\"{0:.1f}\" r=\"{1:.1f}\"/>", middle,
                       reach * r / rings);
  for (int k = 0; k < 6; ++k) {
    const double a = rad_from_deg(30.0 * k), x = reach * std::sin(a), y = reach * std::cos(a);
    out += svg_line(middle - x, middle - y, middle + x, middle + y);
  }
  out += "</g><g fill=\"none\" stroke-width=\"1.6\">";
  for (size_t plane = 2; plane-- > 0;) {
    out += plane == 0 ? "<polyline stroke=\"#b3261e\" points=\""
                      : "<polyline stroke=\"#1f4e9e\" stroke-dasharray=\"5 3\" points=\"";
    for (int i = 0; i < PolarCurve::steps; ++i) {
      const double a = rad_from_deg(5.0 * i - 180);
      const double r = reach * curve.candela[plane][size_t(i)] / scale;
      out += fmt::format("{:.1f},{:.1f} ", middle + r * std::sin(a), middle + r * std::cos(a));
    }
    out += "\"/>";
  }
  out += "</g><g font-size=\"9.5\" fill=\"#333\">";
  for (int r = 1; r <= rings; ++r)
    out += svg_text(middle + 3, middle - reach * r / rings + 10, "start",
                    fmt::format("{:g}{}", scale * r / rings, r == rings ? " cd" : ""));
  return svg_element(side, side, "polar curve, " + title, out + "</g>");
}

}  // namespace troffer
