// Suggestions for mistyped words.
#include <doctest/doctest.h>

#include "base/suggestion.h"

using namespace troffer;

TEST_CASE("distances between words count insertions, deletions, replacements and swaps") {
  CHECK(edit_distance("", "") == 0);
  CHECK(edit_distance("", "abc") == 3);
  CHECK(edit_distance("lamp", "lamp") == 0);
  CHECK(edit_distance("Lamp", "lAMP") == 0);
  CHECK(edit_distance("lmap", "lamp") == 1);
  CHECK(edit_distance("lam", "lamp") == 1);
  CHECK(edit_distance("lamps", "lamp") == 1);
  CHECK(edit_distance("kitten", "sitting") == 3);
}

TEST_CASE("the nearest name is found, and none where all are far") {
  const std::vector<std::string> names{"render", "merge", "measure", "report"};
  CHECK(nearest_name("rendr", names) == "render");
  CHECK(nearest_name("REPORT", names) == "report");
  CHECK(nearest_name("mesure", names) == "measure");
  CHECK(nearest_name("meas", names) == "measure");
  CHECK(nearest_name("xyz", names) == "");
  CHECK(nearest_name("", names) == "");
  CHECK(nearest_name("a", {"b"}) == "");  // replacing the only letter is no suggestion
  CHECK(nearest_name("az", {"ay"}) == "ay");
  CHECK(nearest_name("render", {}) == "");
}

TEST_CASE("a suggestion is appended to a message") {
  CHECK(did_you_mean("fimlic", {"filmic", "none"}) == "; did you mean 'filmic'?");
  CHECK(did_you_mean("zzz", {"filmic", "none"}) == "");
}
