// Parts of SVG that all drawings of a report share. Coordinates are CSS px.
#pragma once

#include <string>

namespace troffer {

// Returns an SVG element for HTML, `width` × `height` CSS px. title: text for screen readers.
std::string svg_element(double width, double height, const std::string& title,
                        const std::string& inner);

std::string svg_line(double x0, double y0, double x1, double y1);
// anchor: "start", "middle" or "end". The text is escaped.
std::string svg_text(double x, double y, const char* anchor, const std::string& text,
                     const std::string& attributes = {});

}  // namespace troffer
