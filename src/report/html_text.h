// Text and bytes within HTML, SVG and CSV.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace troffer {

// As it may stand in HTML's text and in attributes in quotes: & < > " ' are entities, control
// characters (C0 but tab and line feed, DEL, C1) and what is no UTF-8 become U+FFFD, as does what
// turns the direction of text (U+202A–U+202E, U+2066–U+2069).
std::string html_text(std::string_view text);

// A name or a path for a table: html_text() with places where lines may break behind / \ _ - . :
// and within pieces of more than 32 bytes without any.
std::string html_name(std::string_view text);

// A CSV field (RFC 4180), always in quotes; a text that spreadsheets would take for a formula
// begins with an apostrophe.
std::string csv_field(std::string_view text);

std::string base64(std::span<const uint8_t> bytes);  // RFC 4648

// "412", "41.2", "0.412": as many digits as a table wants of a value, by its size.
std::string short_number(double v);
// "512.3 ± 3.2": rounded to where the error has its second digit, or its first where four digits of
// the value are there by then; at most 4 digits behind the point.
std::string with_error(double value, double error);

}  // namespace troffer
