// Formats text, numbers and bytes for HTML, SVG and CSV.
// Pages, plots and tables of reports use it. Names in scenes may contain any bytes; these functions
// make them safe to embed.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace troffer {

// Returns the text for HTML content and quoted attributes. & < > " ' become entities. Control
// characters (C0 except tab and line feed, DEL, C1), invalid UTF-8, and characters that change the
// direction of text (U+202A–U+202E, U+2066–U+2069) become U+FFFD.
std::string html_text(std::string_view text);

// Returns a name or path for a table: html_text() that may break lines after / \ _ - . : and within
// runs of more than 32 bytes.
std::string html_name(std::string_view text);

// Returns a CSV field (RFC 4180), always in quotes. Text that spreadsheets would take for a formula
// begins with an apostrophe.
std::string csv_field(std::string_view text);

std::string base64(std::span<const uint8_t> bytes);  // RFC 4648

// Formats a number for a table by its size: "412", "41.2", "0.412".
std::string short_number(double v);
// Formats a value with its error: "512.3 ± 3.2". It rounds to the second digit of the error, or to
// the first one if the value then shows four digits. At most 4 decimals.
std::string with_error(double value, double error);

}  // namespace troffer
