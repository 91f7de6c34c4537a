#include "base/time_text.h"

#include <cstdlib>

#include "base/error.h"

namespace troffer {

namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

}  // namespace

TimeText::TimeText(const std::string& text, const std::string& option, const char* expected)
    : text_(text), option_(option), expected_(expected), rest_(text) {
  while (!rest_.empty() && rest_.front() == ' ') rest_.remove_prefix(1);
  while (!rest_.empty() && rest_.back() == ' ') rest_.remove_suffix(1);
}

void TimeText::fail(const std::string& what) const {
  throw UsageError(option_ + ": '" + text_ + "': " + what + " (such as " + expected_ + ")");
}

bool TimeText::take(char sign) {
  if (rest_.empty() || rest_.front() != sign) return false;
  rest_.remove_prefix(1);
  return true;
}

void TimeText::expect(char sign, const char* before_what) {
  if (rest_.empty()) fail(std::string(before_what) + " is missing");
  if (!take(sign))
    fail(std::string("'") + sign + "' expected before " + before_what + ", not '" +
         std::string(rest_.substr(0, 10)) + "'");
}

int TimeText::number(const char* what, size_t most_digits, int least, int most) {
  if (rest_.empty()) fail(std::string(what) + " is missing");
  size_t digits = 0;
  while (digits < rest_.size() && digits < most_digits && is_digit(rest_[digits])) ++digits;
  if (digits == 0)
    fail(std::string(what) + ": a number expected, not '" + std::string(rest_.substr(0, 10)) + "'");
  const int v = std::atoi(std::string(rest_.substr(0, digits)).c_str());
  rest_.remove_prefix(digits);
  if (v < least || v > most)
    fail(std::string(what) + " " + std::to_string(v) + " does not lie between " +
         std::to_string(least) + " and " + std::to_string(most));
  return v;
}

void TimeText::expect_time() {
  if (rest_.empty()) fail("the time of day is missing");
  const bool is_marked = take('T') || take('t');
  bool is_blank = false;
  while (take(' ')) is_blank = true;
  if (!is_marked && !is_blank)
    fail("'T' or a space expected before the time of day, not '" +
         std::string(rest_.substr(0, 10)) + "'");
}

TimeOfDay TimeText::time_of_day(bool has_seconds) {
  TimeOfDay t;
  t.hour = number("the hour", 2, 0, 24);
  expect(':', "the minute");
  t.minute = number("the minute", 2, 0, 59);
  if (has_seconds && take(':')) {
    t.second = number("the second", 2, 0, 60);
    if (take('.')) {
      double place = 0.1;
      if (rest_.empty() || !is_digit(rest_.front())) fail("the second's fraction is missing");
      for (; !rest_.empty() && is_digit(rest_.front()); rest_.remove_prefix(1), place /= 10)
        t.second += (rest_.front() - '0') * place;
    }
  }
  if (t.hour == 24 && (t.minute > 0 || t.second > 0)) fail("a day ends at 24:00");
  return t;
}

double TimeText::zone_hours() {
  while (take(' ')) {
  }
  if (rest_.empty()) fail("the time zone is missing: Z, or the hours ahead of it, such as +02:00");
  if (take('Z') || take('z')) return 0;
  constexpr std::string_view minus = "\xe2\x88\x92";  // U+2212
  bool is_west = false;
  if (rest_.starts_with(minus)) {
    rest_.remove_prefix(minus.size());
    is_west = true;
  } else if (take('-')) {
    is_west = true;
  } else if (!take('+')) {
    fail("the time zone must be Z or like +02:00, not '" + std::string(rest_.substr(0, 10)) + "'");
  }
  const int hours = number("the time zone's hour", 2, 0, 14);
  const bool has_colon = take(':');
  const int minutes = has_colon || !rest_.empty() ? number("the time zone's minute", 2, 0, 59) : 0;
  return (is_west ? -1 : 1) * (hours + minutes / 60.0);
}

int days_of_month(int year, int month) {
  static constexpr int days[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  const bool is_leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
  return days[month - 1] + (month == 2 && is_leap ? 1 : 0);
}

}  // namespace troffer
