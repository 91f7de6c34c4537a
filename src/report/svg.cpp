#include "report/svg.h"

#include <fmt/format.h>

#include "report/html_text.h"

namespace troffer {

std::string svg_element(double width, double height, const std::string& title,
                        const std::string& inner) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
      "width=\"{0:.0f}\" height=\"{1:.0f}\" font-family=\"sans-serif\"><title>{2}</title>{3}</svg>",
      width, height, html_text(title), inner);
}

std::string svg_line(double x0, double y0, double x1, double y1) {
  return fmt::format("<path d=\"M{:.1f},{:.1f}L{:.1f},{:.1f}\"/>", x0, y0, x1, y1);
}

std::string svg_text(double x, double y, const char* anchor, const std::string& text,
                     const std::string& attributes) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}{}>{}</text>", x, y,
                     anchor, attributes.empty() ? "" : " ", attributes, html_text(text));
}

}  // namespace troffer
