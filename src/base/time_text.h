// Parser of dates and times of day. It reads piece by piece, so that messages name the wrong piece.
// Used by the options --at and --date.
#pragma once

#include <string>
#include <string_view>

namespace troffer {

struct TimeOfDay {
  int hour = 0, minute = 0;  // 24:00 is the end of the day
  double second = 0;         // 60 is a leap second
};

// All members throw UsageError, which begins with the option and quotes the text.
class TimeText {
 public:
  // `expected` is an example for messages. All three must outlive this object.
  TimeText(const std::string& text, const std::string& option, const char* expected);

  [[noreturn]] void fail(const std::string& what) const;
  bool is_at_end() const { return rest_.empty(); }
  std::string_view rest() const { return rest_; }
  // Consumes the sign if it comes next, and returns true then.
  bool take(char sign);
  void expect(char sign, const char* before_what);
  // Reads a whole number of at most `most_digits` digits in [least, most].
  int number(const char* what, size_t most_digits, int least, int most);
  // Reads the separator of date and time: T, t or blanks.
  void expect_time();
  // Reads "HH:MM" and, with has_seconds, optional ":SS" with a fraction.
  TimeOfDay time_of_day(bool has_seconds);
  // Reads "Z", "+02:00", "+0200" or "+02": hours ahead of universal time.
  double zone_hours();

 private:
  const std::string &text_, &option_;
  const char* expected_;
  std::string_view rest_;
};

// Number of days of a month in the Gregorian calendar; `month` counts from 1.
int days_of_month(int year, int month);

}  // namespace troffer
