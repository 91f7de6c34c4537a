// Dates and times of day as text, read piece by piece, so that a message names the piece that is
// wrong. Used by the options --at and --date.
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
  // `expected`: an example for messages. All three must outlive this.
  TimeText(const std::string& text, const std::string& option, const char* expected);

  [[noreturn]] void fail(const std::string& what) const;
  bool is_at_end() const { return rest_.empty(); }
  std::string_view rest() const { return rest_; }
  // Takes the sign where it comes next.
  bool take(char sign);
  void expect(char sign, const char* before_what);
  // A whole number of at most `most_digits` digits within [least, most].
  int number(const char* what, size_t most_digits, int least, int most);
  // Separator of date and time: T, t or blanks.
  void expect_time();
  // "HH:MM" and, where they are allowed, ":SS" and a fraction.
  TimeOfDay time_of_day(bool has_seconds);
  // "Z", "+02:00", "+0200" or "+02": hours ahead of universal time.
  double zone_hours();

 private:
  const std::string &text_, &option_;
  const char* expected_;
  std::string_view rest_;
};

// Days of a month of the Gregorian calendar, `month` from 1.
int days_of_month(int year, int month);

}  // namespace troffer
