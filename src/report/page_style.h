// Style of a report's page on screens and on paper (A4).
#pragma once

namespace troffer {

// CSS, for a <style> element.
extern const char* const page_style;

// Widths of drawings, CSS px: the full width between the margins of an A4 page, and half of it for
// two drawings side by side.
constexpr double full_width = 684, half_width = 334;

}  // namespace troffer
