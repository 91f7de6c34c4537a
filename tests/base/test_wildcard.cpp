// Names with wildcards.
#include "base/wildcard.h"

#include <doctest/doctest.h>

using namespace troffer;

TEST_CASE("a star matches any characters or none") {
  for (const auto& [name, pattern] : {std::pair{"panel.001", "panel*"},
                                      {"panel", "panel*"},
                                      {"panel", "panel"},
                                      {"left panel 3", "*panel*"},
                                      {"panel.001", "p*.0*1"},
                                      {"aab", "*ab"},
                                      {"", "*"},
                                      {"a*b", "a*b"},
                                      {"abcbc", "a*bc"}}) {
    CAPTURE(name);
    CAPTURE(pattern);
    CHECK(fits_wildcard(name, pattern));
  }
  for (const auto& [name, pattern] : {std::pair{"panel.001", "panel"},
                                      {"Panel", "panel*"},
                                      {"my panel", "panel*"},
                                      {"panel", "panel*x"},
                                      {"abc", "a*bb"},
                                      {"", "a*"},
                                      {"abc", ""}}) {
    CAPTURE(name);
    CAPTURE(pattern);
    CHECK_FALSE(fits_wildcard(name, pattern));
  }
}
