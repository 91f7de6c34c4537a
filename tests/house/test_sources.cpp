// Rules that can be checked in the sources: own headers come first, tests skip nothing that the
// repository holds, and tests do not depend on the machine's load.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

const fs::path root = TROFFER_SOURCE_DIR;
const fs::path build = TROFFER_BINARY_DIR;

std::vector<fs::path> files_below(const fs::path& folder, const std::set<std::string>& endings) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (endings.count(entry.path().extension().string()) == 1) files.push_back(entry.path());
  return files;
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string first_include(const fs::path& file) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (line.rfind("#include", 0) == 0) return line;
  return {};
}

}  // namespace

// The test `headers` compiles the others.
TEST_CASE("every header that has a .cpp file of its own comes first in it") {
  size_t own = 0;
  for (const fs::path& header : files_below(root / "src", {".h"})) {
    const std::string name = fs::relative(header, root / "src").generic_string();
    const std::string wanted = "#include \"" + name + "\"";
    fs::path source = header;
    source.replace_extension(".cpp");
    if (!fs::exists(source)) continue;
    ++own;
    CAPTURE(name);
    CHECK(first_include(source) == wanted);
  }
  CHECK(own > 0);
}

TEST_CASE("tests skip nothing that the repository holds") {
  // May be absent: collections of broken files, and a device that is always full.
  const std::set<std::string> may_skip{"tests/image/test_badinputs.cpp",
                                       "tests/import/test_badinputs.cpp",
                                       "tests/app/test_failures.cpp"};
  for (const fs::path& file : files_below(root / "tests", {".cpp", ".h"})) {
    const std::string name = fs::relative(file, root).generic_string(), text = text_of(file);
    if (name == "tests/house/test_sources.cpp") continue;
    CAPTURE(name);
    CHECK(text.find("shared/scenes") == std::string::npos);
    if (may_skip.count(name) == 0) CHECK(text.find("\"skipped") == std::string::npos);
  }
}

TEST_CASE("no test depends on wall-clock time: no limit under twenty minutes, no stopwatch") {
  size_t limits = 0;
  const std::regex limit("TIMEOUT \"?([0-9]+)");
  for (const char* folder : {"tests", "bench"}) {
    const fs::path file = build / folder / "CTestTestfile.cmake";
    const std::string text = text_of(file);
    for (std::sregex_iterator i(text.begin(), text.end(), limit), end; i != end; ++i, ++limits)
      CHECK(std::stoi((*i)[1]) >= 20 * 60);
  }
  CHECK(limits > 10);
  for (const fs::path& file : files_below(root / "tests", {".cpp", ".h"})) {
    if (file.filename() == "test_sources.cpp") continue;
    CAPTURE(file.string());
    const std::string text = text_of(file);
    for (const char* clock : {"steady_clock", "system_clock", "high_resolution_clock"})
      CHECK(text.find(clock) == std::string::npos);
  }
}
