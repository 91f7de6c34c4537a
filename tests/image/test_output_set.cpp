// Files of one output: all are replaced, or none.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "image/output_set.h"
#include "import/temp_folder.h"

using namespace troffer;

namespace {

std::string text_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

size_t entries(const TempFolder& folder) {
  size_t n = 0;
  for (const auto& e : std::filesystem::directory_iterator(folder.path("")))
    n += e.exists() ? 1 : 0;
  return n;
}

}  // namespace

// A folder that takes the place of the second file stops the renaming there.
TEST_CASE("the main file is renamed after all others") {
  const TempFolder folder;
  const std::string a = folder.write("a", "old a"), b = folder.path("b"),
                    c = folder.write("c", "old c");
  OutputSet set;
  set.add(a, "new a");
  set.add(c, "new c");
  set.add(b, "new b");
  set.rename_last(a);
  std::filesystem::create_directories(b + "/full");
  CHECK_THROWS_AS(set.commit(), EnvironmentError);
  CHECK(text_of(a) == "old a");
  CHECK(text_of(c) == "new c");
}

TEST_CASE("no file is replaced before commit(), and nothing is left behind if one fails") {
  const TempFolder folder;
  const std::string a = folder.write("a", "old a"), b = folder.write("b", "old b");
  {
    OutputSet set;
    set.add(a, "new a");
    set.add(b, "new b");
    CHECK(text_of(a) == "old a");
    CHECK(text_of(b) == "old b");
  }
  CHECK(entries(folder) == 2);
  OutputSet failing;
  failing.add(a, "new a");
  CHECK_THROWS_AS(failing.add(folder.path("none/b"), "new b"), EnvironmentError);
  CHECK(text_of(a) == "old a");
  OutputSet set;
  set.add(a, "new a");
  set.add(b, "new b");
  set.commit();
  CHECK(text_of(a) == "new a");
  CHECK(text_of(b) == "new b");
}
