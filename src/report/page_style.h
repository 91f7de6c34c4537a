// How a report's page looks on screens and on paper (A4).
#pragma once

namespace troffer {

// CSS, for a <style> element.
extern const char* const page_style;

// Widths of drawings, px of CSS: what fits between the margins of an A4 page, and two beside each
// other.
constexpr double full_width = 684, half_width = 334;

}  // namespace troffer
